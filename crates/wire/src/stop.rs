//! Looks for a stop among the bytes of a link, as they arrive.
//!
//! A stop is seen with its last byte, whatever waits before it. It is a frame with that request,
//! or a line that says it, as [`text`](crate::text) reads it. In doubt a stop is one: a line that
//! is too long, or has bytes that are no text, is no command; where it ends with `stop`, that
//! is what somebody said behind what was not understood.

use heapless::Vec;

use crate::asked::FOR_NODE;
use crate::frame::summed;
use crate::reader::take;
use crate::request::Command;

/// Most bytes of a line that is a command.
pub const COMMAND_BYTES: usize = 80;

/// Least and most bytes of a stop between the zeros of its frame: a code, the tag, the command and
/// the sum; of one that names a board of a head, and stops them all, two bytes before the command.
const LEAST: usize = 7;
const MOST: usize = 11;

/// How a stop has come, and so how it is answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// As a line.
    Line,
    /// In a frame, with this tag.
    Frame(u16),
}

/// What the line says up to the last byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Said {
    Nothing,
    S,
    St,
    Sto,
    Stop,
    StopBlank,
    StopRemark,
    OtherRemark,
    Other,
}

/// Looks at every byte of a link.
#[derive(Debug)]
pub struct StopWatch {
    said: Said,
    /// What its end says by itself, which counts alone of one that is garbled.
    end: Said,
    /// The line has more bytes than a command, or such as are no text.
    is_garbled: bool,
    line_length: u8,
    /// The bytes since the last zero, and how many came.
    frame: [u8; MOST],
    length: u8,
}

impl StopWatch {
    /// Before the first byte.
    pub const fn new() -> Self {
        Self {
            said: Said::Nothing,
            end: Said::Nothing,
            is_garbled: false,
            line_length: 0,
            frame: [0; MOST],
            length: 0,
        }
    }

    /// Takes the next byte; the stop that is complete with it.
    #[inline]
    pub fn push(&mut self, byte: u8) -> Option<Stop> {
        if byte == 0 {
            return self.zero();
        }
        if let Some(place) = self.frame.get_mut(usize::from(self.length)) {
            *place = byte;
        }
        self.length = self.length.saturating_add(1);
        if byte == b'\n' {
            return self.end_of_line();
        }
        self.line_length = self.line_length.saturating_add(1);
        self.said = self.said.and(byte, false);
        self.end = self.end.and(byte, true);
        let is_text = matches!(byte, b' '..=b'~' | b'\t' | b'\r' | 12);
        let is_remark = matches!(self.said, Said::OtherRemark | Said::StopRemark);
        if !(is_text || is_remark) || usize::from(self.line_length) > COMMAND_BYTES {
            self.is_garbled = true;
        }
        None
    }

    fn end_of_line(&mut self) -> Option<Stop> {
        let said = if self.is_garbled { self.end } else { self.said };
        let is_stop = matches!(said, Said::Stop | Said::StopBlank | Said::StopRemark);
        self.begin_line();
        is_stop.then_some(Stop::Line)
    }

    const fn begin_line(&mut self) {
        self.said = Said::Nothing;
        self.end = Said::Nothing;
        self.is_garbled = false;
        self.line_length = 0;
    }

    /// A zero ends a frame, and cuts a line short.
    fn zero(&mut self) -> Option<Stop> {
        self.begin_line();
        let length = usize::from(core::mem::take(&mut self.length));
        if !(LEAST..=MOST).contains(&length) {
            return None;
        }
        tag_of_stop(self.frame.get(..length)?).map(Stop::Frame)
    }
}

impl Default for StopWatch {
    fn default() -> Self {
        Self::new()
    }
}

impl Said {
    /// With one more byte, which does not end the line; of the whole line, or of an end that may
    /// begin anywhere.
    #[inline]
    const fn and(self, byte: u8, is_end: bool) -> Self {
        match (self, byte) {
            // The splitter leaves a CR out.
            (_, b'\r') | (Self::StopRemark, _) => self,
            (Self::OtherRemark, _) if !is_end => self,
            (Self::Nothing, b' ' | b'\t' | 12) => Self::Nothing,
            (Self::Nothing, b's') => Self::S,
            (Self::S, b't') => Self::St,
            (Self::St, b'o') => Self::Sto,
            (Self::Sto, b'p') => Self::Stop,
            (Self::Stop | Self::StopBlank, b' ' | b'\t' | 12) => Self::StopBlank,
            (Self::Stop | Self::StopBlank, b'#') => Self::StopRemark,
            (_, b's') if is_end => Self::S,
            (_, b'#') if !is_end => Self::OtherRemark,
            _ => Self::Other,
        }
    }
}

// Apart, as it is rare.
#[cold]
#[inline(never)]
fn tag_of_stop(coded: &[u8]) -> Option<u16> {
    let mut content = Vec::<u8, MOST>::new();
    // Bytes up to the next code.
    let mut left = 0;
    for &byte in coded {
        if left > 0 {
            content.push(byte).ok()?;
        } else {
            // A code stands for the zero before it, but the first one.
            content.push(0).ok()?;
            left = byte;
        }
        left -= 1;
    }
    let content = content.get(1..).filter(|_| left == 0)?;
    let (value, _) = content.split_last_chunk::<4>()?;
    let (tag, rest) = take(value)?;
    let ([command] | [FOR_NODE, _, command]) = rest else {
        return None;
    };
    // A sum takes time, which is for stops alone.
    if *command != Command::Stop.number() {
        return None;
    }
    summed(content).and(Some(tag))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{COMMAND_BYTES, Stop, StopWatch};
    use crate::request::tests::commands;
    use crate::text::{self, Spoken};
    use crate::{Command, Piece, Request, Splitter, TaggedCommand, frame, frame_for};

    /// The stops among some bytes, and how many bytes had come with each.
    fn stops(bytes: &[u8]) -> Vec<(usize, Stop)> {
        let mut watch = StopWatch::new();
        let pushed = bytes.iter().map(|byte| watch.push(*byte));
        (1..)
            .zip(pushed)
            .filter_map(|(n, stop)| Some((n, stop?)))
            .collect()
    }

    /// The stops that a board reads, where nothing comes for a while after these bytes.
    fn read(bytes: &[u8], pauses: &[usize]) -> Vec<(usize, Stop)> {
        let mut splitter = Splitter::<COMMAND_BYTES>::new();
        let mut found = Vec::new();
        for (n, byte) in (1..).zip(bytes) {
            if pauses.contains(&(n - 1)) {
                splitter.pause();
            }
            let stop = match splitter.push(*byte) {
                Some(Piece::Line(line)) => match text::parse(line) {
                    Ok(Spoken::Command(Command::Stop)) => Some(Stop::Line),
                    _ => None,
                },
                Some(Piece::Frame(content)) => {
                    let stop = Request::read(content).filter(Request::is_stop);
                    stop.map(|stop| Stop::Frame(stop.tag()))
                }
                _ => None,
            };
            found.extend(stop.map(|stop| (n, stop)));
        }
        found
    }

    #[test]
    fn a_line_that_says_stop_is_one() {
        for line in [
            "stop\n",
            "stop\r\n",
            "  stop \t\n",
            "stop#now\n",
            "stop # → now\n",
            "st\rop\n",
        ] {
            let all = line.len();
            assert_eq!(stops(line.as_bytes()), [(all, Stop::Line)], "{line:?}");
            assert_eq!(read(line.as_bytes(), &[]), [(all, Stop::Line)], "{line:?}");
        }
    }

    #[test]
    fn another_line_is_none_whatever_it_has_in_it() {
        for line in [
            "stop",
            "nonstop\n",
            "stopp\n",
            "stop left\n",
            "do stop\n",
            "sstop\n",
            "# stop\n",
            "gain left 1 # → stop\n",
            "gain left 1#stop\n",
            "st\0op\n",
            "st\nop\n",
            "STOP\n",
        ] {
            assert_eq!(stops(line.as_bytes()), [], "{line:?}");
        }
    }

    /// Nobody waits for the end of garbage before they stop a motor.
    #[test]
    fn behind_garbage_it_is_one_without_a_line_of_its_own() {
        let long = vec![b'a'; COMMAND_BYTES + 1];
        for before in [&b"\xA5"[..], b"\x80\x01 #", b"\0\x05ab", &long] {
            let bytes = [before, b"stop\n"].concat();
            assert_eq!(stops(&bytes), [(bytes.len(), Stop::Line)], "{before:?}");
        }
        // However much of it was within the length of a command.
        for before in COMMAND_BYTES - 4..COMMAND_BYTES + 4 {
            let bytes = [&vec![b'a'; before][..], b"stop\n"].concat();
            let is_too_long = bytes.len() > COMMAND_BYTES + 1;
            assert_eq!(stops(&bytes).len(), usize::from(is_too_long), "{before}");
        }
    }

    fn asked(tag: u16, command: Command) -> Vec<u8> {
        frame(&TaggedCommand { tag, command }).to_vec()
    }

    fn pieces() -> impl Strategy<Value = Vec<u8>> {
        let words = &[
            "stop", "stop", "st", "op", "gain", "arm", "#", " ", "\r", "\n", "\n", "\n", "\0",
            "\t", "\x0C", "s", "→",
        ][..];
        prop_oneof![
            6 => prop::sample::select(words).prop_map(|word| word.as_bytes().to_vec()),
            1 => any::<u16>().prop_map(|tag| asked(tag, Command::Stop)),
            1 => any::<(u16, u8)>()
                .prop_map(|(tag, to)| frame_for(to, tag, Command::Stop).to_vec()),
            2 => (any::<u16>(), commands()).prop_map(|(tag, command)| asked(tag, command)),
            1 => prop::collection::vec(any::<u8>(), 0..100),
            1 => (0..120_usize).prop_map(|count| vec![b'x'; count]),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]

        #[test]
        fn whatever_a_board_reads_as_a_stop_is_seen_with_the_same_byte(
            pieces in prop::collection::vec(pieces(), 0..40),
            pauses in prop::collection::vec(0..300_usize, 0..6),
        ) {
            let bytes = pieces.concat();
            let seen = stops(&bytes);
            for stop in read(&bytes, &pauses) {
                prop_assert!(seen.contains(&stop), "{stop:?} of {bytes:?}");
            }
        }

        #[test]
        fn a_frame_is_one_by_its_sum_alone(tag: u16, bit in 0..120_usize) {
            let mut bytes = asked(tag, Command::Stop);
            let all = bytes.len();
            prop_assert_eq!(stops(&bytes), [(all, Stop::Frame(tag))]);
            bytes[bit / 8 % all] ^= 1 << (bit % 8);
            let found = stops(&bytes);
            prop_assert!(!found.contains(&(all, Stop::Frame(tag))) || bit / 8 % all == 0);
        }

        #[test]
        fn commands_are_no_stop(lines in prop::collection::vec(
            prop::sample::select(&["gain left 0.5", "arm", "status", "setpoint right 70",
                "stream on", "help", "stop it", "nonstop", "# stop"][..]), 0..20,
        )) {
            let bytes = lines.join("\r\n") + "\n";
            prop_assert_eq!(stops(bytes.as_bytes()), []);
        }
    }
}
