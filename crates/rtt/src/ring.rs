//! A ring, and the RAM that it lies in.

/// Memory that is read and written from outside, while the program runs.
pub trait Ram {
    /// Why it cannot be read or written.
    type Fault;

    /// Reads from an address on.
    ///
    /// # Errors
    /// If it cannot be read.
    fn read(&mut self, at: u32, into: &mut [u8]) -> Result<(), Self::Fault>;

    /// Writes from an address on.
    ///
    /// # Errors
    /// If it cannot be written.
    fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Self::Fault>;
}

impl<R: Ram> Ram for &mut R {
    type Fault = R::Fault;

    fn read(&mut self, at: u32, into: &mut [u8]) -> Result<(), R::Fault> {
        R::read(self, at, into)
    }

    fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), R::Fault> {
        R::write(self, at, bytes)
    }
}

/// Bytes of a ring's description.
pub(crate) const RING: u32 = 24;

/// Offsets in it: the buffer, its length, the offsets of writer and reader, and what is done
/// where there is no room.
const BUFFER: u32 = 4;
const LENGTH: u32 = 8;
const WRITER: u32 = 12;
const READER: u32 = 16;
const MODE: u32 = 20;

/// The mode of a channel whose writer waits for room, which a probe sets as it attaches.
const BLOCK_IF_FULL: u32 = 2;

/// Longer than any ring of a module: before a program has set it up, a ring is what was in RAM.
const LONGEST: u32 = 1 << 16;

pub(crate) fn word(bytes: &[u8], at: u32) -> u32 {
    let found = bytes.get(at as usize..).and_then(<[u8]>::first_chunk);
    found.copied().map_or(0, u32::from_le_bytes)
}

/// A ring in RAM.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ring {
    at: u32,
}

#[derive(Debug, Clone, Copy)]
struct Described {
    buffer: u32,
    length: u32,
    writer: u32,
    reader: u32,
}

impl Described {
    /// A ring that is full to the last byte would look empty.
    const fn room(&self) -> usize {
        ((self.reader + self.length - self.writer - 1) % self.length) as usize
    }
}

impl Ring {
    pub(crate) const fn at(at: u32) -> Self {
        Self { at }
    }

    /// Where the writer stands; changes with every line.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn writer<R: Ram>(self, mut ram: R) -> Result<u32, R::Fault> {
        let mut bytes = [0; 4];
        ram.read(self.at + WRITER, &mut bytes)?;
        Ok(word(&bytes, 0))
    }

    /// Asks the program to wait where the ring is full, as probe-rs does.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn ask_to_wait<R: Ram>(self, mut ram: R) -> Result<(), R::Fault> {
        ram.write(self.at + MODE, &BLOCK_IF_FULL.to_le_bytes())
    }

    /// Leaves no room, as if the probe had fetched nothing for long.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn fill<R: Ram>(self, mut ram: R) -> Result<(), R::Fault> {
        let Some(Described { length, writer, .. }) = self.described(&mut ram)? else {
            return Ok(());
        };
        let reader = if writer + 1 < length { writer + 1 } else { 0 };
        ram.write(self.at + READER, &reader.to_le_bytes())
    }

    /// Fetches what has been written.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn drain<R: Ram>(self, mut ram: R) -> Result<Vec<u8>, R::Fault> {
        let mut bytes = Vec::new();
        let Some(described) = self.described(&mut ram)? else {
            return Ok(bytes);
        };
        let Described {
            buffer,
            length,
            writer,
            mut reader,
        } = described;
        if reader == writer {
            return Ok(bytes);
        }
        while reader != writer {
            let end = if writer > reader { writer } else { length };
            let start = bytes.len();
            bytes.resize(start + (end - reader) as usize, 0);
            ram.read(buffer + reader, &mut bytes[start..])?;
            reader = if end == length { 0 } else { end };
        }
        ram.write(self.at + READER, &reader.to_le_bytes())?;
        Ok(bytes)
    }

    /// How many bytes there is room for.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn room<R: Ram>(self, mut ram: R) -> Result<usize, R::Fault> {
        let described = self.described(&mut ram)?;
        Ok(described.map_or(0, |described| described.room()))
    }

    /// Writes what a PC sends, as far as there is room; how many bytes there was room for.
    ///
    /// # Errors
    /// Any of `ram`.
    pub fn send<R: Ram>(self, mut ram: R, bytes: &[u8]) -> Result<usize, R::Fault> {
        let Some(described) = self.described(&mut ram)? else {
            return Ok(0);
        };
        let Described {
            buffer,
            length,
            writer,
            ..
        } = described;
        let sent = bytes.len().min(described.room());
        // As each write takes a probe a while: up to the end of the ring, and from its start.
        let to_end = sent.min((length - writer) as usize);
        let (first, rest) = bytes[..sent].split_at(to_end);
        for (at, piece) in [(buffer + writer, first), (buffer, rest)] {
            if !piece.is_empty() {
                ram.write(at, piece)?;
            }
        }
        let writer = (writer + sent as u32) % length;
        ram.write(self.at + WRITER, &writer.to_le_bytes())?;
        Ok(sent)
    }

    /// Its description, in one read, as each takes a probe a while; nothing before the program
    /// has set it up.
    fn described<R: Ram>(self, ram: &mut R) -> Result<Option<Described>, R::Fault> {
        let mut bytes = [0; RING as usize];
        ram.read(self.at, &mut bytes)?;
        let described = Described {
            buffer: word(&bytes, BUFFER),
            length: word(&bytes, LENGTH),
            writer: word(&bytes, WRITER),
            reader: word(&bytes, READER),
        };
        let Described { length, .. } = described;
        let is_set_up = length <= LONGEST && described.writer < length && described.reader < length;
        Ok(is_set_up.then_some(described))
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::{Ram, Ring};

    /// A ring of eight bytes at 24, in RAM that begins at 0.
    struct Memory([u8; 32]);

    impl Ram for Memory {
        type Fault = Infallible;

        fn read(&mut self, at: u32, into: &mut [u8]) -> Result<(), Infallible> {
            let at = at as usize;
            into.copy_from_slice(&self.0[at..at + into.len()]);
            Ok(())
        }

        fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Infallible> {
            let at = at as usize;
            self.0[at..at + bytes.len()].copy_from_slice(bytes);
            Ok(())
        }
    }

    fn memory() -> Memory {
        let mut memory = Memory([0; 32]);
        memory.0[4] = 24;
        memory.0[8] = 8;
        memory
    }

    const RING: Ring = Ring::at(0);

    #[test]
    fn what_is_sent_is_fetched_whole_and_in_order_round_the_end() {
        let mut memory = memory();
        for n in 0..20_u8 {
            let bytes = [n, n + 100, n + 101, n + 102, n + 103];
            let Ok(sent) = RING.send(&mut memory, &bytes);
            assert_eq!(sent, 5);
            let Ok(fetched) = RING.drain(&mut memory);
            assert_eq!(fetched, bytes);
        }
    }

    #[test]
    fn one_byte_fewer_fits_than_there_is_memory() {
        let mut memory = memory();
        let Ok(sent) = RING.send(&mut memory, &[1; 9]);
        assert_eq!(sent, 7);
        let Ok(fetched) = RING.drain(&mut memory);
        assert_eq!(fetched, [1; 7]);
        let Ok(()) = RING.fill(&mut memory);
        let Ok(sent) = RING.send(&mut memory, &[1]);
        assert_eq!(sent, 0);
    }

    #[test]
    fn what_is_no_ring_yet_is_left_alone() {
        let mut memory = Memory([0xA5; 32]);
        let before = memory.0;
        let Ok(fetched) = RING.drain(&mut memory);
        let Ok(sent) = RING.send(&mut memory, &[1]);
        assert_eq!((fetched.len(), sent), (0, 0));
        assert_eq!(memory.0, before);
    }
}
