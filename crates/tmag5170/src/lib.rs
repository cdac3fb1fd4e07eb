//! Driver and frame codec for the Texas Instruments TMAG5170 three-axis Hall sensor.
//!
//! Glossary:
//! - *frame*: the 32 bits that go both ways while /CS is low: a command from the master
//!   ([`Command`]), a reply from the sensor;
//! - *reply*: status bits and the register asked for ([`Reply`]);
//! - *channel*: X, Y, Z or the temperature; a *conversion* measures the enabled ones in turn;
//! - *CRC*: the last four bits of every frame ([`crc4`]);
//! - *faults*: what the sensor reports about itself, in two registers ([`StatusFaults`]).
//!
//! Where to look: what is sent in `command.rs`, what comes back in `reply.rs`, results in
//! `value.rs`, settings in `config.rs`, registers in `register.rs`, the sensor's own report
//! in `faults.rs`, reads and writes over a bus in `driver.rs`, the sensor's side of the wire
//! in `encode.rs`, every duration and rate in `timing.rs`.
//!
#![doc = include_str!("../README.md")]
#![no_std]

mod command;
mod config;
mod crc;
mod driver;
pub mod encode;
mod faults;
mod register;
mod reply;
pub mod timing;
mod value;

pub use command::{Access, Command, CommandError};
pub use config::{
    AnglePair, Average, Channels, Config, DeviceConfig, Diagnostics, MagnetType, OperatingMode,
    Range, SensorConfig, SleepTime, SystemConfig, Trigger, Version,
};
pub use crc::crc4;
pub use driver::{Error, Tmag5170};
pub use faults::{Fault, StatusFaults};
pub use register::Register;
pub use reply::{Reply, ReplyError, Status, check};
pub use timing::SPI_MODE;
pub use value::Field;

/// Bytes in a frame, in either direction.
pub const FRAME_LEN: usize = 4;
