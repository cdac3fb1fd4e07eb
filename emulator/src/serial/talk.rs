//! A conversation with a board over its serial line.

use firmware::Packet;
use host_sim::Error;
use host_sim::received::Received;
use wire::{Answer, Command, TaggedCommand};

use crate::board::packets;
use crate::compare::Pair;

/// What is not as it should be.
pub(super) fn wrong<T>(what: impl Into<String>) -> Result<T, Error> {
    Err(Error::Work(what.into()))
}

/// The board and the PC, and what the board has sent.
pub(super) struct Talk {
    pub(super) pair: Pair,
    /// Ticks of the board.
    pub(super) ticks: u32,
    /// Ticks of a part.
    pub(super) part: u32,
    pub(super) tag: u16,
}

impl Talk {
    /// Lets so many ticks pass on the board alone.
    pub(super) fn pass(&mut self, ticks: u32) -> Result<Vec<Received>, Error> {
        let mut all = Vec::new();
        for _ in 0..ticks {
            self.pair.target.tick();
            self.ticks += 1;
            let emulated = self.pair.target.module_mut();
            emulated.check()?;
            all.extend(emulated.board.received()?);
        }
        Ok(all)
    }

    pub(super) fn write(&mut self, bytes: &[u8]) {
        self.pair.target.module_mut().board.serial_write(bytes);
    }

    /// Says a line; the lines that are no tick's.
    pub(super) fn say(&mut self, line: &str) -> Result<Vec<String>, Error> {
        self.write(line.as_bytes());
        self.write(b"\n");
        Ok(replies(&self.pass(self.part)?))
    }

    /// Asks by a frame; the answer, and the other packets that came meanwhile.
    pub(super) fn ask(&mut self, command: Command) -> Result<(Answer, Vec<Packet>), Error> {
        self.tag += 1;
        let tag = self.tag;
        self.write(&wire::frame(&TaggedCommand { tag, command }));
        let (mut answers, mut others) = (Vec::new(), Vec::new());
        for packet in packets(&self.pass(self.part)?) {
            match packet {
                Packet::Answer(answer) if answer.tag == tag => answers.push(answer),
                _ => others.push(packet),
            }
        }
        match answers[..] {
            [answer] => Ok((answer, others)),
            _ => wrong(format!("{command:?}: answered {answers:?}")),
        }
    }
}

/// The lines that begin with no time: replies.
pub(super) fn replies(received: &[Received]) -> Vec<String> {
    let lines = received.iter().filter_map(|received| match received {
        Received::Line(line) => Some(line.clone()),
        Received::Packet(_) | Received::Garbled => None,
    });
    lines
        .filter(|line| !line.starts_with(|first: char| first.is_ascii_digit()))
        .collect()
}
