//! Driver and frame decoder for the Melexis MLX90333 triaxis Hall sensor.
//!
//! Glossary:
//! - *frame*: the eight bytes B0..B7 that the sensor sends while /SS is low;
//! - *word*: a 16-bit reading ([`Word`]), sent low byte first as far as is known ([`ByteOrder`]);
//! - *alpha-beta*, *XYZ*: what the words mean, chosen in the sensor's EEPROM
//!   ([`Mode`]);
//! - *sum byte*: B7, which guards the other bytes ([`SumRule`]);
//! - *error word*: B5..B6 of an alpha-beta frame, the sensor's own report on
//!   itself ([`Faults`]);
//! - *code*: the 14 bits of a word that carry the reading.
//!
//! Where to look: a decoded frame in `frame.rs`, one reading in `word.rs`, the error word in
//! `faults.rs`, blocking reads in `driver.rs`, the sensor's side of the wire in `encode.rs`, every
//! duration and rate in `timing.rs`.
//!
#![doc = include_str!("../README.md")]
#![no_std]

mod driver;
pub mod encode;
mod faults;
mod frame;
pub mod timing;
mod word;

pub use driver::{Error, Mlx90333};
pub use faults::Faults;
pub use frame::{ByteOrder, Decoder, Frame, FrameError, Mode, SumRule};
pub use timing::SPI_MODE;
pub use word::Word;

/// Bytes in a frame, in either mode.
pub const FRAME_LEN: usize = 8;

/// What the master sends for every byte of a frame.
///
/// MOSI and MISO are one open-drain line: a master that sends zeros holds the
/// line low over the sensor's answer, one that sends ones lets go of it.
pub const MASTER_BYTE: u8 = 0xFF;

/// B0 of every frame, from the sensor.
pub const START_BYTE: u8 = 0xFF;
