//! A mock SPI bus with a TMAG5170 on it that speaks the wire format.
//!
//! Glossary:
//!
//! - *slave*: the sensor on the bus ([`TmagSlave`]), with its registers;
//! - *conversion*: at the falling edge of /CS a sensor that measures takes the field of that
//!   moment, if it is a new one; a frame never mixes two of them;
//! - *report*: the status registers, from what stands ([`TmagSlave::set_report`]) and what
//!   happened since they were read;
//! - *line fault*: what happens to frames on their way ([`LineFault`]);
//! - *magnet*: what a whisker's base turns above the sensor ([`BelowMagnet`]).
//!
//! As the part does, the slave checks the CRC of every command, obeys none that is wrong or
//! has not 32 clocks, and inverts the last bit of its reply to a wrong one. The one difference
//! on the wire: it judges the whole command before it sends that bit, where the part has not
//! seen the last bit yet. No time passes here. It has no pairs, thresholds, temperature or
//! conversions on command, for which no board asks.

mod below_magnet;

use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use tmag5170::{
    Access, Average, Channels, Command, FRAME_LEN, Field, OperatingMode, Range, Register, Status,
    StatusFaults, Version, crc4, encode,
};

use physics::Noise;

use super::wire::{self, Injected, RELEASED, SimSpiError, Traffic};
pub use below_magnet::BelowMagnet;

/// What happens to frames on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LineFault {
    /// The sensor takes no command and does not answer, on a line with a pull-up: all bytes
    /// 0xFF. A cut wire, a lost /CS and a sensor without supply look alike.
    Silent,
    /// SDO is held low: all bytes 0x00. Commands arrive.
    SdoLow,
    /// SDI is held low: commands arrive as zeros.
    SdiLow,
    /// The bus controller reports an error; nothing is sent or read.
    Bus,
    /// One bit of the reply arrives inverted: 0 is the first on the wire, 31 the last. Others
    /// change nothing.
    FlipReply(u8),
    /// One bit of the command arrives inverted, counted alike.
    FlipCommand(u8),
    /// The clocks of the last byte do not reach the sensor.
    ShortFrame,
    /// The sensor converts no more: its results stay those of the start of the fault.
    Frozen,
    /// No magnet is near: the sensor converts its noise.
    NoField,
    /// The magnet is too near: its field is four times what it is otherwise.
    NearField,
}

/// Noise of an average of 32 conversions, root mean square, mT: what the data sheet has for it, as
/// quoted in TI's forum (thread 996995), where 0.020 mT were measured. That it is white, and the
/// same along all axes, are choices.
const NOISE_OF_32_MT: f64 = 0.025;

const AXES: [Register; 3] = [Register::X, Register::Y, Register::Z];

/// A sensor, and the wire to it: an [`SpiDevice`].
///
/// A new one has just been powered up, in a field of zero and without fault.
#[derive(Debug, Clone)]
pub struct TmagSlave {
    registers: [u16; Register::ALL.len()],
    version: Version,
    field_mt: [f64; 3],
    /// Field or settings are new since the last conversion.
    due: bool,
    sets: u16,
    standing: StatusFaults,
    happened: StatusFaults,
    refused: bool,
    noise: Option<Noise>,
    injected: Injected<LineFault>,
    traffic: Traffic,
}

impl TmagSlave {
    /// A part of this version, just powered up.
    pub fn new(version: Version) -> Self {
        let mut slave = Self {
            registers: [0; Register::ALL.len()],
            version,
            field_mt: [0.0; 3],
            due: true,
            sets: 0,
            standing: StatusFaults::NONE,
            happened: StatusFaults::NONE,
            refused: false,
            noise: None,
            injected: Injected::NONE,
            traffic: Traffic::default(),
        };
        slave.restart();
        slave
    }

    /// The same with the noise that each conversion has: without any, readings of a field that
    /// stays are the same to the bit.
    pub fn with_noise(self, seed: u64) -> Self {
        let noise = Some(Noise::new(seed));
        Self { noise, ..self }
    }

    /// A supply that breaks down and comes back: settings and results are gone.
    pub fn restart(&mut self) {
        self.registers = Register::ALL.map(Register::after_reset);
        *self.at(Register::TestConfig) |= self.version.bits();
        self.happened = StatusFaults::RESTARTED;
        self.due = true;
        self.sets = 0;
        self.refused = false;
    }

    /// The field along X, Y and Z, mT; NaN reads as 0.
    pub const fn set_field(&mut self, field_mt: [f64; 3]) {
        self.field_mt = field_mt;
        self.due = true;
    }

    /// What the sensor reports about itself from now on.
    pub const fn set_report(&mut self, faults: StatusFaults) {
        self.standing = faults;
    }

    /// A line fault in every frame from now on; `None` mends it. It takes precedence over
    /// [`TmagSlave::inject`].
    pub const fn set_fault(&mut self, fault: Option<LineFault>) {
        self.injected.standing = fault;
    }

    /// A line fault in the next `frames` frames; replaces what is left of the last.
    pub fn inject(&mut self, fault: LineFault, frames: u32) {
        self.injected.pass(fault, frames);
    }

    /// What a register holds, without reading it over the wire.
    pub fn register(&self, register: Register) -> u16 {
        match register {
            Register::AfeStatus => self.report().afe_status(),
            Register::SysStatus => self.report().sys_status(),
            _ => self.registers[usize::from(register.address())],
        }
    }

    /// The falling edge of /CS.
    fn begin(&mut self) -> Frame {
        self.traffic.transactions = self.traffic.transactions.saturating_add(1);
        let fault = self.injected.next();
        let mode = OperatingMode::of(self.register(Register::DeviceConfig));
        let stands_still = matches!(fault, Some(LineFault::Bus | LineFault::Frozen));
        if mode == Some(OperatingMode::Active) && !stands_still {
            self.convert(fault);
        }
        Frame {
            command: [0; FRAME_LEN],
            arrived: 0,
            clocked: 0,
            fault,
        }
    }

    /// The falling edge of /CS, for a master that clocks the frame byte by byte itself. On those
    /// wires there is no controller to fail: [`LineFault::Bus`] reads as [`LineFault::Silent`].
    pub fn select(&mut self) -> Frame {
        let mut frame = self.begin();
        if frame.fault == Some(LineFault::Bus) {
            frame.fault = Some(LineFault::Silent);
        }
        frame
    }

    /// The rising edge of /CS.
    pub fn release(&mut self, frame: &Frame) {
        if frame.arrived > 0 {
            self.obey(frame.command, frame.arrived);
        }
    }

    fn at(&mut self, register: Register) -> &mut u16 {
        &mut self.registers[usize::from(register.address())]
    }

    fn report(&self) -> StatusFaults {
        self.standing | self.happened
    }

    fn convert(&mut self, fault: Option<LineFault>) {
        if !self.due {
            return;
        }
        let strength = match fault {
            Some(LineFault::NoField) => 0.0,
            Some(LineFault::NearField) => 4.0,
            _ => 1.0,
        };
        let device = self.register(Register::DeviceConfig);
        let sensor = self.register(Register::SensorConfig);
        let channels = Channels::of(sensor).unwrap_or_default();
        let conversions = Average::of(device).unwrap_or_default().count();
        let noise_mt = NOISE_OF_32_MT * (32.0 / f64::from(conversions)).sqrt();
        for (axis, register) in AXES.into_iter().enumerate() {
            if channels.axes()[axis] {
                let range = Range::of(sensor >> (2 * axis)).unwrap_or_default();
                let full_scale = range.full_scale_mt(self.version);
                let noise = self.noise.as_mut().map_or(0.0, Noise::next);
                let field_mt = strength * self.field_mt[axis] + noise_mt * noise;
                let field = Field::from_mt(field_mt as f32, full_scale);
                *self.at(register) = field.code() as u16;
            }
        }
        self.sets = (self.sets + 1) % 8;
        self.due = false;
    }

    fn status(&self) -> Status {
        let report = self.report();
        let afe = report.without(StatusFaults::RESTARTED).afe_status() != 0;
        let sys = report.sys_status() != 0;
        let bit = |set: bool, bit: Status| if set { bit.bits() } else { 0 };
        let bits = bit(self.refused, Status::PREVIOUS_CRC)
            | bit(report.contains(StatusFaults::RESTARTED), Status::RESTARTED)
            | bit(sys, Status::SYSTEM)
            | bit(afe, Status::AFE)
            | bit(afe || sys, Status::ERROR)
            | self.sets;
        Status::new(bits)
    }

    /// The reply to a command, of which `arrived` bytes have come; what depends on others is
    /// not to be sent yet.
    fn reply(&self, command: [u8; FRAME_LEN], arrived: usize) -> [u8; FRAME_LEN] {
        let [first, ..] = command;
        let asked = Register::at(first & 0x7F).filter(|_| first & 0x80 != 0);
        let value = asked.map_or(0, |register| self.register(register));
        let reply = encode::register(self.status(), value);
        if arrived == FRAME_LEN && self.has_wrong_crc(command) {
            encode::rejecting(reply)
        } else {
            reply
        }
    }

    fn has_wrong_crc(&self, command: [u8; FRAME_LEN]) -> bool {
        let [.., last] = command;
        let checked = self.register(Register::TestConfig) & 0x0004 == 0;
        checked && crc4(&command) != last & 0x0F
    }

    /// The rising edge of /CS after `arrived` bytes: the command, if it is one.
    fn obey(&mut self, command: [u8; FRAME_LEN], arrived: usize) {
        self.refused = false;
        if arrived != FRAME_LEN {
            self.happened = self.happened | StatusFaults::FRAME_LENGTH;
            return;
        }
        if self.has_wrong_crc(command) {
            self.happened = self.happened | StatusFaults::FRAME_CRC;
            self.refused = true;
            return;
        }
        // Where the check bits are not looked at, they may be wrong.
        let [b0, b1, b2, b3] = command;
        let Ok(command) = Command::decode(&[b0, b1, b2, (b3 & 0xF0) | crc4(&command)]) else {
            return;
        };
        match command.access {
            Access::Write(register, value) => self.write(register, value),
            Access::Read(register) => self.clear(register),
        }
    }

    /// Reading a status register forgets what happened.
    fn clear(&mut self, register: Register) {
        let read = match register {
            Register::AfeStatus => StatusFaults::new(u16::MAX, 0),
            Register::SysStatus => StatusFaults::new(0, u16::MAX),
            _ => StatusFaults::NONE,
        };
        self.happened = self.happened.without(read);
    }

    fn write(&mut self, register: Register, value: u16) {
        if register == Register::TestConfig {
            let fixed = self.register(register) & !0x0007;
            *self.at(register) = fixed | (value & 0x0007);
        } else if register.is_setting() {
            *self.at(register) = value;
        }
        self.due = true;
    }
}

/// One transaction, byte by byte.
#[derive(Debug, Clone)]
pub struct Frame {
    command: [u8; FRAME_LEN],
    arrived: usize,
    clocked: usize,
    fault: Option<LineFault>,
}

impl Frame {
    /// Eight clocks: what the master reads while it sends a byte.
    pub fn byte(&mut self, slave: &TmagSlave, sent: u8) -> u8 {
        let at = self.clocked;
        self.clocked += 1;
        let inverted = |bit: u8| {
            let here = usize::from(bit / 8) == at;
            if here { 0x80 >> (bit % 8) } else { 0 }
        };
        match self.fault {
            Some(LineFault::Silent) => return RELEASED,
            Some(LineFault::ShortFrame) if at + 1 == FRAME_LEN => return RELEASED,
            _ => {}
        }
        let taken = match self.fault {
            Some(LineFault::SdiLow) => 0,
            Some(LineFault::FlipCommand(bit)) => sent ^ inverted(bit),
            _ => sent,
        };
        self.arrived += 1;
        let Some(slot) = self.command.get_mut(at) else {
            return RELEASED;
        };
        *slot = taken;
        let answer = slave.reply(self.command, self.arrived)[at];
        match self.fault {
            Some(LineFault::SdoLow) => 0,
            Some(LineFault::FlipReply(bit)) => answer ^ inverted(bit),
            _ => answer,
        }
    }
}

impl ErrorType for TmagSlave {
    type Error = SimSpiError;
}

impl SpiDevice for TmagSlave {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), SimSpiError> {
        let mut frame = self.begin();
        if frame.fault == Some(LineFault::Bus) {
            return Err(SimSpiError);
        }
        let mut traffic = self.traffic;
        wire::clock(operations, &mut traffic, |sent| frame.byte(self, sent));
        self.traffic = traffic;
        self.release(&frame);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
