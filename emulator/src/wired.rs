//! host-sim's sensors at the ends of the emulated wires.

use host_sim::bus::tmag5170::{BelowMagnet, Frame};
use host_sim::bus::{Exchange, OnWire, Slave, WireFault};
use mlx90333::{Decoder, FRAME_LEN};
use scene::{Scene, SensorModel};

use crate::chip::{Ps, SensorEnd};

#[derive(Debug)]
pub(crate) struct Wired {
    /// When its last frame began.
    pub(crate) latched: Ps,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Mlx90333(Box<Mlx>),
    Tmag5170(Box<Tmag>),
}

#[derive(Debug, Default)]
struct Mlx {
    slave: Slave,
    /// As it was when the core began to read it by itself, which a board does before its first tick
    /// and the simulation never. It answers those frames, so that ticks find faults and noise where
    /// they were.
    beside: Option<Slave>,
    /// The last frame as it began, and as it is now.
    begun: Option<Exchange>,
    exchange: Option<Exchange>,
    sent: Vec<u8>,
    /// From one reading to the next, and when the last was taken; 0: one a frame.
    period: Ps,
    converted: Ps,
}

#[derive(Debug)]
struct Tmag {
    below: BelowMagnet,
    frame: Option<Frame>,
}

impl Wired {
    /// That of a side of `scene`, at rest; `None`: there is no such magnet.
    pub(crate) fn new(scene: &Scene, side: usize) -> Option<Self> {
        let kind = match scene.sensor.model {
            SensorModel::Mlx90333 => Kind::Mlx90333(Box::default()),
            SensorModel::Tmag5170 => Kind::Tmag5170(Box::new(Tmag {
                // As host-sim counts whiskers, of which there is one a side.
                below: BelowMagnet::new(scene.seed.wrapping_add(side as u64))?,
                frame: None,
            })),
        };
        Some(Self { latched: 0, kind })
    }

    pub(crate) fn on_wire(&mut self) -> OnWire<'_> {
        match &mut self.kind {
            Kind::Mlx90333(mlx) => OnWire::Mlx90333(&mut mlx.slave),
            Kind::Tmag5170(tmag) => OnWire::Tmag5170(&mut tmag.below),
        }
    }

    /// An MLX90333 has so many new readings a second from now on; none: one in each frame.
    pub(crate) fn program(&mut self, decoder: Decoder, update_hz: Option<u16>) {
        if let Kind::Mlx90333(mlx) = &mut self.kind {
            mlx.slave.program(decoder);
            let hz = update_hz.map(Ps::from).filter(|hz| *hz > 0);
            mlx.period = hz.map_or(0, |hz| 1_000_000_000_000 / hz);
        }
    }

    pub(crate) fn lose_power(&mut self) {
        if let Kind::Tmag5170(tmag) = &mut self.kind {
            tmag.below.slave.restart();
            tmag.frame = None;
        }
    }

    /// The tick is over, and the world has moved on: what a frame under way has said so far
    /// becomes this.
    pub(crate) fn moved(&mut self) -> Option<Vec<u8>> {
        let Kind::Mlx90333(mlx) = &mut self.kind else {
            // Its frames begin and end within a tick.
            return None;
        };
        if mlx.sent.len() >= FRAME_LEN {
            return None;
        }
        let mut exchange = mlx.begun.clone()?;
        mlx.slave.latch_again(&mut exchange);
        let said = mlx.sent.iter().map(|sent| exchange.byte(*sent)).collect();
        mlx.exchange = Some(exchange);
        Some(said)
    }
}

impl SensorEnd for Wired {
    fn latch(&mut self, now: Ps, is_polled: bool) {
        self.latched = now;
        match &mut self.kind {
            Kind::Mlx90333(mlx) => {
                mlx.sent.clear();
                if is_polled {
                    let slave = mlx.beside.get_or_insert_with(|| mlx.slave.clone());
                    (mlx.exchange, mlx.begun) = (Some(slave.select()), None);
                    return;
                }
                mlx.beside = None;
                if now - mlx.converted < mlx.period {
                    mlx.slave.inject(WireFault::Frozen, 1);
                } else {
                    mlx.converted = now;
                }
                mlx.exchange = Some(mlx.slave.select());
                mlx.begun.clone_from(&mlx.exchange);
            }
            Kind::Tmag5170(tmag) => tmag.frame = Some(tmag.below.slave.select()),
        }
    }

    fn exchange(&mut self, sent: u8) -> u8 {
        let read = match &mut self.kind {
            Kind::Mlx90333(mlx) => {
                mlx.sent.push(sent);
                let exchange = mlx.exchange.as_mut();
                exchange.map(|exchange| exchange.byte(sent))
            }
            Kind::Tmag5170(tmag) => {
                let frame = tmag.frame.as_mut();
                frame.map(|frame| frame.byte(&tmag.below.slave, sent))
            }
        };
        read.unwrap_or(0xFF)
    }

    fn release(&mut self) {
        if let Kind::Tmag5170(tmag) = &mut self.kind
            && let Some(frame) = tmag.frame.take()
        {
            tmag.below.slave.release(&frame);
        }
    }
}
