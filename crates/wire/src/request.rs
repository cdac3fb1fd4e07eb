//! A request: a command with a tag and a sum.

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
    /// Says a constant of the settings, by its number: its two words. Number 0 says the number
    /// format, with [`SETTINGS_DIFFER`] in it, and a sum of all constants.
    Constant(u8),
    /// Puts a word of a constant aside, until all that belong together are there: the
    /// constant's number, plus [`SECOND_WORD`] for its second word.
    Stage(u8, u32),
    /// Has all words that were put aside take effect between two ticks, if this is their
    /// [sum](word_sum), in the order of their numbers.
    Apply(u32),
    /// Forgets what was put aside.
    Forget,
    /// Ends the module's work and erases the flash of the model, of which so many words are to
    /// come; by the serial port, and with all motors off. From then on until it starts anew
    /// there are [`Command::Word`] and [`Command::Restart`] alone.
    Load(u32),
    /// The next word of the model, with the lowest byte of its number; they come in
    /// [`load_order`](crate::load_order).
    Word(u8, u32),
    /// Starts anew, with what was loaded.
    Restart,
    /// Says the zero of the whisker's sensor, where it is found by itself: codes from mid-scale,
    /// x and y. Records tell readings without it.
    Zero(WhiskerId),
}

/// What the number of a constant's second word has more than that of its first.
pub const SECOND_WORD: u8 = 1 << 7;

/// In the first value of constant 0, beside the number format in its lowest byte: constants
/// differ from those that the program was built with.
pub const SETTINGS_DIFFER: u32 = 1 << 8;

/// The sum of numbered words: FNV-1a by words, which any change of one word changes, and a word
/// more or less.
pub fn word_sum(words: impl Iterator<Item = (u8, u32)>) -> u32 {
    words.fold(0x811C_9DC5, |sum, (number, word)| {
        let add = |sum: u32, word: u32| (sum ^ word).wrapping_mul(0x0100_0193);
        add(add(sum, number.into()), word)
    })
}

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
            Self::Constant(_) => 14,
            Self::Stage(..) => 15,
            Self::Load(_) => 16,
            Self::Word(..) => 17,
            Self::Apply(_) => 18,
            Self::Forget => 19,
            Self::Restart => 20,
            Self::Zero(_) => 21,
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
            Self::Constant(_) => "constant",
            Self::Stage(..) => "stage",
            Self::Apply(_) => "apply",
            Self::Forget => "forget",
            Self::Load(_) => "load",
            Self::Word(..) => "word",
            Self::Restart => "restart",
            Self::Zero(_) => "zero",
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
            | Self::Restart => (ALL, 0),
            Self::Constant(number) => (WhiskerId::from_byte(number), 0),
            Self::Stage(number, word) | Self::Word(number, word) => {
                (WhiskerId::from_byte(number), word.cast_signed())
            }
            Self::Apply(value) | Self::Load(value) => (ALL, value.cast_signed()),
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
            14 => Self::Constant(whisker.byte()),
            15 => Self::Stage(whisker.byte(), value.cast_unsigned()),
            16 => Self::Load(value.cast_unsigned()),
            17 => Self::Word(whisker.byte(), value.cast_unsigned()),
            18 => Self::Apply(value.cast_unsigned()),
            19 => Self::Forget,
            20 => Self::Restart,
            21 => Self::Zero(whisker),
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

    use super::{
        Command, REQUEST_BYTES, TaggedCommand, UnknownCommand, WhiskerId, summed, word_sum,
    };

    fn commands() -> impl Strategy<Value = Command> {
        let whisker = (0..16_u8, 0..16_u8).prop_map(|(side, number)| WhiskerId { side, number });
        (0..21_u8, whisker, any::<i32>()).prop_map(|(which, whisker, value)| {
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
                13 => Command::Constant(name),
                14 => Command::Stage(name, word.rotate_left(8)),
                15 => Command::Apply(word),
                16 => Command::Load(word),
                17 => Command::Word(name, word.rotate_left(8)),
                18 => Command::Restart,
                19 => Command::Zero(whisker),
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

    #[test]
    fn every_word_and_its_number_are_in_the_sum() {
        let words = [(6, 0x40E0_0000), (134, 1)];
        let sum = |words: &[(u8, u32)]| word_sum(words.iter().copied());
        // Worked out in Python: s = (s ^ x) * 0x01000193 & 0xFFFFFFFF for 6, 0x40E00000, 134, 1.
        assert_eq!(sum(&words), 0x96A5_35B2);
        for others in [
            &words[..1],
            &[],
            &[words[1], words[0]],
            &[(7, 0x40E0_0000), (134, 1)],
        ] {
            assert_ne!(sum(others), sum(&words), "{others:?}");
        }
    }

    /// See the test.
    const PYTHON: u32 = 0x3F2A_47C3;
}
