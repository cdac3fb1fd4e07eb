//! One whisker that is listened to and moved. Its motor is off whenever this ends.

use firmware::Packet;
use host_sim::Error;
use wire::{Command, Flags, WhiskerId};

use crate::conversation::Conversation;
use crate::faults::{fault, number};
use crate::interrupt;
use crate::sample::Sample;
use crate::tally::{Before, Tally, side};

fn sum([x, y]: [u16; 2], [more_x, more_y]: [i32; 2]) -> [u16; 2] {
    [(x, more_x), (y, more_y)].map(|(code, more)| {
        // Within 16383, thus within a u16.
        i32::from(code).saturating_add(more).clamp(0, 16_383) as u16
    })
}

const PATIENCE_S: f64 = 3.0;

pub(crate) struct Listening<'m> {
    module: &'m mut Conversation,
    whisker: WhiskerId,
    tick_hz: u32,
    ticks: u64,
    /// What the module takes out of readings, codes.
    zero: [i32; 2],
    pub(crate) tally: Tally,
    /// Faults and limits that it has said, with their time.
    pub(crate) faults: Vec<String>,
    pub(crate) last_fault: Option<u8>,
}

impl<'m> Listening<'m> {
    /// To the first whisker of the left side (0) or the right (1).
    pub(crate) fn new(module: &'m mut Conversation, side: u8) -> Result<Self, Error> {
        let about = module.about()?;
        let whisker = WhiskerId { side, number: 0 };
        let zero = module.zero(whisker)?.unwrap_or_default();
        module.ask(Command::Stream(true))?;
        Ok(Self {
            module,
            whisker,
            zero,
            tick_hz: about.tick_hz,
            ticks: 0,
            tally: Tally::default(),
            faults: Vec::new(),
            last_fault: None,
        })
    }

    pub(crate) const fn module(&mut self) -> &mut Conversation {
        self.module
    }

    pub(crate) fn tick_s(&self) -> f64 {
        1.0 / f64::from(self.tick_hz)
    }

    pub(crate) fn arm(&mut self) -> Result<(), Error> {
        self.module.ask(Command::Arm).map(drop)
    }

    /// Holds the whisker at an angle; none: it whisks.
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

    pub(crate) fn stop(&mut self) -> Result<(), Error> {
        self.module.ask(Command::Stop).map(drop)
    }

    /// Has records sent again, where somebody has asked for none meanwhile: goes on with the
    /// first of them.
    pub(crate) fn go_on(&mut self) -> Result<(), Error> {
        for incoming in self.module.take_kept() {
            self.note_faults(&incoming.packets);
        }
        self.tally.skip();
        self.module.ask(Command::Stream(true)).map(drop)
    }

    fn note_faults(&mut self, packets: &[Packet]) {
        for packet in packets {
            if let Packet::Event(event) = packet {
                let fault = fault(event, self.tick_hz);
                self.faults.extend(fault.map(|fault| fault.what));
                self.last_fault = number(&event.event).or(self.last_fault);
            }
        }
    }

    /// Listens for so many seconds of the module's time; `each` is given every sample, and ends
    /// it with `false`.
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
        let most = (seconds / self.tick_s()).round() as u64;
        let mut samples = Vec::new();
        let from = self.ticks;
        let mut heard_s = self.module.now_s();
        loop {
            interrupt::check()?;
            let incoming = self.module.receive()?;
            self.note_faults(&incoming.packets);
            if incoming.has_restarted {
                self.tally.restart();
            }
            let now_s = self.module.now_s();
            for record in incoming.records() {
                if side(record) != usize::from(self.whisker.side) {
                    continue;
                }
                heard_s = now_s;
                match self.tally.take(record) {
                    Before::Restart => {
                        let fault = "the module has restarted; whisker log says why";
                        return Err(Error::Work(fault.to_owned()));
                    }
                    Before::Lost(ticks) => self.ticks += u64::from(ticks),
                    Before::Nothing => {}
                }
                self.ticks += 1;
                let mut sample = Sample::new(record, self.ticks as f64 * self.tick_s());
                sample.codes = sum(sample.codes, self.zero);
                samples.push(sample);
                if !each(&sample) || self.ticks - from >= most {
                    return Ok(samples);
                }
            }
            if now_s - heard_s > PATIENCE_S {
                let fault = "the module says nothing of this whisker; is it there?";
                return Err(Error::Work(fault.to_owned()));
            }
        }
    }

    /// Listens to a whisker that moves: a fault, or a motor that is not driven, ends it.
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
        // The event may come after its record.
        self.watch(0.05, |_| true)?;
        let line = self.faults.last();
        let line = line.map_or("whisker log tells which", String::as_str);
        let fault = format!("a fault: {line}; the motors were stopped");
        Err(Error::Work(fault))
    }
}

/// Whatever ends this, a motor is not left driven.
impl Drop for Listening<'_> {
    fn drop(&mut self) {
        // A module that is gone does not answer, and has its own guards.
        let _ = self.module.ask(Command::Stop);
        let _ = self.module.ask(Command::Stream(false));
    }
}
