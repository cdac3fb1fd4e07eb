//! Commands as text: one grammar for the serial line and for scripts.
//!
//! A line is words with spaces between them; a remark follows `#`. Numbers are decimal, such
//! as `-0.5`, without an exponent; what follows the sixth decimal is left out.

use crate::request::{Command, WhiskerId};

/// What can be said.
pub const ALLOWED: &str = "arm, stop, clear SIDE, home SIDE, gain SIDE VALUE (0 to 2), setpoint SIDE \
                           DEGREES, release SIDE, zero SIDE, frame SIDE, stream on|off, hello, status";

/// Numbers are at most this far from zero.
const FAR: u32 = 10_000;

/// A number: its sign, what is before the point, and millionths behind it. In words of 32
/// bits, as a core without a division of longer ones would link one for this alone.
#[derive(Debug, Clone, Copy)]
struct Number {
    is_negative: bool,
    whole: u32,
    millionths: u32,
}

/// What a line asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spoken {
    /// Nothing: it is empty, or a remark.
    Nothing,
    /// Something of the module.
    Command(Command),
    /// What can be said.
    Help,
}

/// Why a line is no command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{}", self.text())]
#[expect(missing_docs, reason = "the texts say it")]
pub enum NotSpoken {
    Unknown,
    Side,
    Number,
    Switch,
    More,
}

impl NotSpoken {
    /// It in words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Unknown => "unknown command, try help",
            Self::Side => "needs a side, left or right",
            Self::Number => "needs a number such as 0.5",
            Self::Switch => "needs on or off",
            Self::More => "has words too many",
        }
    }
}

/// What a line asks for.
///
/// # Errors
/// The word that the fault is about, the first of the line, and what is wrong.
pub fn parse(line: &[u8]) -> Result<Spoken, (&[u8], NotSpoken)> {
    let words = line.split(|byte| *byte == b'#').next().unwrap_or_default();
    let words = words.split(u8::is_ascii_whitespace);
    let mut words = words.filter(|word| !word.is_empty());
    let Some(first) = words.next() else {
        return Ok(Spoken::Nothing);
    };
    let spoken = spoken(first, &mut words);
    let spoken = spoken.and_then(|spoken| match words.next() {
        None => Ok(spoken),
        Some(_) => Err(NotSpoken::More),
    });
    spoken.map_err(|fault| (first, fault))
}

fn spoken<'l>(
    first: &[u8],
    words: &mut impl Iterator<Item = &'l [u8]>,
) -> Result<Spoken, NotSpoken> {
    let command = match first {
        b"help" => return Ok(Spoken::Help),
        b"hello" => Command::Hello,
        b"status" => Command::Status,
        b"arm" => Command::Arm,
        b"stop" => Command::Stop,
        b"clear" => Command::Clear(side(words)?),
        b"home" => Command::Home(side(words)?),
        b"release" => Command::Release(side(words)?),
        b"zero" => Command::Zero(side(words)?),
        b"frame" => Command::Frame(side(words)?),
        b"gain" => Command::Gain(side(words)?, number(words)?.q24()),
        // θ' = 100 θ + 50 degrees (BIOTACT section III).
        b"setpoint" => {
            let whisker = side(words)?;
            let hundredths = number(words)?.hundredth_q24();
            Command::Setpoint(whisker, hundredths - (1 << 23))
        }
        b"stream" => match words.next() {
            Some(b"on") => Command::Stream(true),
            Some(b"off") => Command::Stream(false),
            _ => return Err(NotSpoken::Switch),
        },
        _ => return Err(NotSpoken::Unknown),
    };
    Ok(Spoken::Command(command))
}

fn side<'l>(words: &mut impl Iterator<Item = &'l [u8]>) -> Result<WhiskerId, NotSpoken> {
    let side = match words.next() {
        Some(b"left") => 0,
        Some(b"right") => 1,
        _ => return Err(NotSpoken::Side),
    };
    Ok(WhiskerId { side, number: 0 })
}

fn number<'l>(words: &mut impl Iterator<Item = &'l [u8]>) -> Result<Number, NotSpoken> {
    words.next().and_then(Number::read).ok_or(NotSpoken::Number)
}

impl Number {
    fn read(word: &[u8]) -> Option<Self> {
        let (is_negative, digits) = match word {
            [b'-', digits @ ..] => (true, digits),
            [b'+', digits @ ..] | digits => (false, digits),
        };
        let (mut whole, mut millionths, mut has_digits) = (0_u32, 0, false);
        // What the next decimal is worth, once the point has come.
        let mut worth = None;
        for byte in digits {
            match (byte, worth) {
                (b'.', None) => worth = Some(100_000_u32),
                (b'0'..=b'9', _) => {
                    has_digits = true;
                    let digit = u32::from(byte - b'0');
                    match &mut worth {
                        None if whole > FAR => return None,
                        None => whole = 10 * whole + digit,
                        Some(worth) => {
                            millionths += digit * *worth;
                            *worth /= 10;
                        }
                    }
                }
                _ => return None,
            }
        }
        let is_near = whole < FAR || whole == FAR && millionths == 0;
        (has_digits && is_near).then_some(Self {
            is_negative,
            whole,
            millionths,
        })
    }

    const fn signed(self, magnitude: u32) -> i32 {
        let magnitude = magnitude.cast_signed();
        if self.is_negative {
            -magnitude
        } else {
            magnitude
        }
    }

    /// It in Q24, to the nearest; limited to what fits.
    const fn q24(self) -> i32 {
        if self.whole >= 1 << 7 {
            return if self.is_negative { i32::MIN } else { i32::MAX };
        }
        // 2^24/10^6 is 2^18/15625.
        let (many, rest) = (self.millionths / 15_625, self.millionths % 15_625);
        let part = (many << 18) + ((rest << 18) + 7_812) / 15_625;
        let whole = self.whole << 24;
        self.signed(if whole + part > i32::MAX as u32 {
            i32::MAX as u32
        } else {
            whole + part
        })
    }

    /// A hundredth of it in Q24, to the nearest but one.
    const fn hundredth_q24(self) -> i32 {
        // 2^24/100 is 2^22/25.
        let (many, rest) = (self.whole / 25, self.whole % 25);
        let whole = (many << 22) + ((rest << 22) + 12) / 25;
        // 2^24/10^8 is 2^16/390625, of which 2^13 first.
        let scaled = (self.millionths % 390_625) << 13;
        let (most, rest) = (scaled / 390_625, scaled % 390_625);
        let part = ((self.millionths / 390_625) << 16) + (most << 3);
        self.signed(whole + part + ((rest << 3) + 195_312) / 390_625)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{NotSpoken, Spoken, parse};
    use crate::{Command, WhiskerId};

    const LEFT: WhiskerId = WhiskerId { side: 0, number: 0 };
    const RIGHT: WhiskerId = WhiskerId { side: 1, number: 0 };

    fn command(line: &str) -> Command {
        match parse(line.as_bytes()) {
            Ok(Spoken::Command(command)) => command,
            other => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn every_command_has_its_words() {
        for (line, expected) in [
            ("hello", Command::Hello),
            ("status", Command::Status),
            ("arm", Command::Arm),
            (" stop ", Command::Stop),
            ("clear left", Command::Clear(LEFT)),
            ("home right", Command::Home(RIGHT)),
            ("release\tleft # a remark", Command::Release(LEFT)),
            ("zero right", Command::Zero(RIGHT)),
            ("frame right", Command::Frame(RIGHT)),
            ("gain left 0.5", Command::Gain(LEFT, 1 << 23)),
            ("gain left +.25", Command::Gain(LEFT, 1 << 22)),
            ("gain right -1.", Command::Gain(RIGHT, -(1 << 24))),
            ("setpoint right 75", Command::Setpoint(RIGHT, 1 << 22)),
            ("setpoint left 25", Command::Setpoint(LEFT, -(1 << 22))),
            ("stream on", Command::Stream(true)),
            ("stream off", Command::Stream(false)),
        ] {
            assert_eq!(command(line), expected, "{line}");
            assert_eq!(line.split_whitespace().next(), Some(expected.name()));
        }
        assert_eq!(parse(b"help"), Ok(Spoken::Help));
        for line in ["", "  ", "# arm", "\t#"] {
            assert_eq!(parse(line.as_bytes()), Ok(Spoken::Nothing), "{line:?}");
        }
    }

    #[test]
    fn a_refusal_says_why() {
        for (line, fault) in [
            ("jump", NotSpoken::Unknown),
            ("Stop", NotSpoken::Unknown),
            ("\u{e4}rm", NotSpoken::Unknown),
            ("clear", NotSpoken::Side),
            ("gain front 1", NotSpoken::Side),
            ("gain left", NotSpoken::Number),
            ("gain left much", NotSpoken::Number),
            ("gain left nan", NotSpoken::Number),
            ("gain left 1e3", NotSpoken::Number),
            ("gain left .", NotSpoken::Number),
            ("gain left 1.2.3", NotSpoken::Number),
            ("gain left --1", NotSpoken::Number),
            ("gain left 10000.000001", NotSpoken::Number),
            ("stream", NotSpoken::Switch),
            ("arm left", NotSpoken::More),
            ("gain left 1 2", NotSpoken::More),
            ("help me", NotSpoken::More),
        ] {
            let first = line.split_whitespace().next().expect("a word").as_bytes();
            assert_eq!(parse(line.as_bytes()), Err((first, fault)), "{line}");
        }
    }

    proptest! {
        #[test]
        fn numbers_are_what_std_reads(value in -9999.0..9999.0_f64, decimals in 0..9_usize) {
            let text = format!("{value:.decimals$}");
            let read: f64 = text.parse().expect("as written");
            let expected = (read * 16_777_216.0).clamp(i32::MIN.into(), i32::MAX.into());
            let Command::Gain(_, found) = command(&format!("gain left {text}")) else {
                panic!("no gain");
            };
            // Half a step, and what the decimals after the sixth are.
            let off = (f64::from(found) - expected).abs();
            let more = if decimals > 6 { 17.0 } else { 0.0 };
            prop_assert!(off <= 0.501 + more, "{text}: {found}");
            let Command::Setpoint(_, found) = command(&format!("setpoint left {text}")) else {
                panic!("no setpoint");
            };
            let expected = (read - 50.0) / 100.0 * 16_777_216.0;
            prop_assert!((f64::from(found) - expected).abs() <= 1.01 + more, "{text}: {found}");
        }

        #[test]
        fn any_line_is_read_without_harm(
            line in proptest::collection::vec(any::<u8>(), 0..60),
            words in proptest::collection::vec(
                proptest::sample::select(&["gain", "left", "-", "9999999999999999999", "0.5", "on",
                    "stream", "setpoint", "#", "help", ".", "-0.000000001"][..]),
                0..5,
            )
        ) {
            let _ = parse(&line);
            let _ = parse(words.join(" ").as_bytes());
        }
    }
}
