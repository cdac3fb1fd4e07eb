//! Faults and limits: a number, a text, a reaction and a recovery for each.
//!
//! Log, messages and `docs/faults.md` come from one table, `faults/table.rs`.

mod table;

use crate::Part;

/// What a fault or limit does at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reaction {
    /// A fault of one whisker: its motor is off, and it touches and decides nothing.
    WhiskerOff,
    /// A fault of the board: every motor output low, then a line in the log, then a reset.
    AllOff,
    /// A fault of the start: motors stay off, all else goes on.
    NotArmed,
    /// A limit: the module goes on.
    GoesOn,
}

/// How it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Recovery {
    /// The motor is tried again after a rest; after too many faults, only on command.
    Retry,
    /// Once frames have been good for a while.
    GoodFrames,
    /// Nothing to end: it was counted.
    Counted,
    /// With the start after the reset, motors off until they are armed; it may come again.
    Restart,
    /// Once motors are armed.
    Armed,
    /// Once a model is deployed that fits.
    Deployed,
}

/// A fault or limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultRow {
    /// Its number, which never changes its meaning.
    pub number: u8,
    /// What is wrong.
    pub name: &'static str,
    /// Likely causes.
    pub causes: &'static str,
    /// What to check, in Markdown as of a page in `docs/`.
    pub check: &'static str,
    /// What it does at once.
    pub reaction: Reaction,
    /// How it ends.
    pub recovery: Recovery,
}

macro_rules! rows {
    ($($number:literal $constant:ident: $text:literal, $check:literal, $reaction:ident, $recovery:ident;)*) => {
        /// The number of each.
        pub mod number {
            $(
                #[doc = $text]
                pub const $constant: u8 = $number;
            )*
        }

        /// What is wrong, and likely causes, of a number, where there is no room for the rest.
        // Once in the program.
        #[inline(never)]
        pub const fn text(number: u8) -> &'static str {
            match number {
                $($number if can_occur($number) => $text,)*
                _ => "not in the table (an older table?)",
            }
        }

        /// Every fault and limit, by number.
        pub const TABLE: &[FaultRow] = &[$(
            FaultRow {
                number: $number,
                name: parts($text)[0],
                causes: parts($text)[1],
                check: $check,
                reaction: Reaction::$reaction,
                recovery: Recovery::$recovery,
            },
        )*];
    };
}
crate::fault_table!(rows);

/// What is wrong, and likely causes, of `what is wrong (likely causes?)`.
const fn parts(text: &'static str) -> [&'static str; 2] {
    let mut at = 0;
    while text.as_bytes()[at] != b'(' {
        at += 1;
    }
    let (name, causes) = text.split_at(at);
    [
        name.split_at(at - 1).0,
        causes.split_at(causes.len() - 2).0.split_at(1).1,
    ]
}

/// Whether it can occur in an image of these parts: what cannot has no text there.
pub const fn can_occur(number: u8) -> bool {
    match number {
        number::HALL_LOW..=number::SKIPPED_SECTOR => Part::SixStep.is_built(),
        ..=number::LOST_COUNTS | number::UNFELT => Part::Motion.is_built(),
        number::TILT_NO_SENSOR..=number::TILT_NO_MAGNET => Part::Tmag5170.is_built(),
        number::TWIN => Part::Bus.is_built(),
        number::NO_MODEL | number::MODEL => Part::Classifier.is_built(),
        _ => true,
    }
}

/// The name of the fault or limit with this number; empty if there is none.
pub fn name(number: u8) -> &'static str {
    let row = TABLE.iter().find(|row| row.number == number);
    row.map_or("", |row| row.name)
}

#[cfg(test)]
mod tests {
    use super::{Reaction, TABLE, number};
    use whisking::motor::Fault;

    #[test]
    fn numbers_rise_and_each_kind_keeps_to_its_own() {
        assert!(TABLE.is_sorted_by(|a, b| a.number < b.number));
        for row in TABLE {
            let reaction = match row.number {
                1..=31 => Reaction::WhiskerOff,
                32..=47 => Reaction::GoesOn,
                number::TOO_MANY_RESETS | number::TWIN => Reaction::NotArmed,
                _ => Reaction::AllOff,
            };
            assert_eq!(row.reaction, reaction, "{row:?}");
        }
    }

    #[test]
    fn every_fault_of_a_motor_has_its_row() {
        let motor = TABLE.iter().filter(|row| row.number < 16);
        assert!(motor.map(|row| row.number).eq(1..=number::LOST_COUNTS));
        assert_eq!(Fault::from_code(number::LOST_COUNTS + 1), None);
        let named = [
            (Fault::Pin, number::MOTOR_PIN),
            (Fault::Pwm, number::MOTOR_PWM),
            (Fault::InvalidHall(0), number::HALL_LOW),
            (Fault::InvalidHall(7), number::HALL_HIGH),
            (Fault::SkippedSector, number::SKIPPED_SECTOR),
            (Fault::Stall, number::STALL),
            (Fault::Following, number::FOLLOWING),
            (Fault::Runaway, number::RUNAWAY),
            (Fault::Encoder, number::ENCODER),
            (Fault::Travel, number::TRAVEL),
            (Fault::Heat, number::HEAT),
            (Fault::Homing, number::HOMING),
            (Fault::LostCounts, number::LOST_COUNTS),
        ];
        assert!(named.into_iter().all(|(fault, code)| fault.code() == code));
    }
}
