//! What outlives a reset, and whether motors may be armed after it.
//!
//! A board keeps a [`Record`] in RAM that no start clears. It holds only while its sum is
//! right: after power-up RAM holds anything.

use crate::faults::number;

/// Words of a [`Record`] in memory, the last of which is the sum of the others.
pub const RECORD_WORDS: usize = 4;

/// So many resets within [`RESET_WINDOW_S`] are too many.
pub const RESETS: usize = 3;

/// For how long a reset counts, s.
pub const RESET_WINDOW_S: u8 = 60;

/// Why the chip started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartCause {
    /// The independent watchdog: tick or idle stood still, or a fault handler waited for it.
    Watchdog,
    /// By software: a debugger or the programmer.
    Software,
    /// Supply came.
    Power,
    /// Supply dipped below what the chip needs.
    BrownOut,
    /// The reset button, or the probe.
    Pin,
    /// None of these.
    Other,
}

impl StartCause {
    /// In the order of their numbers.
    const ALL: [Self; 6] = [
        Self::Watchdog,
        Self::Software,
        Self::Power,
        Self::BrownOut,
        Self::Pin,
        Self::Other,
    ];

    /// Its word in the log.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Watchdog => "watchdog",
            Self::Software => "software",
            Self::Power => "power-up",
            Self::BrownOut => "brown-out",
            Self::Pin => "reset-pin",
            Self::Other => "unknown",
        }
    }

    /// The first whose flag is set in the reset status register. The most specific must come
    /// first: a power-up sets the pin's flag too, and so does every internal reset.
    pub fn first<const N: usize>(flags: [(bool, Self); N]) -> Self {
        let set = flags.into_iter().find(|(set, _)| *set);
        set.map_or(Self::Other, |(_, cause)| cause)
    }
}

/// How a board has started: what it answers to [`wire::Command::Started`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Started {
    /// Starts since power-up, this one included.
    pub number: u32,
    /// Why it started.
    pub cause: StartCause,
    /// The number of the last fault since power-up; 0: none.
    pub fault: u8,
    /// It runs by the chip's own oscillator, as the clock from outside did not come.
    pub is_internal: bool,
    /// The brown-out level lies below what the clock needs.
    pub browns_out_late: bool,
}

impl Started {
    /// As it is answered: starts; cause, fault and two flags, a byte each but for these.
    pub const fn values(self) -> [i32; 2] {
        let flags = self.is_internal as u8 | (self.browns_out_late as u8) << 1;
        let how = [self.cause as u8, self.fault, flags, 0];
        [self.number.cast_signed(), i32::from_le_bytes(how)]
    }

    /// From an answer.
    pub fn of([number, how]: [i32; 2]) -> Self {
        let [cause, fault, flags, _] = how.to_le_bytes();
        let cause = StartCause::ALL.get(usize::from(cause)).copied();
        Self {
            number: number.cast_unsigned(),
            cause: cause.unwrap_or(StartCause::Other),
            fault,
            is_internal: flags & 1 != 0,
            browns_out_late: flags & 2 != 0,
        }
    }
}

/// Why motors are not armed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotArmed {
    /// The chip started after the fault with this number.
    After(u8),
    /// The reason why the chip started is unknown.
    Unknown,
    /// The scene waits for a command.
    OnCommand,
    /// Somebody stopped them, and nobody has armed them since.
    Stopped,
    /// The chip was reset, and has not started because its supply came.
    Reset,
    /// The supply has come before since the scene was deployed, and the scene has armed them then.
    Before,
}

/// How often the chip has started and what befell it last; by default, as supply has just come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Record {
    starts: u32,
    /// The number of the last fault; 0: none.
    fault: u8,
    /// Whether the chip has not started since.
    is_fresh: bool,
    /// Somebody stopped the motors, and nobody has armed them since.
    is_stopped: bool,
    windows: [u8; RESETS - 1],
}

/// A start of the chip, as the record has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Startup {
    /// Its number since power-up, from 1.
    pub number: u32,
    /// The number of the last fault since power-up; 0: none.
    pub fault: u8,
    refusal: Option<NotArmed>,
}

impl Startup {
    /// Whether motors may be armed now, where the scene arms them `at_start`.
    ///
    /// # Errors
    /// Why not.
    pub fn may_arm(&self, at_start: bool) -> Result<(), NotArmed> {
        let on_command = (!at_start).then_some(NotArmed::OnCommand);
        self.refusal.or(on_command).map_or(Ok(()), Err)
    }
}

impl Record {
    /// The record in these words; none if their sum is not right.
    pub fn load(words: [u32; RECORD_WORDS]) -> Option<Self> {
        let [starts, state, windows, found] = words;
        let [fault, is_fresh, is_stopped, _] = state.to_le_bytes();
        let [first, second, ..] = windows.to_le_bytes();
        (sum([starts, state, windows]) == found).then_some(Self {
            starts,
            fault,
            is_fresh: is_fresh != 0,
            is_stopped: is_stopped != 0,
            windows: [first, second],
        })
    }

    /// What [`load`](Self::load) takes.
    pub fn words(&self) -> [u32; RECORD_WORDS] {
        let [first, second] = self.windows;
        let state = [self.fault, self.is_fresh.into(), self.is_stopped.into(), 0];
        let state = u32::from_le_bytes(state);
        let windows = u32::from_le_bytes([first, second, 0, 0]);
        let sum = sum([self.starts, state, windows]);
        [self.starts, state, windows, sum]
    }

    /// The fault with this number, which ends in a reset.
    pub const fn note(&mut self, fault: u8) {
        self.fault = fault;
        self.is_fresh = true;
    }

    /// The motors were stopped, or armed.
    pub const fn set_stopped(&mut self, is_stopped: bool) {
        self.is_stopped = is_stopped;
    }

    /// A second has passed.
    pub fn second(&mut self) {
        for window in &mut self.windows {
            *window = window.saturating_sub(1);
        }
    }

    /// Counts a start for `cause`. Without a record of the time before, RAM has lost its contents.
    ///
    /// No motor may be armed by itself but where the supply has come, and RAM has lost what it
    /// had: only then nobody has stopped them, and no whisker was left where it is not at rest.
    pub fn start(found: Option<Self>, cause: StartCause) -> (Self, Startup) {
        let mut record = found.unwrap_or_default();
        record.starts = record.starts.saturating_add(1);
        let is_dip = match cause {
            StartCause::BrownOut => true,
            StartCause::Power => found.is_some(),
            _ => false,
        };
        let is_often = found.is_some() && record.count_reset();
        let fault = if record.is_fresh {
            Some(record.fault)
        } else if cause == StartCause::Watchdog {
            Some(number::WATCHDOG)
        } else if is_dip {
            Some(number::SUPPLY)
        } else {
            is_often.then_some(number::TOO_MANY_RESETS)
        };
        record.fault = fault.unwrap_or(record.fault);
        record.is_fresh = false;
        let refusal = match (fault, cause) {
            (Some(fault), _) => Some(NotArmed::After(fault)),
            _ if record.is_stopped => Some(NotArmed::Stopped),
            (None, StartCause::Other) => Some(NotArmed::Unknown),
            (None, StartCause::Power) => None,
            (None, _) => Some(NotArmed::Reset),
        };
        let start = Startup {
            number: record.starts,
            fault: record.fault,
            refusal,
        };
        (record, start)
    }

    fn count_reset(&mut self) -> bool {
        let is_often = self.windows.iter().all(|window| *window > 0);
        // The place of the reset that is longest ago.
        if let Some(oldest) = self.windows.iter_mut().min() {
            *oldest = RESET_WINDOW_S;
        }
        is_often
    }
}

/// FNV-1a by words. Memory of zeros or ones is not its own sum.
fn sum(words: [u32; RECORD_WORDS - 1]) -> u32 {
    words.into_iter().fold(0x811C_9DC5, |sum, word| {
        (sum ^ word).wrapping_mul(0x0100_0193)
    })
}

#[cfg(test)]
mod tests {
    use super::{NotArmed, Record, StartCause, Started, Startup};
    use crate::faults::number;

    fn after(record: Record, seconds: u8, cause: StartCause) -> (Record, Startup) {
        let mut record = Record::load(record.words()).expect("its sum is right");
        for _ in 0..seconds {
            record.second();
        }
        Record::start(Some(record), cause)
    }

    fn powered() -> Record {
        let (record, start) = Record::start(None, StartCause::Power);
        assert_eq!((start.number, start.fault), (1, 0));
        assert_eq!(start.may_arm(true), Ok(()));
        record
    }

    #[test]
    fn how_a_board_started_is_read_as_it_was_answered() {
        for cause in StartCause::ALL {
            for [is_internal, browns_out_late] in [[false, true], [true, false]] {
                let started = Started {
                    number: u32::MAX,
                    cause,
                    fault: number::SUPPLY_LOW,
                    is_internal,
                    browns_out_late,
                };
                assert_eq!(Started::of(started.values()), started);
            }
        }
    }

    #[test]
    fn a_reset_arms_nothing() {
        for (cause, arms) in [
            (StartCause::Pin, Err(NotArmed::Reset)),
            (StartCause::Software, Err(NotArmed::Reset)),
            (StartCause::Watchdog, Err(NotArmed::After(number::WATCHDOG))),
            (StartCause::BrownOut, Err(NotArmed::After(number::SUPPLY))),
            // RAM has kept its contents: the supply was away for a moment.
            (StartCause::Power, Err(NotArmed::After(number::SUPPLY))),
            (StartCause::Other, Err(NotArmed::Unknown)),
        ] {
            let (_, start) = after(powered(), 100, cause);
            assert_eq!(start.may_arm(true), arms, "{cause:?}");
            assert_eq!(start.number, 2);
            assert_eq!(start.may_arm(false), arms, "{cause:?}");
        }
        let (_, start) = Record::start(None, StartCause::Power);
        assert_eq!(start.may_arm(false), Err(NotArmed::OnCommand));
        // Without a record nothing is known of what was before.
        let (_, start) = Record::start(None, StartCause::Pin);
        assert_eq!(start.may_arm(true), Err(NotArmed::Reset));
    }

    #[test]
    fn a_stop_outlives_every_reset_until_somebody_arms() {
        for cause in StartCause::ALL {
            let mut record = powered();
            record.set_stopped(true);
            let (record, start) = after(record, 100, cause);
            assert!(start.may_arm(true).is_err(), "{cause:?}");
            let (mut record, start) = after(record, 100, StartCause::Pin);
            assert_eq!(start.may_arm(true), Err(NotArmed::Stopped), "{cause:?}");
            record.set_stopped(false);
            let (_, start) = after(record, 100, StartCause::Pin);
            assert_eq!(start.may_arm(true), Err(NotArmed::Reset), "{cause:?}");
        }
        // Behind a fault it is there still.
        let mut record = powered();
        record.set_stopped(true);
        record.note(number::PANIC);
        let (record, _) = after(record, 0, StartCause::Watchdog);
        let (_, start) = after(record, 0, StartCause::Pin);
        assert_eq!(start.may_arm(true), Err(NotArmed::Stopped));
    }

    #[test]
    fn a_fault_is_reported_at_the_next_start_and_stays_known() {
        for fault in [number::PANIC, number::HARD_FAULT, number::SUPPLY] {
            let mut record = powered();
            record.note(fault);
            // Whoever is quicker than the watchdog does not arm it either.
            for cause in [StartCause::Watchdog, StartCause::Pin] {
                let (record, start) = after(record, 100, cause);
                assert_eq!(start.may_arm(true), Err(NotArmed::After(fault)));
                let (_, start) = after(record, 100, StartCause::Pin);
                assert_eq!(start.may_arm(true), Err(NotArmed::Reset));
                assert_eq!(start.fault, fault);
            }
        }
    }

    #[test]
    fn three_resets_in_a_minute_are_too_many() {
        let arms = |pauses: [u8; 3]| {
            let mut starts = pauses.into_iter().scan(powered(), |record, pause| {
                let (next, start) = after(*record, pause, StartCause::Pin);
                *record = next;
                Some(start.may_arm(true))
            });
            starts.nth(2).expect("three starts")
        };
        let refused = Err(NotArmed::After(number::TOO_MANY_RESETS));
        assert_eq!(arms([0, 0, 0]), refused);
        assert_eq!(arms([90, 29, 30]), refused);
        assert_eq!(arms([0, 30, 30]), Err(NotArmed::Reset));
        assert_eq!(arms([0, 60, 0]), Err(NotArmed::Reset));
    }

    #[test]
    fn what_is_not_a_record_is_not_taken_for_one() {
        assert_eq!(Record::load([0; 4]), None);
        assert_eq!(Record::load([u32::MAX; 4]), None);
        let mut record = powered();
        record.note(number::HARD_FAULT);
        let words = record.words();
        assert_eq!(Record::load(words), Some(record));
        for bit in 0..128 {
            let mut flipped = words;
            flipped[bit / 32] ^= 1 << (bit % 32);
            assert_eq!(Record::load(flipped), None, "bit {bit}");
        }
    }
}
