//! A request: a command with a tag.

use serde::{Deserialize, Serialize};

use crate::answer::{Answer, CommandStatus};
use crate::loading::Load;

/// A whisker of the array.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct WhiskerId {
    /// 0 left, 1 right.
    pub side: u8,
    /// Counted from 0.
    pub number: u8,
}

/// What a module can be asked to do. It is carried out between two ticks, or refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Command {
    /// Says the rate of ticks, Hz, and how many whiskers there are.
    Hello,
    /// Says how many records were lost for want of room and how many ticks were missed since
    /// the start.
    Status,
    /// Says eight letters of the scene's name from this one on, four in each value, the first
    /// in its lowest byte; zeros follow the last.
    Name(u8),
    /// Sends records from now on, or no more.
    Stream(bool),
    /// Arms the motors. Whoever arms a motor that is off says that its whisker is at rest,
    /// unless it is homed.
    Arm,
    /// Motors off, until they are armed.
    Stop,
    /// Runs a motor again that is off after faults, or was given up.
    Clear(WhiskerId),
    /// Finds the whisker's rest again, where the scene says that it is found.
    Home(WhiskerId),
    /// Sets the nominal gain g (BIOTACT eq. 12), Q24, 0 to 2.
    Gain(WhiskerId, i32),
    /// Sets a setpoint in place of the pattern generator's: protraction, Q24, within the
    /// scene's range.
    Setpoint(WhiskerId, i32),
    /// Gives the setpoint back to the pattern generator.
    Release(WhiskerId),
    /// Says the version of the firmware: 2^16 times its major number plus its minor one, and
    /// its patch.
    Version,
    /// Says which model it decides by: the CRC-32 at the end of the model's file and the number
    /// of its classes; or 0 and the negative number of why there is none.
    Model,
    /// Says two words of the configuration that it runs by, from this one on, little-endian;
    /// zeros follow the last.
    Config(u32),
    /// Puts the next word of a configuration aside, with the lowest byte of its number.
    Stage(u8, u32),
    /// Ends the module's work and erases flash for a scene and its model, of which so many words
    /// are to come; with all motors off. From then on until it starts again there are
    /// [`Command::Word`] and [`Command::Restart`] alone.
    Load(Load),
    /// The next word, with the lowest byte of its number; they come in the order of
    /// [`Load::word`].
    Word(u8, u32),
    /// Has the configuration that was put aside take effect between two ticks, if it has so many
    /// bytes; answered by 0, or by what is wrong with it: a kind and a number.
    Apply(u32),
    /// Forgets what was put aside.
    Forget,
    /// Starts again, with what was loaded.
    Restart,
    /// Says the zero of the whisker's sensor, where it is found by itself: codes from mid-scale,
    /// x and y. Records have readings without it.
    Zero(WhiskerId),
    /// Says the CRC-32 of the configuration that it runs by and its length in bytes, with
    /// [`CONFIG_CHANGED`] where it is not the one of the start; or 0 and the negative number of
    /// why there is none.
    Scene,
    /// Says what a configuration for it is made for: the number of its board, 256 times that of
    /// its number format added, and the version of the layout that it reads.
    Board,
    /// Says eight letters of the name of a class, from this one on, as [`Command::Name`] does.
    Class(u8, u8),
    /// Says the last frame of the whisker's sensor as it came, B0 in the highest place of the first
    /// value.
    Frame(WhiskerId),
    /// Says how it started: how often since power-up, and why, after which fault and by what clock.
    Started,
    /// Says how the whisker is, as [`Looked`](crate::Looked) has it, where it is one of a head.
    Look(WhiskerId),
}

/// In the second value of the answer to [`Command::Scene`]: the configuration is not the one of
/// the start.
pub const CONFIG_CHANGED: i32 = 1 << 24;

/// In the second value of the answer to [`Command::Board`]: the image has the code for models with
/// a second opinion.
pub const HAS_OPINIONS: i32 = 1 << 16;

/// A command with its tag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TaggedCommand {
    /// Chosen by whoever asks; the answer has the same.
    pub tag: u16,
    /// What is to be done.
    pub command: Command,
}

/// A command that this version does not know.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("unknown command {command}")]
pub struct UnknownCommand {
    /// That of the request.
    pub tag: u16,
    /// Its number.
    pub command: u8,
}

impl UnknownCommand {
    /// Its answer, in tick `sequence`.
    pub const fn answer(self, sequence: u32) -> Answer {
        Answer {
            sequence,
            tag: self.tag,
            command: self.command,
            status: CommandStatus::Unknown,
            values: [0; 2],
        }
    }
}

impl Command {
    /// Its number: the order above, from 0, by which it is sent.
    // Apart, as it takes a jump by a table wherever it is.
    #[inline(never)]
    pub const fn number(self) -> u8 {
        match self {
            Self::Hello => 0,
            Self::Status => 1,
            Self::Name(_) => 2,
            Self::Stream(_) => 3,
            Self::Arm => 4,
            Self::Stop => 5,
            Self::Clear(_) => 6,
            Self::Home(_) => 7,
            Self::Gain(..) => 8,
            Self::Setpoint(..) => 9,
            Self::Release(_) => 10,
            Self::Version => 11,
            Self::Model => 12,
            Self::Config(_) => 13,
            Self::Stage(..) => 14,
            Self::Load(_) => 15,
            Self::Word(..) => 16,
            Self::Apply(_) => 17,
            Self::Forget => 18,
            Self::Restart => 19,
            Self::Zero(_) => 20,
            Self::Scene => 21,
            Self::Board => 22,
            Self::Class(..) => 23,
            Self::Frame(_) => 24,
            Self::Started => 25,
            Self::Look(_) => 26,
        }
    }

    /// The word for it in a [text](crate::text).
    pub fn name(self) -> &'static str {
        let name = NAMES.get(usize::from(self.number()));
        name.copied().unwrap_or_default()
    }
}

/// The words of commands, by their numbers.
const NAMES: [&str; 27] = [
    "hello", "status", "name", "stream", "arm", "stop", "clear", "home", "gain", "setpoint",
    "release", "version", "model", "config", "stage", "load", "word", "apply", "forget", "restart",
    "zero", "scene", "board", "class", "frame", "started", "look",
];

#[cfg(test)]
pub(crate) mod tests {
    use proptest::prelude::*;

    use super::{Command, NAMES};
    use crate::COMMAND_MOST;

    /// Any command, by its number and any bytes behind it.
    pub(crate) fn commands() -> impl Strategy<Value = Command> {
        let bytes = (0..NAMES.len() as u8, any::<[u8; COMMAND_MOST]>());
        bytes.prop_filter_map("no command", |(number, mut bytes)| {
            bytes[0] = number;
            if number == Command::Stream(true).number() {
                bytes[1] &= 1;
            }
            let (command, _) = postcard::take_from_bytes(&bytes).ok()?;
            Some(command)
        })
    }
}
