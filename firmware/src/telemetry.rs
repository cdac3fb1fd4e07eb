//! The link to a PC: records of every tick, and requests that are carried out between two.
//!
//! Nothing waits here: a record that finds no room is dropped whole and counted.

use tactile::Decision;
use whisking::{MAX_OWN, Real};
use wire::{
    Answer, Command as Said, CommandStatus, Flags, Load, Looked, TaggedCommand, TickRecord,
    WhiskerId, q13,
};

use crate::config::Part;
use crate::lines::halves;
use crate::module::{Hardware, Module, Whisker};
use crate::servo::MotorRecord;
use crate::{Command, Config, Event, ModelState, NotDone, Place};

/// What a module says of itself besides its configuration.
#[derive(Debug, Clone, Copy)]
pub struct About {
    /// Which model it decides by.
    pub model: ModelState,
}

/// The version of this crate, as [`wire::Command::Version`] says it.
const VERSION: [i32; 2] = {
    let [major, minor, patch] = [
        env!("CARGO_PKG_VERSION_MAJOR"),
        env!("CARGO_PKG_VERSION_MINOR"),
        env!("CARGO_PKG_VERSION_PATCH"),
    ];
    [number(major) << 16 | number(minor), number(patch)]
};

const fn number(digits: &str) -> i32 {
    match u16::from_str_radix(digits, 10) {
        Ok(number) => number as i32,
        Err(_) => panic!("cargo has numbers there, below 2^16 in this crate"),
    }
}

/// What a whisker has decided last, and how often it has.
#[derive(Debug, Clone, Copy)]
struct Decided {
    place: Place,
    class: Option<u8>,
    count: u8,
}

/// The module's end of the link.
#[derive(Debug, Default)]
pub struct Link {
    streams: bool,
    touching: u32,
    /// Flags of the events since the last record.
    said: Flags,
    lost: u32,
    /// Says so, where the next record is the first after some that were lost.
    gap: Flags,
    /// Of the whiskers of a board of a head.
    decided: [Option<Decided>; MAX_OWN],
}

impl Link {
    /// A link on which nothing was asked for yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Notes an event for the next record.
    pub fn note(&mut self, event: &Event) {
        match event {
            Event::Touch { place, .. } => self.touching |= bit(*place),
            Event::TouchEnd { place, .. } => self.touching &= !bit(*place),
            Event::Decision(place, decision) => {
                self.said = self.said | Flags::DECIDED;
                if Part::Bus.is_built() && Part::Classifier.is_built() {
                    self.note_decision(*place, decision);
                }
            }
            Event::SensorLost(..) | Event::MotorFault(..) | Event::MotorGivenUp(_) => {
                self.said = self.said | Flags::FAULT;
            }
            Event::ZeroMoved(..) => self.said = self.said | Flags::ZEROED,
            Event::Pose(..)
            | Event::Node(..)
            | Event::SensorBack(_)
            | Event::Frame(..)
            | Event::MotorRetry(_)
            | Event::Armed
            | Event::Stopped
            | Event::Health(_)
            | Event::Limit(_) => {}
        }
    }

    #[cold]
    fn note_decision(&mut self, place: Place, decision: &Decision) {
        let last = self.last_decision(place);
        let count = last.map_or(0, |last| last.count);
        let free = |decided: &Option<Decided>| decided.is_none_or(|of| of.place == place);
        let found = self.decided.iter_mut().find(|decided| free(decided));
        if let Some(found) = found {
            *found = Some(Decided {
                place,
                class: decision.class().map(|class| class as u8),
                // Never 0 again.
                count: count.checked_add(1).unwrap_or(1),
            });
        }
    }

    fn last_decision(&self, place: Place) -> Option<Decided> {
        let mut all = self.decided.iter().flatten();
        all.find(|decided| decided.place == place).copied()
    }

    /// Whether records are sent after every tick.
    #[inline]
    pub const fn streams(&self) -> bool {
        self.streams
    }

    /// Carries out a request between two ticks.
    // Apart: the bound of the stack cannot follow its jumps beside the rest of a board's link.
    #[inline(never)]
    pub fn carry_out<R: Real, H: Hardware>(
        &mut self,
        module: &mut Module<R, H>,
        config: &Config<R>,
        request: TaggedCommand,
        about: About,
        sequence: u32,
    ) -> Answer {
        let mut values = [0; 2];
        let mut done = |place: WhiskerId, command| {
            let place = Place::new(place.side, place.number);
            let motion = config.motion.as_ref().filter(|_| Part::Motion.is_built());
            let motion = motion.ok_or(CommandStatus::NoWhisker)?;
            motion.allows(&command)?;
            let found = module.command(place, command);
            found.map_err(NotDone::status)
        };
        let done = match request.command {
            Said::Hello => {
                values = [config.head.tick_hz as i32, module.whiskers().len() as i32];
                Ok(())
            }
            Said::Status => {
                values = [self.lost, module.timing().missed()].map(u32::cast_signed);
                Ok(())
            }
            Said::Name(from) => {
                values = letters(&config.head.name, from);
                Ok(())
            }
            Said::Stream(on) => {
                self.streams = on;
                (self.said, self.gap) = (Flags::NONE, Flags::NONE);
                Ok(())
            }
            Said::Arm | Said::Stop => {
                let is_armed = request.command == Said::Arm;
                let found = config.motion.as_ref().ok_or(CommandStatus::NoWhisker);
                found.map(|_| module.arm(is_armed))
            }
            Said::Clear(whisker) => done(whisker, Command::Clear),
            Said::Home(whisker) => done(whisker, Command::Home),
            Said::Gain(whisker, gain) => done(whisker, Command::Gain(R::from_q24(gain))),
            Said::Setpoint(whisker, theta) => {
                done(whisker, Command::Setpoint(Some(R::from_q24(theta))))
            }
            Said::Release(whisker) => done(whisker, Command::Setpoint(None)),
            Said::Zero(whisker) => {
                let place = Place::new(whisker.side, whisker.number);
                let found = module.whisker(place).ok_or(CommandStatus::NoWhisker);
                let zero = found
                    .and_then(|(_, whisker)| whisker.sensor().zero().ok_or(CommandStatus::NotHere));
                zero.map(|zero| values = zero.codes().map(i32::from))
            }
            Said::Frame(whisker) => {
                let place = Place::new(whisker.side, whisker.number);
                let found = module.whisker(place).ok_or(CommandStatus::NoWhisker);
                let last = found
                    .and_then(|(_, whisker)| whisker.sensor().last().ok_or(CommandStatus::NotHere));
                last.map(|bytes| values = halves(bytes).map(u32::cast_signed))
            }
            Said::Look(whisker) if Part::Bus.is_built() => {
                let place = Place::new(whisker.side, whisker.number);
                let found = module.whisker(place).ok_or(CommandStatus::NoWhisker);
                found.map(|whisker| values = self.looked(module, config, whisker).values())
            }
            Said::Version => {
                values = VERSION;
                Ok(())
            }
            Said::Model => match about.model {
                ModelState::Runs { crc, classes } => {
                    values = [crc.cast_signed(), classes.into()];
                    Ok(())
                }
                ModelState::Refused(refusal) => {
                    values = [0, -i32::from(refusal.code())];
                    Ok(())
                }
                ModelState::NotHere => Err(CommandStatus::NotHere),
            },
            // By `Tuning`, by whoever knows the model's names, or by a board's loader.
            Said::Config(_)
            | Said::Class(..)
            | Said::Scene
            | Said::Board
            | Said::Stage(..)
            | Said::Apply(_)
            | Said::Forget
            | Said::Load(_)
            | Said::Word(..)
            | Said::Restart
            | Said::Look(_)
            | Said::Started => Err(CommandStatus::NotHere),
        };
        Answer {
            sequence,
            tag: request.tag,
            command: request.command.number(),
            status: done.err().unwrap_or(CommandStatus::Done),
            values,
        }
    }

    /// How the `n`-th whisker is after the last tick.
    #[cold]
    #[inline(never)]
    fn looked<R: Real, H: Hardware>(
        &self,
        module: &Module<R, H>,
        config: &Config<R>,
        whisker: (usize, &Whisker<R, H>),
    ) -> Looked {
        let tick = Tick {
            module,
            config,
            sequence: 0,
            said: Flags::NONE,
            touching: self.touching,
        };
        let record = tick.record(whisker, Flags::NONE);
        let decided = self.last_decision(whisker.1.place());
        Looked {
            measured: record.measured,
            contact: record.contact,
            flags: record.flags,
            decisions: decided.map_or(0, |decided| decided.count),
            class: decided.and_then(|decided| decided.class),
        }
    }

    /// Sends the records of a tick, the `sequence`-th since the start, with what was noted in
    /// it, if they were asked for. `put` says whether it had room for one.
    #[inline]
    pub fn send<R: Real, H: Hardware>(
        &mut self,
        module: &Module<R, H>,
        config: &Config<R>,
        sequence: u32,
        put: &mut impl FnMut(TickRecord) -> bool,
    ) {
        if !self.streams {
            return;
        }
        let tick = Tick {
            module,
            config,
            sequence,
            said: core::mem::take(&mut self.said),
            touching: self.touching,
        };
        for whisker in module.whiskers().iter().enumerate() {
            self.send_record(&tick, whisker, put);
        }
    }

    // Apart: a loop would load what whiskers have alike, for which registers do not suffice.
    #[inline(never)]
    fn send_record<R: Real, H: Hardware>(
        &mut self,
        tick: &Tick<'_, R, H>,
        whisker: (usize, &Whisker<R, H>),
        put: &mut impl FnMut(TickRecord) -> bool,
    ) {
        if put(tick.record(whisker, self.gap)) {
            self.gap = Flags::NONE;
        } else {
            self.gap = Flags::LOST;
            self.lost = self.lost.wrapping_add(1);
        }
    }
}

/// Whether a board may write a scene and its model into its flash, which has room for so much
/// of each: with motors that are off, as nothing moves them meanwhile.
///
/// # Errors
/// [`CommandStatus::Armed`], or [`CommandStatus::OutOfRange`].
pub const fn may_load(load: Load, room: Load, is_armed: bool) -> Result<(), CommandStatus> {
    if is_armed {
        return Err(CommandStatus::Armed);
    }
    // A header is four words.
    let has_room = 4 < load.config && load.config <= room.config && load.model <= room.model;
    if has_room {
        Ok(())
    } else {
        Err(CommandStatus::OutOfRange)
    }
}

const fn bit(place: Place) -> u32 {
    1 << ((place.side as u32 * 16 + place.whisker as u32) % u32::BITS)
}

/// Eight letters of a name from one on; zeros follow the last.
pub fn letters(name: &str, from: u8) -> [i32; 2] {
    let rest = name.as_bytes().get(usize::from(from)..).unwrap_or_default();
    [0, 4].map(|at| {
        let mut word = [0; 4];
        for (byte, letter) in word.iter_mut().zip(rest.iter().skip(at)) {
            *byte = *letter;
        }
        i32::from_le_bytes(word)
    })
}

struct Tick<'a, R: Real, H: Hardware> {
    module: &'a Module<R, H>,
    config: &'a Config<R>,
    sequence: u32,
    /// The flags of it, and the whiskers that touch something.
    said: Flags,
    touching: u32,
}

impl<R: Real, H: Hardware> Tick<'_, R, H> {
    /// The record of the `n`-th whisker, for which `gap` is set too.
    #[inline]
    fn record(&self, (n, whisker): (usize, &Whisker<R, H>), gap: Flags) -> TickRecord {
        let (motor, z) = self.moved(n, whisker).unwrap_or_default();
        let place = whisker.place();
        let reading = whisker.sensor().reading();
        let touches = self.touching != 0 && self.touching & bit(place) != 0;
        TickRecord {
            sequence: self.sequence,
            x: reading.x.raw(),
            y: reading.y.raw(),
            setpoint: motor.setpoint,
            measured: motor.measured,
            duty: motor.duty,
            z,
            contact: q13(whisker.felt().to_q24()),
            flags: self.said
                | gap
                | motor.flags
                | Flags::TOUCHING.when(touches)
                | Flags::RIGHT.when(place.side > 0)
                | Flags::FRESH.when(reading.fresh)
                | Flags::VALID.when(reading.valid),
        }
    }

    /// What the last tick has done with the motor of the `n`-th whisker, and z of its side, Q13.
    #[inline]
    fn moved(&self, n: usize, whisker: &Whisker<R, H>) -> Option<(MotorRecord, i16)> {
        let motion = self.module.motion()?;
        let config = self.config.motion.as_ref()?;
        let servo = whisker.servo()?;
        let moved = motion.state().whiskers.get(n)?;
        let side = motion.state().sides.get(usize::from(moved.side))?;
        let mut motor = servo.record(&config.servo, moved.muscle.theta);
        motor.flags = motor.flags | Flags::ARMED.when(motion.is_armed());
        Some((motor, q13(side.z.value.to_q24())))
    }
}
