//! The machine with host-sim's sensors and motors on its pins, as a module that
//! host-sim's runs can drive. A whisker a side; a scene with one side has the left.
//!
//! A tick of the simulation is from the return of the tick's handler to its next return. Between
//! two, the core asleep, the world moves on by a tick at once, as in host-sim: the motors follow
//! the pins as the tick left them, the plant follows the motors, and the sensors are set. A frame
//! that was begun in the tick before is latched again then, and what was clocked of it meanwhile is
//! put right, where the DMA has put it; the next tick uses it. So tick n uses the deflection after
//! tick n − 1 on the board as on the PC, as long as a tick is shorter than a frame. (A TMAG5170 is
//! read within the tick.) In the first tick there is no frame yet, and the module takes its sensor
//! to be at rest, which in host-sim's first tick it is.

use std::ops::Range;

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;
use firmware::{AngleInput, Event, Place};
use host_sim::bench::{Bench, Snapshot};
use host_sim::bus::OnWire;
use host_sim::motor::{Pins, SimPwm};
use host_sim::received::{Received, Receiver};
use mlx90333::Decoder;
use rtt::LogDecoder;
use scene::{Scene, SensorMode, SensorModel};

use crate::chip::{Fault, Needs, Ps, ResetCause, WELL_MV};
use crate::machine::{Machine, Stop};
use crate::meter::Meter;
use crate::notice::Notice;
use crate::program::Program;
use crate::watch::Watch;
use crate::wired::Wired;

/// The emulated board and what hangs on it, as host-sim's runs see it. What goes wrong is kept for
/// [`Board::check`]; after that it stands still.
#[derive(Debug)]
pub(crate) struct Board {
    pub(crate) machine: Machine,
    watch: Watch,
    /// Left side first.
    sensors: Vec<Wired>,
    /// Left side first; none where the whiskers are passive.
    pins: Vec<Pins>,
    ring: Receiver,
    line: Receiver,
    log: Vec<u8>,
    decoder: LogDecoder,
    has_reader: bool,
    pub(crate) notices: Vec<(Place, Notice)>,
    pub(crate) reset: Option<ResetCause>,
    /// The world moves on after so long, even if no tick has ended; none: it waits.
    pub(crate) world_waits: Option<Ps>,
    /// No tick has ended since the world moved on last.
    pub(crate) is_late: bool,
    world_moves: u64,
    pub(crate) meter: Meter,
    pub(crate) bears_resets: bool,
    fault: Option<Fault>,
}

/// Longer than the slowest tick with anything that may delay it: a fault handler waits for
/// the probe before the watchdog resets the chip, and a start for a clock that never comes.
const PATIENCE: Ps = 6_000_000_000_000;

fn set_pwm(pwm: &mut SimPwm, (on, period): (u32, u32)) {
    let scaled = u64::from(on) * u64::from(pwm.max_duty_cycle()) / u64::from(period.max(1));
    let Ok(()) = pwm.set_duty_cycle(scaled as u16);
}

impl Board {
    /// Board `number` of a head, or the only one, with those of the scene's whiskers, the first on its
    /// left side: started, and before its first tick.
    pub(crate) fn new(
        program: &Program,
        scene: &Scene,
        (number, own): (u8, Range<usize>),
        pins: Vec<Pins>,
    ) -> Result<Self, Fault> {
        let sides = own.len();
        let sensors = own.map(|n| Wired::new(scene, n));
        let sensors = sensors.collect::<Option<_>>();
        let mut board = Self {
            machine: Machine::new(program)?,
            watch: Watch::new(program, scene, sides)?,
            sensors: sensors.ok_or(Fault::NoMagnet)?,
            pins,
            ring: Receiver::default(),
            line: Receiver::default(),
            log: Vec::new(),
            decoder: program.log_decoder()?,
            has_reader: true,
            notices: Vec::new(),
            reset: None,
            world_waits: None,
            is_late: false,
            world_moves: 0,
            meter: Meter::default(),
            bears_resets: false,
            fault: None,
        };
        let needs = match (scene.sensor.model, scene.sensor.mode) {
            (SensorModel::Mlx90333, SensorMode::Fast) => Needs::FAST,
            (SensorModel::Mlx90333, SensorMode::Slow) => Needs::SLOW,
            (SensorModel::Tmag5170, _) => Needs::TILT,
        };
        board.machine.chip().set_number(number);
        for side in 0..sides {
            board.machine.chip().lines[side].needs = needs;
            board.program_sensor(side, config::decoder(&scene.sensor), 0, None);
        }
        match board.machine.run(PATIENCE, &mut board.sensors, None)? {
            Stop::Ready => {}
            Stop::Reset(cause) => return Err(Fault::Reset(cause)),
            Stop::Tick | Stop::Time => {
                board.drain()?;
                return Err(Fault::NoStart(board.lines().join("\n  ")));
            }
        }
        board.drain()?;
        Ok(board)
    }

    /// The sensor of a side has so many new readings a second; none: one in each frame. It is silent
    /// in frames that come sooner than `rest_us` after the last.
    pub(crate) fn program_sensor(
        &mut self,
        side: usize,
        decoder: Decoder,
        rest_us: u32,
        update_hz: Option<u16>,
    ) {
        if let Some(sensor) = self.sensors.get_mut(side) {
            sensor.program(decoder, update_hz);
        }
        self.machine.chip().lines[side].program(decoder, rest_us);
    }

    /// Power comes without a clock from outside, as on a supply without a PC; or that clock is
    /// there again.
    pub(crate) fn start_without_clock(&mut self, is_without: bool) -> Result<(), Fault> {
        if is_without {
            self.set_power(false)?;
            self.set_power(true)?;
        }
        self.machine.disturbed().stop_clock(is_without).map(drop)
    }

    /// The world has moved on: what the next tick reads. A board of a head is then run by
    /// [`Self::run_until`].
    pub(crate) fn begin(&mut self) -> Result<(), Fault> {
        self.inputs();
        if self.world_moves > 0 {
            for (side, sensor) in self.sensors.iter_mut().enumerate() {
                if let Some(said) = sensor.moved() {
                    self.machine.say_again(side, &said)?;
                }
            }
        }
        Ok(())
    }

    /// Runs to the end of the next tick, through resets if they are borne.
    fn pass_tick(&mut self) -> Result<(), Fault> {
        self.begin()?;
        let limit = self.machine.now + self.world_waits.unwrap_or(PATIENCE);
        loop {
            let stop = self
                .machine
                .run(limit, &mut self.sensors, Some(&mut self.meter))?;
            self.is_late = stop == Stop::Time;
            match stop {
                Stop::Tick => break,
                Stop::Ready => {}
                Stop::Time if self.world_waits.is_some() => break,
                Stop::Time => return Err(self.machine.stands_still()),
                Stop::Reset(cause) => self.was_reset(cause),
            }
            self.drain()?;
        }
        self.outputs();
        self.world_moves += 1;
        self.drain()
    }

    pub(crate) fn reset_now(&mut self, cause: ResetCause) -> Result<(), Fault> {
        self.was_reset(cause);
        self.machine.reset(cause)
    }

    /// Without it RAM and the encoder's count are lost.
    pub(crate) fn set_power(&mut self, is_on: bool) -> Result<(), Fault> {
        if is_on {
            return self.machine.set_supply(WELL_MV).map(drop);
        }
        if let Some(cause) = self.machine.set_supply(0)? {
            self.was_reset(cause);
        }
        self.sensors.iter_mut().for_each(Wired::lose_power);
        self.machine.memories.lose_ram()
    }

    fn was_reset(&mut self, cause: ResetCause) {
        self.reset = Some(cause);
        self.watch.restart();
        self.ring = Receiver::default();
    }

    pub(crate) fn run_until(&mut self, until: Ps) -> Result<u32, Fault> {
        let mut ended = 0;
        loop {
            match self
                .machine
                .run(until, &mut self.sensors, Some(&mut self.meter))?
            {
                Stop::Time => return Ok(ended),
                Stop::Reset(cause) => self.was_reset(cause),
                Stop::Ready => {}
                Stop::Tick => {
                    self.outputs();
                    self.world_moves += 1;
                    ended += 1;
                }
            }
            self.drain()?;
        }
    }

    /// After the tick of a board of a head: what it has said, and what it shows of itself.
    pub(crate) fn end(
        &mut self,
        events: &mut Vec<Event>,
        snapshot: &mut Snapshot,
    ) -> Result<(), Fault> {
        self.look_at_tick(events)?;
        self.watch.look(&self.machine.memories, snapshot)
    }

    /// Lets `time` pass on the chip alone; whether the tick ends within it.
    pub(crate) fn run_for(&mut self, time: Ps) -> Result<bool, Fault> {
        let until = self.machine.now + time;
        match self.machine.run(until, &mut self.sensors, None)? {
            Stop::Time => Ok(false),
            Stop::Tick => Ok(true),
            Stop::Reset(cause) => Err(Fault::Reset(cause)),
            Stop::Ready => Err(Fault::Asleep),
        }
    }

    pub(crate) fn wait(&mut self, time: Ps) -> Result<(), Fault> {
        let limit = self.machine.now + time;
        loop {
            match self.machine.run(limit, &mut self.sensors, None)? {
                Stop::Time => return self.drain(),
                Stop::Reset(cause) => self.was_reset(cause),
                Stop::Tick | Stop::Ready => {}
            }
            self.drain()?;
        }
    }

    pub(crate) fn missed(&self) -> Result<u32, Fault> {
        self.machine.memories.word(self.watch.missed)
    }

    /// When the sensor of a side latched the frame that the last tick has used.
    pub(crate) fn latched(&self, side: usize) -> Ps {
        self.sensors.get(side).map_or(0, |sensor| sensor.latched)
    }

    /// Asks the program to wait where the log's ring is full, as a probe does that attaches.
    pub(crate) fn attach_reader(&mut self) -> Result<(), Fault> {
        let Machine { rtt, memories, .. } = &self.machine;
        rtt.log().ask_to_wait(memories)
    }

    pub(crate) fn lose_reader(&mut self) -> Result<(), Fault> {
        self.has_reader = false;
        let Machine { rtt, memories, .. } = &self.machine;
        rtt.log().fill(memories)
    }

    pub(crate) fn request(&mut self, bytes: &[u8]) -> Result<bool, Fault> {
        let Machine { rtt, memories, .. } = &self.machine;
        let ring = rtt.requests(memories)?;
        let sent = ring.map_or(Ok(0), |ring| ring.send(memories, bytes))?;
        Ok(sent == bytes.len())
    }

    pub(crate) fn request_room(&self) -> Result<usize, Fault> {
        let Machine { rtt, memories, .. } = &self.machine;
        let ring = rtt.requests(memories)?;
        ring.map_or(Ok(0), |ring| ring.room(memories))
    }

    /// What it has sent to a probe; a reset may have left half of a packet.
    pub(crate) fn heard(&mut self) -> Result<Vec<Received>, Fault> {
        let Machine { rtt, memories, .. } = &self.machine;
        let ring = rtt.packets(memories)?;
        let bytes = ring.map_or(Ok(Vec::new()), |ring| ring.drain(memories))?;
        Ok(self.ring.take(&bytes))
    }

    /// The same, or what it has sent by its serial line; all of it can be read.
    pub(crate) fn received(&mut self, is_by_serial: bool) -> Result<Vec<Received>, Fault> {
        let received = if is_by_serial {
            let bytes = self.machine.chip().serial_read();
            self.line.take(&bytes)
        } else {
            self.heard()?
        };
        if received.contains(&Received::Garbled) {
            return Err(Fault::Garbled);
        }
        Ok(received)
    }

    pub(crate) fn logged(&self) -> &[u8] {
        &self.log
    }

    fn drain(&mut self) -> Result<(), Fault> {
        if !self.has_reader {
            return Ok(());
        }
        let Machine { rtt, memories, .. } = &self.machine;
        self.log.extend(rtt.log().drain(memories)?);
        Ok(())
    }

    fn inputs(&mut self) {
        for (side, pins) in self.pins.iter_mut().enumerate() {
            let (position, halls) = match pins {
                Pins::Ideal(motor) => (motor.counts(), None),
                Pins::Brushed(pins) => (pins.encoder.counts(), None),
                Pins::Brushless(pins) => {
                    let halls = pins.halls.each_mut().map(InputPin::is_high);
                    (pins.encoder.counts(), Some(halls.map(|Ok(high)| high)))
                }
            };
            let mut chip = self.machine.chip();
            chip.set_encoder(side, position);
            if let Some(halls) = halls {
                chip.set_halls(halls);
            }
        }
    }

    fn outputs(&mut self) {
        let chip = self.machine.chip();
        let (duties, enables) = (chip.motor_duties(), chip.motor_enables());
        let directions = chip.motor_directions();
        drop(chip);
        for (side, pins) in self.pins.iter_mut().enumerate() {
            match pins {
                Pins::Ideal(_) => {}
                Pins::Brushed(pins) => {
                    set_pwm(&mut pins.pwm, duties[side]);
                    let Ok(()) = pins.dir.set_state(directions[side].into());
                }
                Pins::Brushless(pins) => {
                    for (pwm, duty) in pins.pwms.iter_mut().zip(duties) {
                        set_pwm(pwm, duty);
                    }
                    for (pin, high) in pins.enables.iter_mut().zip(enables) {
                        let Ok(()) = pin.set_state(high.into());
                    }
                }
            }
        }
    }

    /// Fails with the fault that has stopped the board; a reset is one too.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        self.fault.clone().map_or(Ok(()), Err)
    }

    /// What it has logged since the last call.
    pub(crate) fn lines(&mut self) -> Vec<String> {
        let bytes = std::mem::take(&mut self.log);
        self.decoder.lines(&bytes)
    }

    fn attempt<T: Default>(&mut self, work: impl FnOnce(&mut Self) -> Result<T, Fault>) -> T {
        if self.fault.is_some() {
            return T::default();
        }
        work(self).unwrap_or_else(|fault| {
            self.fault = Some(fault);
            T::default()
        })
    }

    fn look_at_tick(&mut self, events: &mut Vec<Event>) -> Result<(), Fault> {
        if let Some(cause) = self.reset
            && !self.bears_resets
        {
            return Err(Fault::Reset(cause));
        }
        let Machine { rtt, memories, .. } = &self.machine;
        self.meter.logged(rtt.log().writer(memories)?);
        self.watch.take(memories, events, &mut self.notices)
    }
}

impl Bench for Board {
    fn tick(&mut self, events: &mut Vec<Event>) {
        self.attempt(|board| {
            board.pass_tick()?;
            board.look_at_tick(events)
        });
    }

    fn look(&mut self, snapshot: &mut Snapshot) {
        self.attempt(|board| board.watch.look(&board.machine.memories, snapshot));
    }

    fn sensor_mut(&mut self, n: usize) -> Option<OnWire<'_>> {
        Some(self.sensors.get_mut(n)?.on_wire())
    }

    fn tells_faults(&self) -> bool {
        // Its queue has them without their numbers, which the log has.
        false
    }
}
