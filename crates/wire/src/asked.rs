//! What a frame carries that asks for something, of the board that reads it or of another one of
//! its head.

use serde::Serialize;

use crate::frame::{Frame, frame, summed};
use crate::reader::take;
use crate::request::{Command, TaggedCommand, UnknownCommand};

/// Stands where a command's number does, before the board's number and the command.
pub(crate) const FOR_NODE: u8 = 255;

/// Most bytes of a command.
pub const COMMAND_MOST: usize = 10;

/// A request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// Of the board that reads it.
    Here(Result<TaggedCommand, UnknownCommand>),
    /// Of another board of its head.
    For(ForNode),
}

/// A request as it goes on to another board, which knows the command or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ForNode {
    /// The number of that board.
    pub node: u8,
    /// Chosen by whoever asks.
    pub tag: u16,
    /// The command by postcard; zeros follow.
    pub command: [u8; COMMAND_MOST],
}

impl Request {
    /// `None` if the frame's sum is not right: then no request was meant, and there is nothing to
    /// answer.
    pub fn read(content: &[u8]) -> Option<Self> {
        let (tag, rest) = take(summed(content)?)?;
        if let [FOR_NODE, node, command @ ..] = rest {
            return ForNode::of(tag, *node, command).map(Self::For);
        }
        let number = *rest.first()?;
        Some(Self::Here(match take(rest) {
            Some((command, [])) => Ok(TaggedCommand { tag, command }),
            _ => Err(UnknownCommand {
                tag,
                command: number,
            }),
        }))
    }

    /// Its tag.
    pub const fn tag(&self) -> u16 {
        match self {
            Self::Here(Ok(request)) => request.tag,
            Self::Here(Err(unknown)) => unknown.tag,
            Self::For(request) => request.tag,
        }
    }

    /// Whether it is a stop, of whatever board.
    pub fn is_stop(&self) -> bool {
        match self {
            Self::Here(request) => {
                request.is_ok_and(|request| matches!(request.command, Command::Stop))
            }
            Self::For(request) => request.number() == Command::Stop.number(),
        }
    }
}

impl ForNode {
    fn of(tag: u16, node: u8, bytes: &[u8]) -> Option<Self> {
        let mut command = [0; COMMAND_MOST];
        bytes.first()?;
        command.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(Self { node, tag, command })
    }

    /// The number of its command.
    pub const fn number(&self) -> u8 {
        let [number, ..] = self.command;
        number
    }

    /// For the board that it is for.
    ///
    /// # Errors
    /// [`UnknownCommand`]: that of a later version, or with parts that it has not.
    pub fn here(&self) -> Result<TaggedCommand, UnknownCommand> {
        let Self { tag, command, .. } = *self;
        match take(&command) {
            Some((command, rest)) if rest.iter().all(|byte| *byte == 0) => {
                Ok(TaggedCommand { tag, command })
            }
            _ => Err(UnknownCommand {
                tag,
                command: self.number(),
            }),
        }
    }
}

/// The frame of a request of board `node` of a head.
pub fn frame_for<C: Serialize>(node: u8, tag: u16, command: C) -> Frame {
    frame(&(tag, FOR_NODE, node, command))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{COMMAND_MOST, ForNode, Request, frame_for};
    use crate::frame::{FRAME_BYTES, frame};
    use crate::request::tests::commands;
    use crate::{Command, Piece, Splitter, TaggedCommand, UnknownCommand};

    fn read(frame: &[u8]) -> Option<Request> {
        let mut splitter = Splitter::<FRAME_BYTES>::new();
        frame.iter().find_map(|byte| match splitter.push(*byte)? {
            Piece::Frame(content) => Request::read(content),
            piece => panic!("{piece:?}"),
        })
    }

    proptest! {
        #[test]
        fn a_request_is_read_as_it_was_meant_and_sent_by_its_number(
            tag: u16,
            command in commands(),
        ) {
            let request = TaggedCommand { tag, command };
            let found = read(&frame(&request));
            let request = Ok(request);
            prop_assert_eq!(found, Some(Request::Here(request)));
            let later = Err(UnknownCommand { tag, command: command.number() });
            let alone = read(&frame(&(tag, command.number())));
            let expected = [later, request].map(|request| Some(Request::Here(request)));
            prop_assert!(expected.contains(&alone));
        }

        #[test]
        fn one_of_another_board_is_the_same_there(tag: u16, node: u8, command in commands()) {
            let Some(Request::For(request)) = read(&frame_for(node, tag, command)) else {
                panic!("{command:?}");
            };
            prop_assert_eq!((request.node, request.number()), (node, command.number()));
            prop_assert_eq!(request.here(), Ok(TaggedCommand { tag, command }));
        }

        #[test]
        fn any_bytes_are_read_without_harm(bytes in prop::collection::vec(any::<u8>(), 0..30)) {
            let _ = Request::read(&bytes);
        }

        #[test]
        fn any_command_of_another_board_is_one_or_unknown(command: [u8; COMMAND_MOST]) {
            let request = ForNode { node: 1, tag: 2, command };
            if let Err(unknown) = request.here() {
                prop_assert_eq!(unknown, UnknownCommand { tag: 2, command: command[0] });
            }
        }
    }

    #[test]
    fn a_command_of_a_later_version_is_known_by_its_tag() {
        let (tag, command) = (700, 24_u8);
        let later = Some(Request::Here(Err(UnknownCommand { tag, command })));
        assert_eq!(read(&frame(&(tag, command))), later);
        assert_eq!(
            read(&frame(&(tag, command, 7_u32))),
            later,
            "with more behind it"
        );
    }

    #[test]
    fn a_stop_is_one_whichever_board_it_names() {
        let (tag, command) = (3, Command::Stop);
        for frame in [
            frame(&TaggedCommand { tag, command }),
            frame_for(7, tag, command),
        ] {
            assert!(read(&frame).is_some_and(|request| request.is_stop()));
        }
        assert!(!read(&frame_for(7, 3, Command::Arm)).unwrap().is_stop());
    }
}
