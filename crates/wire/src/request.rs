//! A request: a command with a tag and a sum.

use crate::loading::Load;
use crate::words::{halves, word, words};

/// Words of a request.
pub const REQUEST_WORDS: usize = 3;

/// Bytes of a request.
pub const REQUEST_BYTES: usize = REQUEST_WORDS * size_of::<u32>();

/// A whisker of the array.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WhiskerId {
    /// 0 left, 1 right; below 16.
    pub side: u8,
    /// Counted from 0; below 16.
    pub number: u8,
}

impl WhiskerId {
    /// Of its byte in a request.
    const fn from_byte(byte: u8) -> Self {
        Self {
            side: byte >> 4,
            number: byte & 15,
        }
    }

    /// Its byte in a request.
    const fn byte(self) -> u8 {
        (self.side & 15) << 4 | self.number & 15
    }
}

/// What a module can be told. Between two ticks it is carried out, or refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    /// Runs a motor that rests after faults, or was given up, again.
    Clear(WhiskerId),
    /// Finds the whisker's rest anew, where the scene says that it is found.
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
    /// Says the CRC-32 of the configuration that it runs by and its length in bytes, with
    /// [`CONFIG_CHANGED`] where it is not the one of the start; or 0 and the negative number of
    /// why there is none.
    Scene,
    /// Puts the next word of a configuration aside, with the lowest byte of its number.
    Stage(u8, u32),
    /// Has the configuration that was put aside take effect between two ticks, if it has so many
    /// bytes; answered by 0, or by what is wrong with it: a kind and a number.
    Apply(u32),
    /// Forgets what was put aside.
    Forget,
    /// Ends the module's work and erases flash for a scene and its model, of which so many words
    /// are to come; with all motors off. From then on until it starts again there are
    /// [`Command::Word`] and [`Command::Restart`] alone.
    Load(Load),
    /// The next word, with the lowest byte of its number; they come in the order of
    /// [`Load::word`].
    Word(u8, u32),
    /// Starts again, with what was loaded.
    Restart,
    /// Says the zero of the whisker's sensor, where it is found by itself: codes from mid-scale,
    /// x and y. Records tell readings without it.
    Zero(WhiskerId),
    /// Says what a configuration for it is made for: the number of its board, 256 times that of
    /// its number format added, and the version of the layout that it reads.
    Board,
}

/// In the second value of the answer to [`Command::Scene`]: the configuration is not the one of
/// the start.
pub const CONFIG_CHANGED: i32 = 1 << 24;

/// A command with its tag.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

impl Command {
    /// Its number.
    // Apart, as it takes a jump by a table wherever it is.
    #[inline(never)]
    pub const fn number(self) -> u8 {
        match self {
            Self::Hello => 1,
            Self::Status => 2,
            Self::Name(_) => 3,
            Self::Stream(_) => 4,
            Self::Arm => 5,
            Self::Stop => 6,
            Self::Clear(_) => 7,
            Self::Home(_) => 8,
            Self::Gain(..) => 9,
            Self::Setpoint(..) => 10,
            Self::Release(_) => 11,
            Self::Version => 12,
            Self::Model => 13,
            Self::Config(_) => 14,
            Self::Stage(..) => 15,
            Self::Load(_) => 16,
            Self::Word(..) => 17,
            Self::Apply(_) => 18,
            Self::Forget => 19,
            Self::Restart => 20,
            Self::Zero(_) => 21,
            Self::Scene => 22,
            Self::Board => 23,
        }
    }

    /// The word for it in a [text](crate::text).
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hello => "hello",
            Self::Status => "status",
            Self::Name(_) => "name",
            Self::Stream(_) => "stream",
            Self::Arm => "arm",
            Self::Stop => "stop",
            Self::Clear(_) => "clear",
            Self::Home(_) => "home",
            Self::Gain(..) => "gain",
            Self::Setpoint(..) => "setpoint",
            Self::Release(_) => "release",
            Self::Version => "version",
            Self::Model => "model",
            Self::Config(_) => "config",
            Self::Scene => "scene",
            Self::Stage(..) => "stage",
            Self::Apply(_) => "apply",
            Self::Forget => "forget",
            Self::Load(_) => "load",
            Self::Word(..) => "word",
            Self::Restart => "restart",
            Self::Zero(_) => "zero",
            Self::Board => "board",
        }
    }

    /// The whisker that it is for, the left side's first where it is for all, and its value.
    const fn parts(self) -> (WhiskerId, i32) {
        const ALL: WhiskerId = WhiskerId { side: 0, number: 0 };
        match self {
            Self::Hello
            | Self::Status
            | Self::Arm
            | Self::Stop
            | Self::Version
            | Self::Model
            | Self::Forget
            | Self::Scene
            | Self::Board
            | Self::Restart => (ALL, 0),
            Self::Stage(number, word) | Self::Word(number, word) => {
                (WhiskerId::from_byte(number), word.cast_signed())
            }
            Self::Apply(value) | Self::Config(value) => (ALL, value.cast_signed()),
            Self::Load(load) => (ALL, load.value().cast_signed()),
            Self::Name(from) => (ALL, from as i32),
            Self::Stream(on) => (ALL, on as i32),
            Self::Clear(whisker)
            | Self::Home(whisker)
            | Self::Release(whisker)
            | Self::Zero(whisker) => (whisker, 0),
            Self::Gain(whisker, value) | Self::Setpoint(whisker, value) => (whisker, value),
        }
    }

    /// The command of these parts.
    const fn from_parts(number: u8, whisker: WhiskerId, value: i32) -> Option<Self> {
        Some(match number {
            1 => Self::Hello,
            2 => Self::Status,
            3 => Self::Name(value as u8),
            4 => Self::Stream(value != 0),
            5 => Self::Arm,
            6 => Self::Stop,
            7 => Self::Clear(whisker),
            8 => Self::Home(whisker),
            9 => Self::Gain(whisker, value),
            10 => Self::Setpoint(whisker, value),
            11 => Self::Release(whisker),
            12 => Self::Version,
            13 => Self::Model,
            14 => Self::Config(value.cast_unsigned()),
            15 => Self::Stage(whisker.byte(), value.cast_unsigned()),
            16 => Self::Load(Load::from_value(value.cast_unsigned())),
            17 => Self::Word(whisker.byte(), value.cast_unsigned()),
            18 => Self::Apply(value.cast_unsigned()),
            19 => Self::Forget,
            20 => Self::Restart,
            21 => Self::Zero(whisker),
            22 => Self::Scene,
            23 => Self::Board,
            _ => return None,
        })
    }
}

impl TaggedCommand {
    /// As it is sent: tag, number and whisker; value; sum.
    pub const fn words(&self) -> [u32; REQUEST_WORDS] {
        let (whisker, value) = self.command.parts();
        let first = word(
            self.tag,
            u16::from_le_bytes([self.command.number(), whisker.byte()]),
        );
        let value = value.cast_unsigned();
        [first, value, sum(first, value)]
    }

    /// As it is sent, byte by byte.
    pub fn bytes(&self) -> [u8; REQUEST_BYTES] {
        let [a, b, c] = self.words().map(u32::to_le_bytes);
        let mut bytes = [0; REQUEST_BYTES];
        for (byte, from) in bytes.iter_mut().zip([a, b, c].as_flattened()) {
            *byte = *from;
        }
        bytes
    }

    /// Its words but for the sum.
    pub const fn plain_words(&self) -> [u32; 2] {
        let [first, value, _] = self.words();
        [first, value]
    }

    /// What two words say whose [sum](summed) was right.
    ///
    /// # Errors
    /// [`UnknownCommand`].
    pub fn from_words(words: [u32; 2]) -> Result<Self, UnknownCommand> {
        let [first, value] = words;
        let [tag, what] = halves(first);
        let [command, place] = what.to_le_bytes();
        let whisker = WhiskerId::from_byte(place);
        let known = Command::from_parts(command, whisker, value.cast_signed());
        known
            .map(|command| Self { tag, command })
            .ok_or(UnknownCommand { tag, command })
    }
}

/// The words of a request but for their sum, if that is right; otherwise nobody has meant
/// them, and there is nothing to answer.
pub fn summed(bytes: &[u8; REQUEST_BYTES]) -> Option<[u32; 2]> {
    let [first, value, found] = words(bytes);
    (found == sum(first, value)).then_some([first, value])
}

/// CRC-32 of both words, as in the model file. Zeros, and RAM as it comes, do not have it.
const fn sum(first: u32, value: u32) -> u32 {
    const CRC: crc::Crc<u32, crc::NoTable> =
        crc::Crc::<u32, crc::NoTable>::new(&crc::CRC_32_ISO_HDLC);
    let [a, b, c, d] = first.to_le_bytes();
    let [e, f, g, h] = value.to_le_bytes();
    CRC.checksum(&[a, b, c, d, e, f, g, h])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Command, Load, REQUEST_BYTES, TaggedCommand, UnknownCommand, WhiskerId, summed};

    fn commands() -> impl Strategy<Value = Command> {
        let whisker = (0..16_u8, 0..16_u8).prop_map(|(side, number)| WhiskerId { side, number });
        (0..23_u8, whisker, any::<i32>()).prop_map(|(which, whisker, value)| {
            let name = value as u8;
            let word = value.cast_unsigned();
            match which {
                0 => Command::Hello,
                1 => Command::Status,
                2 => Command::Name(name),
                3 => Command::Stream(value > 0),
                4 => Command::Arm,
                5 => Command::Stop,
                6 => Command::Clear(whisker),
                7 => Command::Home(whisker),
                8 => Command::Gain(whisker, value),
                9 => Command::Setpoint(whisker, value),
                10 => Command::Release(whisker),
                11 => Command::Version,
                12 => Command::Model,
                13 => Command::Config(word),
                14 => Command::Stage(name, word.rotate_left(8)),
                15 => Command::Apply(word),
                16 => Command::Load(Load::from_value(word)),
                17 => Command::Word(name, word.rotate_left(8)),
                18 => Command::Restart,
                19 => Command::Zero(whisker),
                20 => Command::Scene,
                21 => Command::Board,
                _ => Command::Forget,
            }
        })
    }

    proptest! {
        #[test]
        fn a_request_is_read_as_it_was_meant(tag in any::<u16>(), command in commands()) {
            let request = TaggedCommand { tag, command };
            let words = summed(&request.bytes()).expect("its own sum");
            prop_assert_eq!(TaggedCommand::from_words(words), Ok(request));
        }

        #[test]
        fn a_request_with_a_flipped_bit_is_none(
            tag in any::<u16>(),
            command in commands(),
            bit in 0..8 * REQUEST_BYTES,
        ) {
            let mut bytes = TaggedCommand { tag, command }.bytes();
            bytes[bit / 8] ^= 1 << (bit % 8);
            prop_assert_eq!(summed(&bytes), None);
        }
    }

    #[test]
    fn memory_that_was_never_written_is_no_request() {
        for byte in [0, 0xFF, 0xCC] {
            assert_eq!(summed(&[byte; REQUEST_BYTES]), None);
        }
    }

    #[test]
    fn a_command_of_a_later_version_is_told_by_its_tag() {
        let found = TaggedCommand::from_words([0x00FF_0007, 0]);
        assert_eq!(
            found,
            Err(UnknownCommand {
                tag: 7,
                command: 255
            })
        );
    }

    #[test]
    fn the_sum_is_that_of_other_programs() {
        // python3 -c 'import zlib; print(hex(zlib.crc32(bytes([7,0,5,0,0,0,0,0]))))'
        let request = TaggedCommand {
            tag: 7,
            command: Command::Arm,
        };
        assert_eq!(request.words()[2], PYTHON);
    }

    /// See the test.
    const PYTHON: u32 = 0x3F2A_47C3;
}
