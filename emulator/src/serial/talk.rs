//! A conversation with a board over its serial line.

use host_sim::Error;
use wire::{Answer, Command, Framed, Packet, TaggedCommand, TickRecord};

use crate::compare::Pair;
use crate::ear::{self, Ear, Heard};

/// What is not as it should be.
pub(super) fn wrong<T>(what: impl Into<String>) -> Result<T, Error> {
    Err(Error::Work(what.into()))
}

/// The board and the PC, and what the board has sent.
pub(super) struct Talk {
    pub(super) pair: Pair,
    pub(super) ear: Ear,
    /// Ticks of the board.
    pub(super) ticks: u32,
    /// Ticks of a part.
    pub(super) part: u32,
    pub(super) tag: u16,
}

impl Talk {
    /// Lets so many ticks pass on the board alone.
    pub(super) fn pass(&mut self, ticks: u32) -> Result<Vec<Heard>, Error> {
        let mut all = Vec::new();
        for _ in 0..ticks {
            self.pair.target.tick();
            self.ticks += 1;
            let emulated = self.pair.target.module_mut();
            emulated.check()?;
            let bytes = emulated.board.serial_read();
            all.extend(self.ear.hear(&bytes)?);
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
        let heard = self.pass(self.part)?;
        Ok(ear::replies(&heard))
    }

    /// Asks by a frame; the answer, and the records that came meanwhile.
    pub(super) fn ask(&mut self, command: Command) -> Result<(Answer, Vec<TickRecord>), Error> {
        self.tag += 1;
        let tag = self.tag;
        let request = TaggedCommand { tag, command };
        self.write(Framed::request(&request).bytes());
        let heard = self.pass(self.part)?;
        let records = ear::records(&heard);
        let mut answers = heard.iter().filter_map(|heard| match heard {
            Heard::Packet(Packet::Answer(answer)) if answer.tag == tag => Some(*answer),
            _ => None,
        });
        match (answers.next(), answers.next()) {
            (Some(answer), None) => Ok((answer, records)),
            (found, _) => wrong(format!("{command:?}: answered {found:?}, or twice")),
        }
    }
}
