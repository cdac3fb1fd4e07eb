//! An answer: what became of a request.

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
#[error("{}", self.text())]
#[expect(missing_docs, reason = "the texts say it")]
pub enum CommandStatus {
    Done,
    Unknown,
    NoWhisker,
    OutOfRange,
    NotHere,
    TooSlow,
    Armed,
    NotWritten,
    Stopped,
    TooManyFaults,
    NoBoard,
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
            Self::TooSlow => 5,
            Self::Armed => 6,
            Self::NotWritten => 7,
            Self::Stopped => 8,
            Self::TooManyFaults => 9,
            Self::NoBoard => 10,
            Self::Other(code) => code,
        }
    }

    /// It in words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Unknown => "unknown command",
            Self::NoWhisker => "no such whisker, or it has no motor",
            Self::OutOfRange => "value out of range",
            Self::NotHere => "not in this program",
            Self::TooSlow => "too much for this baud",
            Self::Armed => "a motor is armed",
            Self::NotWritten => "the flash did not take it",
            Self::Stopped => "a stop has come since",
            Self::TooManyFaults => "too many faults, wait a minute",
            Self::NoBoard => "no such board, or it does not answer",
            Self::Other(_) => "a status of a later version",
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
            5 => Self::TooSlow,
            6 => Self::Armed,
            7 => Self::NotWritten,
            8 => Self::Stopped,
            9 => Self::TooManyFaults,
            10 => Self::NoBoard,
            code => Self::Other(code),
        }
    }
}

impl Answer {
    /// As it is sent.
    pub const fn words(&self) -> [u32; 5] {
        let [low, high] = self.tag.to_le_bytes();
        let what = u32::from_le_bytes([low, high, self.command, self.status.code()]);
        let [first, second] = self.values;
        let values = [first.cast_unsigned(), second.cast_unsigned()];
        [self.sequence, what, values[0], values[1], 0]
    }

    /// As it was sent.
    pub const fn from_words([sequence, what, first, second, _]: [u32; 5]) -> Self {
        let [low, high, command, status] = what.to_le_bytes();
        Self {
            sequence,
            tag: u16::from_le_bytes([low, high]),
            command,
            status: CommandStatus::from_code(status),
            values: [first.cast_signed(), second.cast_signed()],
        }
    }
}
