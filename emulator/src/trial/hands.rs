//! What is done to motors, sensors, the button, the supply and the clock.

use host_sim::Error;
use host_sim::bus::WireFault;
use host_sim::bus::tmag5170::LineFault;
use host_sim::motor::{EncoderFlaws, Wire};
use mlx90333::Faults;

use super::file::{Event, Part, Scenario, What};
use scene::Scene;

use crate::session::Session;

/// What is wrong with a sensor, as an MLX90333 has it, and a TMAG5170.
type Wrong = (Option<WireFault>, Option<LineFault>);

const fn wrong_sensor(what: &What) -> Option<Wrong> {
    let (mlx, tmag) = match what {
        What::SensorFrozen => (WireFault::Frozen, LineFault::Frozen),
        What::SensorGone => (WireFault::Silent, LineFault::Silent),
        // A bit of the first word, and of the field.
        What::SensorGarbled => (WireFault::Flip(20), LineFault::FlipReply(12)),
        // Its protection holds the line low.
        What::SensorUnpowered => (WireFault::LineLow, LineFault::Silent),
        What::MagnetGone => (WireFault::NoField, LineFault::NoField),
        What::MagnetNear => return Some((None, Some(LineFault::NearField))),
        _ => return None,
    };
    Some((Some(mlx), Some(tmag)))
}

/// The encoder's cable, and the motor's two wires.
const WIRES: [Wire; 2] = [Wire::Encoder, Wire::Windings];

#[derive(Debug, Clone, Copy, Default)]
struct AtBoard {
    is_pressed: bool,
    is_off: bool,
    /// The clock from outside did not come.
    is_late: bool,
}

/// What is so at a motor and its sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Around {
    /// Which of [`WIRES`] are cut, or exchanged.
    cut: [bool; 2],
    encoder: EncoderFlaws,
    friction: f64,
    volts: Option<f64>,
    torque_nm: f64,
    is_held: bool,
    sensor: Wrong,
    /// The sensor does not see /SS rise.
    is_stuck: bool,
    has_restarted: bool,
    /// Another than the scene's.
    part: Option<Part>,
}

impl Around {
    const WELL: Self = Self {
        cut: [false; 2],
        encoder: EncoderFlaws::NONE,
        friction: 1.0,
        volts: None,
        torque_nm: 0.0,
        is_held: false,
        sensor: (None, None),
        is_stuck: false,
        part: None,
        has_restarted: false,
    };

    fn add(&mut self, what: &What) {
        match *what {
            What::EncoderStuck => self.cut[0] = true,
            What::EncoderJitter { counts } => self.encoder.jitter = counts,
            What::EncoderSlip { share } => self.encoder.slip = share,
            What::EncoderScale { factor } => self.encoder.scale *= factor,
            What::EncoderReversed => self.encoder.scale = -self.encoder.scale,
            What::MotorReversed => self.cut[1] = true,
            What::Friction { factor } => self.friction = factor,
            What::Supply { volts } => self.volts = Some(volts),
            What::Hand { torque_nm } => self.torque_nm = torque_nm,
            What::Held => self.is_held = true,
            What::SensorRestart => self.has_restarted = true,
            What::SensorPart(part) => self.part = Some(part),
            What::SelectStuck => (self.sensor, self.is_stuck) = ((None, None), true),
            _ => {
                if let Some(wrong) = wrong_sensor(what) {
                    (self.sensor, self.is_stuck) = (wrong, false);
                }
            }
        }
    }
}

#[derive(Debug)]
pub(crate) struct Hands {
    own: Part,
    events: Vec<Event>,
    around: Vec<Around>,
    at_board: AtBoard,
    /// In this tick power has gone.
    pub(super) has_cut: bool,
}

impl Hands {
    pub(super) fn new(scenario: &Scenario, scene: &Scene) -> Self {
        Self {
            own: Part {
                decoder: config::decoder(&scene.sensor),
                ..Part::default()
            },
            events: scenario.events.clone(),
            around: Vec::new(),
            at_board: AtBoard::default(),
            has_cut: false,
        }
    }

    pub(crate) fn act(&mut self, t_s: f64, session: &mut Session) -> Result<(), Error> {
        let lasting = self.events.iter().filter(|event| event.lasts(t_s));
        let (mut around, mut now) = ([Around::WELL; 2], AtBoard::default());
        for event in lasting {
            match event.what {
                What::Button => now.is_pressed = true,
                What::PowerOff => now.is_off = true,
                What::ClockLate => now.is_late = true,
                _ => {}
            }
            if let Some(around) = around.get_mut(event.side) {
                around.add(&event.what);
            }
        }
        if self.around != around {
            for (side, around) in around.iter().enumerate() {
                let had_restarted = self.around.get(side).is_some_and(|was| was.has_restarted);
                surround(session, side, around, had_restarted);
                let part = around.part.unwrap_or(self.own);
                let board = session.board_mut();
                let rest_us = part.rest_us.into();
                board.program_sensor(side, part.decoder, rest_us, part.update_hz);
                board.machine.chip().lines[side].stick(around.is_stuck);
                if let Some(slave) = session.run.slave_mut(side) {
                    slave.set_error_word(Faults::new(part.report));
                }
            }
            self.around = around.to_vec();
        }
        let before = std::mem::replace(&mut self.at_board, now);
        if before.is_pressed != now.is_pressed {
            session.machine().chip().set_button(now.is_pressed);
        }
        if before.is_off != now.is_off {
            session.board_mut().set_power(!now.is_off)?;
        }
        if before.is_late != now.is_late {
            session.board_mut().start_without_clock(now.is_late)?;
        }
        self.has_cut = now.is_off && !before.is_off || now.is_late && !before.is_late;
        Ok(())
    }
}

fn surround(session: &mut Session, side: usize, around: &Around, had_restarted: bool) {
    if let Some(slave) = session.run.slave_mut(side) {
        slave.set_fault(around.sensor.0);
    }
    if let Some(slave) = session.run.tmag_mut(side) {
        slave.set_fault(around.sensor.1);
        if around.has_restarted && !had_restarted {
            slave.restart();
        }
    }
    let Some(motor) = session.run.motor_mut(side) else {
        return;
    };
    for (wire, is_cut) in WIRES.into_iter().zip(around.cut) {
        if is_cut {
            motor.cut(wire);
        } else {
            motor.mend(wire);
        }
    }
    motor.set_encoder(around.encoder);
    motor.set_friction(around.friction);
    motor.set_supply_v(around.volts);
    motor.set_load_nm(around.torque_nm);
    motor.block(around.is_held);
}
