//! The link to a PC: records of every tick, and requests that are carried out between two.
//!
//! Nothing waits here: a packet that finds no room is dropped whole and counted, and only an
//! answer is kept until it has gone.

use core::sync::atomic::{AtomicU32, Ordering};

use whisking::{Optional, Real, filter};
use wire::{
    Answer, Command as Said, CommandStatus, Flags, PACKET_WORDS, TaggedCommand, TickRecord,
    UnknownCommand, WhiskerId, q13,
};

use crate::sensing::{Reading, Sensor};
use crate::{
    Clock, Command, Config, Event, ModelState, Module, Motion, MotionRecord, MotorControl, Place,
    WordSource,
};

/// Where packets go.
pub trait PacketSink {
    /// Has `fill` make a packet where the next one lies, or not at all where there is no room;
    /// whether it has.
    fn put(&mut self, fill: impl FnOnce(&PacketSlot)) -> bool;
}

/// Where a packet lies, for a tick that writes it, and whoever reads it between two ticks.
#[repr(transparent)]
#[derive(Debug, Default)]
pub struct PacketSlot([AtomicU32; PACKET_WORDS]);

impl PacketSlot {
    /// One of zeros.
    pub const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; PACKET_WORDS])
    }

    /// Puts a packet there. Who reads it is told of it afterwards.
    #[inline]
    pub fn set(&self, words: [u32; PACKET_WORDS]) {
        for (place, word) in self.0.iter().zip(words) {
            place.store(word, Ordering::Relaxed);
        }
    }

    /// What lies there.
    #[inline]
    pub fn get(&self) -> [u32; PACKET_WORDS] {
        self.0.each_ref().map(|word| word.load(Ordering::Relaxed))
    }
}

/// What a module says of itself.
#[derive(Debug, Clone, Copy)]
pub struct About<'n> {
    /// The name of its scene.
    pub name: &'n str,
    /// Ticks a second.
    pub tick_hz: u32,
    /// Which model it decides by.
    pub model: ModelState,
}

/// The version of this crate, as [`wire::Command::Version`] tells it.
const VERSION: [i32; 2] = {
    let [major, minor, patch] = [
        env!("CARGO_PKG_VERSION_MAJOR"),
        env!("CARGO_PKG_VERSION_MINOR"),
        env!("CARGO_PKG_VERSION_PATCH"),
    ];
    [number(major) << 16 | number(minor), number(patch)]
};

/// The number that a part of the version is.
const fn number(digits: &str) -> i32 {
    match u16::from_str_radix(digits, 10) {
        Ok(number) => number as i32,
        Err(_) => panic!("cargo has numbers there, below 2^16 in this crate"),
    }
}

/// What the events of ticks say, for the next record. Shared, as whoever gets the events has
/// nothing else of the link at hand.
#[derive(Debug, Default)]
pub struct Notes {
    /// The whiskers that touch something, a bit each.
    touching: AtomicU32,
    /// Flags of the events since the last record.
    said: AtomicU32,
}

impl Notes {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self {
            touching: AtomicU32::new(0),
            said: AtomicU32::new(0),
        }
    }

    /// Notes an event. Loads and stores will do: only the tick has events.
    pub fn note(&self, event: &Event) {
        let add = |flags: Flags| {
            let said = self.said.load(Ordering::Relaxed);
            self.said
                .store(said | u32::from(flags.bits()), Ordering::Relaxed);
        };
        let touching = self.touching.load(Ordering::Relaxed);
        match event {
            Event::Touch { place, .. } => {
                self.touching
                    .store(touching | bit(*place), Ordering::Relaxed);
            }
            Event::TouchEnd { place, .. } => {
                self.touching
                    .store(touching & !bit(*place), Ordering::Relaxed);
            }
            Event::Decision(..) => add(Flags::DECIDED),
            Event::SensorLost(..) | Event::MotorFault(..) | Event::MotorGivenUp(_) => {
                add(Flags::FAULT);
            }
            Event::ZeroMoved(..) => add(Flags::ZEROED),
            Event::SensorBack(_) | Event::MotorRetry(_) => {}
        }
    }

    /// The flags since the last time, and who touches something.
    fn take(&self) -> (Flags, u32) {
        let said = self.said.load(Ordering::Relaxed);
        self.said.store(0, Ordering::Relaxed);
        let touching = self.touching.load(Ordering::Relaxed);
        (Flags::from_bits(said as u16), touching)
    }
}

/// The module's end of the link.
#[derive(Debug, Default)]
pub struct Link {
    streams: bool,
    /// Packets that found no room, since the start.
    lost: u32,
    /// Says so, where the next record is the first after some that were lost.
    gap: Flags,
    answer: Option<Answer>,
}

impl Link {
    /// A link on which nothing was asked for yet.
    pub const fn new() -> Self {
        Self {
            streams: false,
            lost: 0,
            gap: Flags::NONE,
            answer: None,
        }
    }

    /// Whether another request can be taken: its predecessor is answered.
    pub const fn is_free(&self) -> bool {
        self.answer.is_none()
    }

    /// Whether records are sent after every tick.
    pub const fn streams(&self) -> bool {
        self.streams
    }

    /// Carries out a request between two ticks.
    // Apart: with the rest of a board's link it jumps by tables that the bound of its stack
    // cannot follow.
    #[inline(never)]
    pub fn carry_out<R, F, M, P, C, MC, PC, H, const S: usize, const N: usize>(
        &mut self,
        module: &mut Module<R, F, M, P, C, S, N>,
        config: &Config<MC, PC, H>,
        request: TaggedCommand,
        about: About<'_>,
        sequence: u32,
    ) where
        R: Real,
        F: WordSource,
        M: Motion<R, MC, S, N> + MotorControl<R>,
        C: Clock,
    {
        let mut values = [0; 2];
        let mut done = |place: WhiskerId, command| {
            let place = Place::new(place.side, place.number);
            module.motion().allows(&config.motion, &command)?;
            let found = module.command(place, command);
            found.map_err(|_| CommandStatus::NoWhisker)
        };
        let done = match request.command {
            Said::Hello => {
                values = [about.tick_hz as i32, (S * N) as i32];
                Ok(())
            }
            Said::Status => {
                values = [self.lost, module.timing().missed()].map(u32::cast_signed);
                Ok(())
            }
            Said::Name(from) => {
                values = letters(about.name, from);
                Ok(())
            }
            Said::Stream(on) => {
                self.streams = on;
                self.gap = Flags::NONE;
                Ok(())
            }
            // What can be cleared can be armed: there is a motor.
            Said::Arm | Said::Stop => {
                let is_armed = request.command == Said::Arm;
                let found = module.motion().allows(&config.motion, &Command::Clear);
                found.map(|()| module.arm(is_armed))
            }
            Said::Clear(whisker) => done(whisker, Command::Clear),
            Said::Home(whisker) => done(whisker, Command::Home),
            Said::Gain(whisker, gain) => done(whisker, Command::Gain(R::from_q24(gain))),
            Said::Setpoint(whisker, theta) => {
                done(whisker, Command::Setpoint(Some(R::from_q24(theta))))
            }
            Said::Release(whisker) => done(whisker, Command::Setpoint(None)),
            Said::Zero(whisker) => {
                let (side, number) = (whisker.side.into(), whisker.number.into());
                module
                    .sensor_mut(side, number)
                    .ok_or(CommandStatus::NoWhisker)
                    .and_then(|sensor| sensor.source_mut().zero().ok_or(CommandStatus::NotHere))
                    .map(|zero| values = zero.codes().map(i32::from))
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
            // By `Tuning`, or by a board's loader.
            Said::Constant(_)
            | Said::Stage(..)
            | Said::Apply(_)
            | Said::Forget
            | Said::Load(_)
            | Said::Word(..)
            | Said::Restart => Err(CommandStatus::NotHere),
        };
        self.reply(Answer {
            sequence,
            tag: request.tag,
            command: request.command.number(),
            status: done.err().unwrap_or(CommandStatus::Done),
            values,
        });
    }

    /// Refuses a request whose command is unknown.
    pub const fn refuse(&mut self, unknown: UnknownCommand, sequence: u32) {
        self.reply(Answer {
            sequence,
            tag: unknown.tag,
            command: unknown.command,
            status: CommandStatus::Unknown,
            values: [0; 2],
        });
    }

    /// Keeps an answer until it is sent.
    pub const fn reply(&mut self, answer: Answer) {
        self.answer = Some(answer);
    }

    /// Sends the answer that there is, if it finds room.
    pub fn answer(&mut self, sink: &mut impl PacketSink) {
        if let Some(answer) = &self.answer
            && sink.put(|slot| slot.set(answer.words()))
        {
            self.answer = None;
        }
    }

    /// Sends the records of a tick, the `sequence`-th since the start, with what was noted in
    /// it, if they were asked for.
    pub fn send<R, F, M, P, C, MC, PC, H, const S: usize, const N: usize>(
        &mut self,
        module: &Module<R, F, M, P, C, S, N>,
        config: &Config<MC, PC, H>,
        sequence: u32,
        notes: &Notes,
        sink: &mut impl PacketSink,
    ) where
        R: Real,
        F: WordSource,
        M: Motion<R, MC, S, N>,
        C: Clock,
        H: Optional<filter::Config<R>>,
    {
        if !self.streams {
            return;
        }
        let (said, touching) = notes.take();
        for side in 0..S {
            for whisker in 0..N {
                let place = Place::new(side as u8, whisker as u8);
                let said = said | Flags::TOUCHING.when(touching & bit(place) != 0) | self.gap;
                let is_sent = sink.put(|slot| {
                    module.write_record(config, place, sequence, said, slot);
                });
                if is_sent {
                    self.gap = Flags::NONE;
                } else {
                    self.gap = Flags::LOST;
                    self.lost = self.lost.wrapping_add(1);
                }
            }
        }
    }
}

/// Whether a board may write a model of so many `words` into its flash, which has `room` for
/// some: with motors that are off, as nothing moves them meanwhile.
///
/// # Errors
/// [`CommandStatus::Armed`], or [`CommandStatus::OutOfRange`].
pub fn may_load<R, F, M, P, C, MC, PC, H, const S: usize, const N: usize>(
    module: &Module<R, F, M, P, C, S, N>,
    config: &Config<MC, PC, H>,
    words: u32,
    room: u32,
) -> Result<(), CommandStatus>
where
    R: Real,
    F: WordSource,
    M: Motion<R, MC, S, N>,
    C: Clock,
{
    let is_armed = |side, whisker| {
        let told = module.motion().told(&config.motion, side, whisker);
        told.motor.flags.contains(Flags::ARMED)
    };
    if (0..S).any(|side| (0..N).any(|whisker| is_armed(side, whisker))) {
        Err(CommandStatus::Armed)
    } else if (1..=room).contains(&words) {
        Ok(())
    } else {
        Err(CommandStatus::OutOfRange)
    }
}

/// A whisker's bit.
const fn bit(place: Place) -> u32 {
    1 << ((place.side as u32 * 16 + place.whisker as u32) % u32::BITS)
}

/// Eight letters of a name from one on; zeros follow the last.
fn letters(name: &str, from: u8) -> [i32; 2] {
    let rest = name.as_bytes().get(usize::from(from)..).unwrap_or_default();
    [0, 4].map(|at| {
        let mut word = [0; 4];
        for (byte, letter) in word.iter_mut().zip(rest.iter().skip(at)) {
            *byte = *letter;
        }
        i32::from_le_bytes(word)
    })
}

impl<R, F, M, P, C, const S: usize, const N: usize> Module<R, F, M, P, C, S, N>
where
    R: Real,
    F: WordSource,
    C: Clock,
{
    /// Writes a record.
    // Apart: a loop over whiskers would load all of this before it looks for room.
    #[inline(never)]
    fn write_record<MC, PC, H>(
        &self,
        config: &Config<MC, PC, H>,
        place: Place,
        sequence: u32,
        said: Flags,
        slot: &PacketSlot,
    ) where
        M: Motion<R, MC, S, N>,
        H: Optional<filter::Config<R>>,
    {
        slot.set(self.record(config, place, sequence, said).words());
    }

    /// The record of a whisker after a tick, the `sequence`-th since the start, of which
    /// `said` is so too.
    #[inline]
    pub fn record<MC, PC, H>(
        &self,
        config: &Config<MC, PC, H>,
        place: Place,
        sequence: u32,
        said: Flags,
    ) -> TickRecord
    where
        M: Motion<R, MC, S, N>,
        H: Optional<filter::Config<R>>,
    {
        let (side, whisker) = (usize::from(place.side), usize::from(place.whisker));
        let MotionRecord { motor, z } = self.motion().told(&config.motion, side, whisker);
        let sensors = self.sensors().get(side);
        let reading = sensors.and_then(|sensors| sensors.get(whisker));
        let reading = reading.map_or(Reading::REST, Sensor::reading);
        let felt = self.felt().get(side).and_then(|side| side.get(whisker));
        // What the scene does not feel is left out of the program.
        let contact = match (config.contact.part(), felt) {
            (Some(_), Some(felt)) => q13(felt.to_q24()),
            _ => 0,
        };
        TickRecord {
            sequence,
            x: reading.x.raw(),
            y: reading.y.raw(),
            setpoint: motor.setpoint,
            measured: motor.measured,
            duty: motor.duty,
            z,
            contact,
            flags: motor.flags
                | said
                | Flags::RIGHT.when(side > 0)
                | Flags::FRESH.when(reading.fresh)
                | Flags::VALID.when(reading.valid),
        }
    }
}
