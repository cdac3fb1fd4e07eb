//! An answer: what became of a request.

use crate::flags::Flags;
use crate::words::{PACKET_WORDS, halves, word};

/// What became of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Answer {
    /// Ticks since the module started, as in a record.
    pub sequence: u32,
    /// That of the request.
    pub tag: u16,
    /// The number of its command.
    pub command: u8,
    /// What became of it.
    pub status: CommandStatus,
    /// What was asked for, if anything.
    pub values: [i32; 2],
}

/// What became of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CommandStatus {
    /// It is done.
    #[error("done")]
    Done,
    /// The command has no meaning in this program.
    #[error("unknown command")]
    Unknown,
    /// There is no such whisker, or it has no motor.
    #[error("no such whisker, or it has no motor")]
    NoWhisker,
    /// The value is outside its range; nothing has changed.
    #[error("value out of range")]
    OutOfRange,
    /// The part that it is for was left out of the program.
    #[error("not in this program")]
    NotHere,
    /// A number that this version does not know.
    #[error("status {0}")]
    Other(u8),
}

impl CommandStatus {
    /// Its number.
    pub const fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Unknown => 1,
            Self::NoWhisker => 2,
            Self::OutOfRange => 3,
            Self::NotHere => 4,
            Self::Other(code) => code,
        }
    }

    /// The status of a number.
    pub const fn from_code(code: u8) -> Self {
        match code {
            0 => Self::Done,
            1 => Self::Unknown,
            2 => Self::NoWhisker,
            3 => Self::OutOfRange,
            4 => Self::NotHere,
            code => Self::Other(code),
        }
    }
}

impl Answer {
    /// As it is sent.
    pub const fn words(&self) -> [u32; PACKET_WORDS] {
        let what = u16::from_le_bytes([self.status.code(), self.command]);
        [
            self.sequence,
            word(self.tag, what),
            self.values[0].cast_unsigned(),
            self.values[1].cast_unsigned(),
            word(0, Flags::ANSWER.bits()),
        ]
    }

    /// As it was sent.
    pub(crate) const fn from_words(words: [u32; PACKET_WORDS]) -> Self {
        let [tag, what] = halves(words[1]);
        let [status, command] = what.to_le_bytes();
        Self {
            sequence: words[0],
            tag,
            command,
            status: CommandStatus::from_code(status),
            values: [words[2].cast_signed(), words[3].cast_signed()],
        }
    }
}
