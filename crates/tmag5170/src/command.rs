//! What the master sends: a register to read or to write, and a command bit.
//!
//! | bits | 31 | 30..24 | 23..8 | 7..6 | 5 | 4 | 3..0 |
//! |---|---|---|---|---|---|---|---|
//! | | 1 to read | address | what to write | 0 | CMD1 | CMD0 | CRC |
//!
//! Sources: the data sheet (SBASAF4, 7.5.2), TI's example code, Zephyr's driver; for CMD1
//! TI's reference design TIDUF78 and birkler's component.

use crate::crc::{self, crc4};
use crate::{FRAME_LEN, Register};

/// What a frame does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Access {
    /// Reads a register; the reply has it in the same frame.
    Read(Register),
    /// Writes a register, unless the sensor finds a wrong bit.
    Write(Register, u16),
}

/// A frame from the master.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Command {
    /// Which register, and whether to write it.
    pub access: Access,
    /// CMD0: starts a conversion, where the trigger mode is
    /// [`Trigger::Command`](crate::Trigger::Command) and the operating mode waits for one.
    pub convert: bool,
}

/// Where the bits are in the first and in the last byte.
const READ: u8 = 0x80;
const ADDRESS: u8 = 0x7F;
const CONVERT: u8 = 0x10;

impl Command {
    /// Reads a register, and starts no conversion.
    pub const fn read(register: Register) -> Command {
        Command {
            access: Access::Read(register),
            convert: false,
        }
    }

    /// Writes a register, and starts no conversion.
    pub const fn write(register: Register, value: u16) -> Command {
        Command {
            access: Access::Write(register, value),
            ..Command::read(register)
        }
    }

    /// The frame, check bits included.
    pub const fn bytes(self) -> [u8; FRAME_LEN] {
        let (first, value) = match self.access {
            Access::Read(register) => (READ | register.address(), 0),
            Access::Write(register, value) => (register.address(), value),
        };
        let [high, low] = value.to_be_bytes();
        let convert = if self.convert { CONVERT } else { 0 };
        crc::sealed([first, high, low, convert])
    }

    /// What a frame from a master asks for, as the sensor takes it. What is to be written in
    /// a frame that reads does not count, nor does CMD1: with it the lowest bits of the status
    /// are the type of the reply.
    ///
    /// # Errors
    /// The first [`CommandError`] that applies, in the order they are listed.
    pub fn decode(bytes: &[u8; FRAME_LEN]) -> Result<Command, CommandError> {
        if crc4(bytes) != crc::found(*bytes) {
            return Err(CommandError::BadCrc);
        }
        let [first, high, low, last] = *bytes;
        let address = first & ADDRESS;
        let register = Register::at(address).ok_or(CommandError::NoRegister(address))?;
        let access = if first & READ == 0 {
            Access::Write(register, u16::from_be_bytes([high, low]))
        } else {
            Access::Read(register)
        };
        Ok(Command {
            access,
            convert: last & CONVERT != 0,
        })
    }
}

/// Why a frame from a master asks for nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CommandError {
    /// Its check bits are wrong.
    BadCrc,
    /// No register is documented at this address.
    NoRegister(u8),
}
