//! Another configuration for a module that runs.
//!
//! A PC sends the words of one, which are put aside. [`Command::Apply`] has it decoded and
//! checked where there is time for that, on a board in idle ([`Tuning::prepare`]); then it takes
//! effect between two ticks ([`take_over`]), all at once, or not at all. What was put aside stays
//! until it is forgotten, so that a request whose answer was lost can be repeated.

use whisking::Real;
use wire::{Answer, CONFIG_CHANGED, Command, CommandStatus, HAS_OPINIONS, TaggedCommand};

use crate::config::{
    BoardCode, CONFIG_BYTES, ConfigError, HEADER_BYTES, Header, VERSION, decode_into,
};
use crate::module::{Hardware, Module};
use crate::{Config, Field, Part};

/// Room for another configuration, where an image takes one.
const ROOM: usize = if Part::Set.is_built() {
    CONFIG_BYTES
} else {
    0
};

type Bytes = heapless::Vec<u8, ROOM>;

/// The configuration that a module runs by, as bytes, and the next; `B` has those of its start.
#[derive(Debug)]
pub struct Tuning<B> {
    board: BoardCode,
    first: B,
    since: Bytes,
    staged: Bytes,
}

/// What idle, or a simulation, has made of a request about configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prepared {
    /// This is the answer.
    Done(CommandStatus, [i32; 2]),
    /// It is to take effect, by [`take_over`]; then [`Tuning::has_taken`] is called.
    Next,
}

/// The first value of an answer to [`Command::Apply`] that refuses a configuration; the second
/// is the number of a field or part, or 0.
#[must_use]
pub const fn refusal_code(error: ConfigError) -> [i32; 2] {
    match error {
        ConfigError::Absent => [1, 0],
        ConfigError::Strange => [2, 0],
        ConfigError::Version(version) => [3, version as i32],
        ConfigError::Board(board) => [4, board as i32],
        ConfigError::Format(format) => [5, format as i32],
        ConfigError::TooLong => [6, 0],
        ConfigError::Damaged => [7, 0],
        ConfigError::Unreadable(part) => [8, part.code() as i32],
        ConfigError::NotBuilt(part) => [9, part.code() as i32],
        ConfigError::Range(field) => [10, field.code() as i32],
        ConfigError::Room(field) => [11, field.code() as i32],
        ConfigError::Shape(field) => [12, field.code() as i32],
        ConfigError::Armed(field) => [13, field.code() as i32],
    }
}

/// What [`refusal_code`] says; `None` for numbers of a later version.
pub fn refusal_of([kind, number]: [i32; 2]) -> Option<ConfigError> {
    let byte = u8::try_from(number);
    let part = || Part::from_code(byte.ok()?);
    let field = || Field::from_code(byte.ok()?);
    Some(match kind {
        1 => ConfigError::Absent,
        2 => ConfigError::Strange,
        3 => ConfigError::Version(u16::try_from(number).ok()?),
        4 => ConfigError::Board(byte.ok()?),
        5 => ConfigError::Format(byte.ok()?),
        6 => ConfigError::TooLong,
        7 => ConfigError::Damaged,
        8 => ConfigError::Unreadable(part()?),
        9 => ConfigError::NotBuilt(part()?),
        10 => ConfigError::Range(field()?),
        11 => ConfigError::Room(field()?),
        12 => ConfigError::Shape(field()?),
        13 => ConfigError::Armed(field()?),
        _ => return None,
    })
}

impl<B: AsRef<[u8]>> Tuning<B> {
    /// Of a module that starts by the configuration at the start of `first`, which may go on
    /// behind it; or by none, and nothing is there.
    pub const fn new(board: BoardCode, first: B) -> Self {
        Self {
            board,
            first,
            since: Bytes::new(),
            staged: Bytes::new(),
        }
    }

    /// The module has started again.
    pub fn restart(&mut self) {
        self.since.clear();
        self.staged.clear();
    }

    /// The bytes of the configuration that runs.
    pub fn running(&self) -> &[u8] {
        let bytes = match self.since.as_slice() {
            [] => self.first.as_ref(),
            since => since,
        };
        let length = Header::of(bytes).map_or(0, |header| header.length as usize);
        let length = HEADER_BYTES.saturating_add(length);
        bytes.get(..length).unwrap_or_default()
    }

    /// Whether it is another than that of the start.
    pub fn has_changed(&self) -> bool {
        let sum = |bytes: &[u8]| Header::of(bytes).ok().map(|header| header.crc);
        !self.since.is_empty() && sum(&self.since) != sum(self.first.as_ref())
    }

    /// The answer to a question about the configuration that runs; `None` if it is none.
    #[inline(never)]
    pub fn read<R: Real>(&self, command: Command) -> Option<(CommandStatus, [i32; 2])> {
        let running = self.running();
        let values = match command {
            Command::Config(word) => {
                let first = usize::try_from(word).unwrap_or(usize::MAX);
                if first.saturating_mul(4) >= running.len() {
                    return Some((CommandStatus::OutOfRange, [0; 2]));
                }
                [first, first.saturating_add(1)].map(|n| word_of(running, n).cast_signed())
            }
            Command::Scene => match Header::of(running) {
                Ok(header) => {
                    let changed = if self.has_changed() {
                        CONFIG_CHANGED
                    } else {
                        0
                    };
                    [header.crc.cast_signed(), running.len() as i32 | changed]
                }
                Err(error) => [0, -refusal_code(error)[0]],
            },
            Command::Board => {
                let program = u16::from_le_bytes([self.board as u8, R::FORMAT as u8]);
                let opinions = if tactile::OPINION { HAS_OPINIONS } else { 0 };
                [i32::from(program), i32::from(VERSION) | opinions]
            }
            _ => return None,
        };
        Some((CommandStatus::Done, values))
    }

    /// What to do about a request for another configuration, which is read into `next` where it
    /// is to take effect; `None` if it is not one.
    #[inline(never)]
    pub fn prepare<R: Real>(&mut self, command: Command, next: &mut Config<R>) -> Option<Prepared> {
        if !Part::Set.is_built() {
            return None;
        }
        let (status, values) = match command {
            Command::Stage(number, word) => self.stage(number, word),
            Command::Apply(length) => {
                let bytes = usize::try_from(length).ok();
                let bytes = bytes.and_then(|length| self.staged.get(..length));
                let bytes = bytes.ok_or(ConfigError::TooLong);
                match bytes.and_then(|bytes| decode_into(next, bytes, self.board)) {
                    Ok(()) => return Some(Prepared::Next),
                    Err(error) => (CommandStatus::OutOfRange, refusal_code(error)),
                }
            }
            Command::Forget => {
                self.staged.clear();
                (CommandStatus::Done, [0; 2])
            }
            _ => return None,
        };
        Some(Prepared::Done(status, values))
    }

    /// The last one may come again, from whoever missed the answer.
    fn stage(&mut self, number: u8, word: u32) -> (CommandStatus, [i32; 2]) {
        let count = self.staged.len() / 4;
        let is_last = count > 0 && number == (count - 1) as u8;
        let is_again = is_last && word_of(&self.staged, count - 1) == word;
        let is_next = number == count as u8;
        let is_put = is_next && self.staged.extend_from_slice(&word.to_le_bytes()).is_ok();
        if is_put || is_again {
            (CommandStatus::Done, [(self.staged.len() / 4) as i32, 0])
        } else {
            (CommandStatus::OutOfRange, [count as i32, 0])
        }
    }

    /// What was put aside, of so many bytes, has taken effect.
    pub fn has_taken(&mut self, length: u32) {
        // It was decoded from there.
        if let Some(bytes) = self.staged.get(..length as usize) {
            self.since.clear();
            // There is as much room.
            let _ = self.since.extend_from_slice(bytes);
        }
    }
}

/// The answer to a request, of the `sequence`-th tick.
pub fn answer(
    request: TaggedCommand,
    sequence: u32,
    (status, values): (CommandStatus, [i32; 2]),
) -> Answer {
    Answer {
        sequence,
        tag: request.tag,
        command: request.command.number(),
        status,
        values,
    }
}

/// The `n`-th word; zeros follow the last byte.
fn word_of(bytes: &[u8], n: usize) -> u32 {
    let mut word = [0; 4];
    let rest = bytes.get(n.saturating_mul(4)..).unwrap_or_default();
    for (place, byte) in word.iter_mut().zip(rest) {
        *place = *byte;
    }
    u32::from_le_bytes(word)
}

/// Has a module that runs by `config` go on by `next` from now on, between two ticks: its caller
/// gives it that one in each tick from now on.
///
/// # Errors
/// [`ConfigError::Shape`] or [`ConfigError::Armed`]; nothing has changed.
pub fn take_over<R: Real, H: Hardware>(
    module: &mut Module<R, H>,
    config: &Config<R>,
    next: &Config<R>,
) -> Result<(), ConfigError> {
    config.may_become(next, module.is_armed())?;
    module.retune(config, next);
    Ok(())
}

/// The status and values that answer [`Command::Apply`].
pub const fn applied(taken: Result<(), ConfigError>) -> (CommandStatus, [i32; 2]) {
    match taken {
        Ok(()) => (CommandStatus::Done, [0; 2]),
        Err(error @ ConfigError::Armed(_)) => (CommandStatus::Armed, refusal_code(error)),
        Err(error) => (CommandStatus::OutOfRange, refusal_code(error)),
    }
}
