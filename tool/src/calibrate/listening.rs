//! One whisker that is listened to and moved. Its motor is off whenever this ends.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use firmware::Packet;
use host_sim::Error;
use wire::{Command, Flags, TickRecord, WhiskerId, degrees};

use crate::conversation::Conversation;
use crate::tally::{Before, Tally, side};

/// A tick of the whisker, in physical units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    /// Since it was listened to first, s.
    pub(crate) t_s: f64,
    /// x and y as the sensor has them, codes of 14 bits.
    pub(crate) codes: [u16; 2],
    /// Where it should be, degrees.
    pub(crate) setpoint_deg: f64,
    /// Where it is by its encoder, degrees.
    pub(crate) measured_deg: f64,
    /// What drives its motor, −1 to 1.
    pub(crate) duty: f64,
    /// Flags.
    pub(crate) flags: Flags,
}

impl Sample {
    /// Of a record, with the zero that was taken out of it.
    fn new(record: &TickRecord, t_s: f64, zero: [i32; 2]) -> Self {
        Self {
            t_s,
            codes: sum(record.codes(), zero),
            setpoint_deg: degrees(record.setpoint).into(),
            measured_deg: degrees(record.measured).into(),
            duty: f64::from(record.duty) / f64::from(i16::MAX),
            flags: record.flags,
        }
    }

    /// Whether the sensor's reading counts.
    pub(crate) const fn is_valid(&self) -> bool {
        self.flags.contains(Flags::VALID)
    }
}

/// Codes with so much added, within their range.
fn sum([x, y]: [u16; 2], [more_x, more_y]: [i32; 2]) -> [u16; 2] {
    [(x, more_x), (y, more_y)].map(|(code, more)| {
        // Within 16383, thus within a u16.
        i32::from(code).saturating_add(more).clamp(0, 16_383) as u16
    })
}

/// How long a module may say nothing, s.
const PATIENCE_S: f64 = 3.0;

/// A module of which one whisker is listened to.
pub(crate) struct Listening {
    module: Conversation,
    whisker: WhiskerId,
    tick_s: f64,
    ticks: u64,
    /// What the module takes out of readings, codes.
    zero: [i32; 2],
    /// Of its records.
    pub(crate) tally: Tally,
    /// What it has logged.
    pub(crate) log: Vec<String>,
    interrupted: Arc<AtomicBool>,
}

impl Listening {
    /// To the first whisker of the left side (0) or the right (1).
    ///
    /// # Errors
    /// [`Error::Work`] if the module does not answer.
    pub(crate) fn new(mut module: Conversation, side: u8) -> Result<Self, Error> {
        let interrupted = interrupts()?;
        let about = module.about()?;
        let whisker = WhiskerId { side, number: 0 };
        let zero = module.zero(whisker)?.unwrap_or_default();
        module.ask(Command::Stream(true))?;
        Ok(Self {
            module,
            whisker,
            zero,
            tick_s: 1.0 / f64::from(about.tick_hz),
            ticks: 0,
            tally: Tally::default(),
            log: Vec::new(),
            interrupted,
        })
    }

    /// The module, to be asked for other things.
    pub(crate) const fn module(&mut self) -> &mut Conversation {
        &mut self.module
    }

    /// A tick, s.
    pub(crate) const fn tick_s(&self) -> f64 {
        self.tick_s
    }

    /// Switches its motors on, where they are off.
    ///
    /// # Errors
    /// [`Error::Work`] if it refuses.
    pub(crate) fn arm(&mut self) -> Result<(), Error> {
        self.module.ask(Command::Arm).map(drop)
    }

    /// Holds the whisker at an angle; none: it whisks.
    ///
    /// # Errors
    /// [`Error::Work`] if it refuses.
    pub(crate) fn hold(&mut self, angle_deg: Option<f64>) -> Result<(), Error> {
        let command = match angle_deg {
            None => Command::Release(self.whisker),
            Some(angle_deg) => {
                let q24 = (angle_deg - 50.0) / 100.0 * 16_777_216.0;
                Command::Setpoint(self.whisker, q24.round() as i32)
            }
        };
        self.module.ask(command).map(drop)
    }

    /// Switches motors off until they are armed.
    ///
    /// # Errors
    /// [`Error::Work`] if it refuses.
    pub(crate) fn stop(&mut self) -> Result<(), Error> {
        self.module.ask(Command::Stop).map(drop)
    }

    /// Has records sent again, where somebody has asked for none meanwhile: goes on with the
    /// first of them.
    ///
    /// # Errors
    /// [`Error::Work`] if the module does not answer.
    pub(crate) fn go_on(&mut self) -> Result<(), Error> {
        let kept = self.module.take_kept();
        self.log
            .extend(kept.into_iter().flat_map(|incoming| incoming.lines));
        self.tally.skip();
        self.module.ask(Command::Stream(true)).map(drop)
    }

    /// Listens for so many seconds of the module's time; `each` is given every sample, and ends
    /// it with `false`.
    ///
    /// # Errors
    /// [`Error::Work`] if nothing comes, the module restarts, or the program is interrupted.
    pub(crate) fn watch(
        &mut self,
        seconds: f64,
        each: impl FnMut(&Sample) -> bool,
    ) -> Result<Vec<Sample>, Error> {
        let mut samples = self.take(seconds, each)?;
        let moved = |sample: &Sample| sample.flags.contains(Flags::ZEROED);
        if let Some(after) = samples.iter().position(moved) {
            let zero = self.module.zero(self.whisker)?.unwrap_or_default();
            let [x, y] = [0, 1].map(|axis: usize| zero[axis] - self.zero[axis]);
            // It is taken out from the next record on.
            for sample in samples.iter_mut().skip(after + 1) {
                sample.codes = sum(sample.codes, [x, y]);
            }
            self.zero = zero;
        }
        Ok(samples)
    }

    /// Listens, and knows no other zero than that from before.
    fn take(
        &mut self,
        seconds: f64,
        mut each: impl FnMut(&Sample) -> bool,
    ) -> Result<Vec<Sample>, Error> {
        let most = (seconds / self.tick_s).round() as u64;
        let mut samples = Vec::new();
        let from = self.ticks;
        let mut heard_s = self.module.source().now_s();
        loop {
            if self.interrupted.load(Ordering::Relaxed) {
                return Err(Error::Work(
                    "interrupted; the motors were stopped".to_owned(),
                ));
            }
            let incoming = self.module.receive()?;
            self.log.extend(incoming.lines);
            let now_s = self.module.source().now_s();
            for packet in &incoming.packets {
                let Packet::Record(record) = packet else {
                    continue;
                };
                if side(record) != usize::from(self.whisker.side) {
                    continue;
                }
                heard_s = now_s;
                match self.tally.take(record) {
                    Before::Restart => {
                        return Err(Error::Work(
                            "the module has restarted; whisker log says why".to_owned(),
                        ));
                    }
                    Before::Lost(ticks) => self.ticks += u64::from(ticks),
                    Before::Nothing => {}
                }
                self.ticks += 1;
                let sample = Sample::new(record, self.ticks as f64 * self.tick_s, self.zero);
                samples.push(sample);
                if !each(&sample) || self.ticks - from >= most {
                    return Ok(samples);
                }
            }
            if now_s - heard_s > PATIENCE_S {
                return Err(Error::Work(
                    "the module says nothing of this whisker; is it there?".to_owned(),
                ));
            }
        }
    }

    /// Listens to a whisker that moves: a fault, or a motor that is not driven, ends it.
    ///
    /// # Errors
    /// As [`Listening::watch`], and [`Error::Work`] for a fault, with what the log says of it.
    pub(crate) fn follow(
        &mut self,
        seconds: f64,
        mut each: impl FnMut(&Sample) -> bool,
    ) -> Result<Vec<Sample>, Error> {
        let mut fault = false;
        let samples = self.watch(seconds, |sample| {
            fault = sample.flags.contains(Flags::RESTING) || sample.flags.contains(Flags::FAULT);
            !fault && each(sample)
        })?;
        if !fault {
            return Ok(samples);
        }
        // The line about it may come after its record.
        self.watch(0.05, |_| true)?;
        let mut lines = self.log.iter().filter(|line| line.contains("fault"));
        let line = lines
            .next_back()
            .map_or("whisker log tells which", String::as_str);
        Err(Error::Work(format!(
            "a fault: {line}; the motors were stopped"
        )))
    }
}

/// Whatever ends this, a motor is not left driven.
impl Drop for Listening {
    fn drop(&mut self) {
        // A module that is gone does not answer, and has its own guards.
        let _ = self.module.ask(Command::Stop);
        let _ = self.module.ask(Command::Stream(false));
    }
}

/// Becomes true with a signal that would end the program.
#[cfg(unix)]
fn interrupts() -> Result<Arc<AtomicBool>, Error> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

    let interrupted = Arc::new(AtomicBool::new(false));
    for signal in [SIGHUP, SIGINT, SIGTERM] {
        let registered = signal_hook::flag::register(signal, Arc::clone(&interrupted));
        registered.map_err(|error| Error::Work(format!("interrupts: {error}")))?;
    }
    Ok(interrupted)
}

/// Elsewhere an interrupt ends the program, and the module's own limits have to do.
#[cfg(not(unix))]
fn interrupts() -> Result<Arc<AtomicBool>, Error> {
    Ok(Arc::new(AtomicBool::new(false)))
}
