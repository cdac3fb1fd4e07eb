//! The control block.

use crate::program::{BadProgram, symbol};
use crate::ring::{RING, Ram, Ring, word};

/// What a control block begins with.
const NAME: &[u8; 16] = b"SEGGER RTT\0\0\0\0\0\0";

/// Offsets in it: how many rings go up and down, and the first ring.
const COUNTS: u32 = 16;
const RINGS: u32 = 24;

/// More rings than a program of a module has: numbers above it are none.
const MOST: u32 = 16;

/// The control block in RAM, as a probe finds it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rtt {
    block: u32,
}

impl Rtt {
    /// That of the program in the ELF file `elf`.
    ///
    /// # Errors
    /// [`BadProgram`] if it has none.
    pub fn of_program(elf: &[u8]) -> Result<Self, BadProgram> {
        let block = symbol(elf, "_SEGGER_RTT")?;
        Ok(Self { block })
    }

    /// The first in `bytes` of RAM, which begin at `at`. One that a former program has left
    /// behind looks the same.
    pub fn find(at: u32, bytes: &[u8]) -> Option<Self> {
        let mut words = (at..).zip(bytes.windows(NAME.len())).step_by(4);
        let (block, _) = words.find(|(_, found)| *found == NAME)?;
        Some(Self { block })
    }

    /// Whether it is there by now: a program writes it as it starts.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn is_there<R: Ram>(self, mut ram: R) -> Result<bool, R::Fault> {
        let mut name = [0; NAME.len()];
        ram.read(self.block, &mut name)?;
        Ok(name == *NAME)
    }

    /// The ring of the log.
    pub const fn log(self) -> Ring {
        Ring::at(self.block + RINGS)
    }

    /// That of packets, if the program has one.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn packets<R: Ram>(self, ram: R) -> Result<Option<Ring>, R::Fault> {
        let [ups, _] = self.counts(ram)?;
        Ok((ups > 1).then_some(Ring::at(self.block + RINGS + RING)))
    }

    /// That of requests, if the program has one.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn requests<R: Ram>(self, ram: R) -> Result<Option<Ring>, R::Fault> {
        let [ups, downs] = self.counts(ram)?;
        Ok((downs > 0).then_some(Ring::at(self.block + RINGS + RING * ups)))
    }

    /// How many rings go up and down; none before the block is there.
    fn counts<R: Ram>(self, mut ram: R) -> Result<[u32; 2], R::Fault> {
        let mut bytes = [0; 8];
        ram.read(self.block + COUNTS, &mut bytes)?;
        let counts = [word(&bytes, 0), word(&bytes, 4)];
        let is_block = counts.iter().all(|count| *count <= MOST);
        Ok(if is_block { counts } else { [0; 2] })
    }
}

#[cfg(test)]
mod tests {
    use super::{NAME, Rtt};

    #[test]
    fn a_block_is_found_at_a_word_by_its_whole_name() {
        let mut ram = vec![0xFF; 200];
        ram[6..22].copy_from_slice(NAME);
        ram[40..50].copy_from_slice(&NAME[..10]);
        assert_eq!(Rtt::find(0x2000_0000, &ram), None);
        ram[100..116].copy_from_slice(NAME);
        let found = Rtt::find(0x2000_0000, &ram);
        assert_eq!(found, Some(Rtt { block: 0x2000_0064 }));
    }
}
