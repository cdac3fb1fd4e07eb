//! A serial line, byte by byte: lines of text, and frames between zeros.
//!
//! Text has no zero, and begins with no control character. A frame that is shorter than 32
//! bytes begins with a code below 32. So the byte after a zero tells which of both comes,
//! and a zero that was lost or added costs one piece, not the understanding.

use cobs::{DecodeResult, DecoderState};

/// Below this a byte after a zero begins a frame.
const FRAME_BELOW: u8 = 32;

/// What has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Piece<'b> {
    /// A line, without its end.
    Line(&'b [u8]),
    /// What was in a frame.
    Frame(&'b [u8]),
    /// Bytes that are neither.
    Garbled(Garbled),
}

/// What is neither a line nor a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Garbled {
    /// A line that was too long.
    Line,
    /// A frame that was too long, was cut short, or whose codes do not lead to its end.
    Frame,
}

#[derive(Debug)]
enum Within {
    /// Behind a zero.
    Nothing,
    Text,
    Frame(DecoderState),
    /// What is too long; up to the end of a line, or a zero.
    Long(Garbled),
}

/// Takes a serial line apart; no line and no frame of more than `N` bytes, which are fewer
/// than 32 in a frame.
#[derive(Debug)]
pub struct Splitter<const N: usize> {
    within: Within,
    bytes: [u8; N],
    length: usize,
}

impl<const N: usize> Splitter<N> {
    /// Before the first byte.
    pub const fn new() -> Self {
        Self {
            within: Within::Text,
            bytes: [0; N],
            length: 0,
        }
    }

    /// Takes the next byte; what is complete with it.
    pub fn push(&mut self, byte: u8) -> Option<Piece<'_>> {
        if byte == 0 {
            return self.zero();
        }
        if matches!(self.within, Within::Nothing) {
            self.length = 0;
            self.within = if byte < FRAME_BELOW {
                Within::Frame(DecoderState::Idle)
            } else {
                Within::Text
            };
        }
        match &mut self.within {
            Within::Frame(decoder) => {
                // A code is not kept; no zero comes this way.
                if let Ok(DecodeResult::DataContinue(found)) = decoder.feed(byte) {
                    self.keep(found, Garbled::Frame);
                }
            }
            Within::Long(_) if byte == b'\n' => {
                let Within::Long(what) = core::mem::replace(&mut self.within, Within::Text) else {
                    return None;
                };
                self.length = 0;
                return Some(Piece::Garbled(what));
            }
            Within::Text if byte == b'\n' => {
                let length = core::mem::take(&mut self.length);
                return Some(Piece::Line(self.bytes.get(..length).unwrap_or_default()));
            }
            Within::Text if byte != b'\r' => self.keep(byte, Garbled::Line),
            Within::Text | Within::Long(_) | Within::Nothing => {}
        }
        None
    }

    fn keep(&mut self, byte: u8, what: Garbled) {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        } else {
            self.within = Within::Long(what);
        }
    }

    /// A zero ends whatever there was.
    fn zero(&mut self) -> Option<Piece<'_>> {
        let length = core::mem::take(&mut self.length);
        let within = core::mem::replace(&mut self.within, Within::Nothing);
        if let Within::Frame(mut decoder) = within {
            let is_whole = matches!(decoder.feed(0), Ok(DecodeResult::DataComplete));
            let frame = self.bytes.get(..length).filter(|_| is_whole);
            return Some(frame.map_or(Piece::Garbled(Garbled::Frame), Piece::Frame));
        }
        if let Within::Long(what) = within {
            return Some(Piece::Garbled(what));
        }
        // A line that was cut short by what follows.
        let is_cut = matches!(within, Within::Text) && length > 0;
        is_cut.then_some(Piece::Garbled(Garbled::Line))
    }

    /// Nothing has come for longer than a frame takes: one that was begun is none, and what
    /// follows is text until a zero comes. Without that the empty line of a person who presses
    /// Enter behind a frame would begin another: its end is below 32.
    pub const fn pause(&mut self) {
        if matches!(self.within, Within::Frame(_) | Within::Nothing) {
            self.within = Within::Text;
            self.length = 0;
        }
    }
}

impl<const N: usize> Default for Splitter<N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Garbled, Piece, Splitter};
    use crate::{Frame, TaggedCommand, frame};

    fn pieces<const N: usize>(splitter: &mut Splitter<N>, bytes: &[u8]) -> Vec<(char, Vec<u8>)> {
        let mut found = Vec::new();
        for byte in bytes {
            found.extend(splitter.push(*byte).map(|piece| match piece {
                Piece::Line(line) => ('l', line.to_vec()),
                Piece::Frame(frame) => ('f', frame.to_vec()),
                Piece::Garbled(Garbled::Line) => ('L', Vec::new()),
                Piece::Garbled(Garbled::Frame) => ('F', Vec::new()),
            }));
        }
        found
    }

    fn content(frame: &Frame) -> Vec<u8> {
        let found = pieces(&mut Splitter::<30>::new(), frame);
        found.last().expect("a frame").1.clone()
    }

    const ARM: TaggedCommand = TaggedCommand {
        tag: 0x0100,
        command: crate::Command::Arm,
    };

    #[test]
    fn lines_and_frames_come_in_any_order() {
        let frame = frame(&ARM);
        let sent = [b"stop\r\n", &frame[..], b"arm\n", &frame].concat();
        let mut splitter = Splitter::<20>::new();
        let request = content(&frame);
        let expected = [
            ('l', b"stop".to_vec()),
            ('f', request.clone()),
            ('l', b"arm".to_vec()),
            ('f', request),
        ];
        assert_eq!(pieces(&mut splitter, &sent), expected);
    }

    #[test]
    fn after_a_frame_that_stops_in_the_middle_and_a_pause_a_line_is_understood() {
        let mut splitter = Splitter::<20>::new();
        assert!(pieces(&mut splitter, &frame(&ARM)[..5]).is_empty());
        splitter.pause();
        assert_eq!(pieces(&mut splitter, b"stop\n"), [('l', b"stop".to_vec())]);
    }

    #[test]
    fn behind_a_frame_a_line_may_be_empty_after_a_pause_and_not_before() {
        let mut splitter = Splitter::<20>::new();
        pieces(&mut splitter, &frame(&ARM));
        assert!(pieces(&mut splitter, b"\nstop\n").is_empty());
        pieces(&mut splitter, &frame(&ARM));
        splitter.pause();
        let expected = [('l', Vec::new()), ('l', b"stop".to_vec())];
        assert_eq!(pieces(&mut splitter, b"\nstop\n"), expected);
    }

    #[test]
    fn what_is_too_long_is_reported_once() {
        let mut splitter = Splitter::<4>::new();
        let found = pieces(&mut splitter, b"status\narm\n");
        assert_eq!(found, [('L', Vec::new()), ('l', b"arm".to_vec())]);
        let found = pieces(&mut splitter, &frame(&ARM));
        assert_eq!(found, [('F', Vec::new())]);
        let found = pieces(&mut splitter, b"ar\0m\0\x05ab\0");
        let expected = [('L', Vec::new()), ('L', Vec::new()), ('F', Vec::new())];
        assert_eq!(found, expected);
    }

    proptest! {
        #[test]
        fn whatever_came_before_a_pause_the_second_request_is_understood(
            noise in proptest::collection::vec(any::<u8>(), 0..80),
            tag: u16,
        ) {
            let mut splitter = Splitter::<20>::new();
            pieces(&mut splitter, &noise);
            splitter.pause();
            pieces(&mut splitter, &frame(&ARM));
            let request = TaggedCommand { tag, ..ARM };
            let found = pieces(&mut splitter, &frame(&request));
            prop_assert_eq!(found, [('f', content(&frame(&request)))]);
        }

        #[test]
        fn whatever_came_before_a_line_behind_a_zero_is_understood(
            noise in proptest::collection::vec(any::<u8>(), 0..80),
        ) {
            let mut splitter = Splitter::<20>::new();
            pieces(&mut splitter, &noise);
            let found = pieces(&mut splitter, b"\0hello\n");
            prop_assert_eq!(found.last(), Some(&('l', b"hello".to_vec())));
        }
    }
}
