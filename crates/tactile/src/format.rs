//! The model file, byte for byte (version 1, little-endian throughout).
//!
//! | bytes | content |
//! |---|---|
//! | 4 | magic `WLIK` |
//! | u16 | version, 1 |
//! | u8, u8 | classes K (2–32), channels C (1–24) |
//! | u16, u16 | bins B (1–4096), block (1–10000 samples; block · C ≤ 65535) |
//! | u32 | length of the whole file in bytes |
//! | C × 20 | per channel: origin f64, low i32, high i32, exponent i16, zero u16 (see [`crate::Quantiser`]) |
//! | K names | per class: length u8 (not zero), UTF-8; then zeros up to a multiple of four |
//! | B × C × ⌈K/2⌉ × 4 | table of u16: `[bin][channel][class]`, a zero after an odd K |
//! | u32 | CRC-32 (ISO-HDLC) of all before |
//!
//! A table entry is round((log2 p + 20) · 1024), from 0 to 20480; the offset of
//! 20 bit is common to all classes and cancels in the posterior. Rows are whole
//! words, so that a core without unaligned loads reads them as fast.

use zerocopy::byteorder::little_endian::{F64, I16, I32, U16, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

/// First bytes of a model file.
pub(crate) const MAGIC: [u8; 4] = *b"WLIK";
/// Version of the format.
pub const VERSION: u16 = 1;
/// Most classes.
pub const MAX_CLASSES: usize = 32;
/// Most channels: x and y of twelve whiskers.
pub const MAX_CHANNELS: usize = 24;
/// Most bins a channel.
pub const MAX_BINS: usize = 4096;
/// Longest block, samples.
pub const MAX_BLOCK: u32 = 10_000;
/// Most lookups in one block: 65535 · [`ENTRY_MAX`] < 2³¹ keeps sums in a word.
pub const MAX_SAMPLES_TIMES_CHANNELS: u32 = 65_535;
/// Longest class name, bytes of UTF-8.
pub const MAX_NAME_BYTES: usize = 255;
/// Added to each probability before the logarithm, so that a bin no training
/// sample came near has a finite one.
pub const LOG_FLOOR: f64 = 1e-6;
/// Table units in one bit of log-likelihood.
pub const ENTRIES_PER_BIT: u32 = 1024;
/// Offset of the table entries: log2 of the floor is −19.93.
pub const ENTRY_OFFSET_BITS: u32 = 20;
/// The entry of probability one, and the largest.
pub const ENTRY_MAX: u16 = (ENTRY_OFFSET_BITS * ENTRIES_PER_BIT) as u16;

/// Bytes of the checksum at the end.
pub const CRC_BYTES: usize = 4;

#[derive(Debug, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub(crate) struct Header {
    pub(crate) magic: [u8; 4],
    pub(crate) version: U16,
    pub(crate) classes: u8,
    pub(crate) channels: u8,
    pub(crate) bins: U16,
    pub(crate) block: U16,
    pub(crate) length: U32,
}

#[derive(Debug, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub(crate) struct ChannelRecord {
    pub(crate) origin: F64,
    pub(crate) low: I32,
    pub(crate) high: I32,
    pub(crate) exponent: I16,
    pub(crate) reserved: U16,
}

/// Words of one row: two classes a word.
pub(crate) const fn row_words(classes: usize) -> usize {
    classes.div_ceil(2)
}

/// CRC-32 as in zip and Ethernet. Without a lookup table: it runs once at
/// start, and a kilobyte of flash is dearer than those milliseconds.
pub fn checksum(bytes: &[u8]) -> u32 {
    const CRC: crc::Crc<u32, crc::NoTable> =
        crc::Crc::<u32, crc::NoTable>::new(&crc::CRC_32_ISO_HDLC);
    CRC.checksum(bytes)
}
