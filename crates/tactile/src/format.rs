//! The model file, byte for byte (versions 2 and 3, little-endian throughout).
//!
//! | bytes | content |
//! |---|---|
//! | 4 | magic `WLIK` |
//! | u16 | version: 3 of models with an opinion, else 2 |
//! | u8, u8 | classes K (2–32), channels C (1–24) |
//! | u8, u8 | tables of samples, at least one but where the opinion names; of roughness (both together at most 24) |
//! | u16 | block, 1–10000 samples |
//! | u32 | length of the whole file in bytes |
//! | u32, f32, u32 | rule of touches: limit of a deficit at an onset, 1/1024 bit; gate, 0 to 1; gap, samples; or 2³² − 1, 0, 0: none |
//! | u32 | 1 if there are floors, else 0; and 256 times the words of the opinion |
//! | C × 20 | per channel: origin f64, low i32, high i32, exponent i16 (see [`crate::Quantiser`]), u16: of the first channel the samples a second of training, 0: not known, and of others zero |
//! | T × 40 | per table: source u8 (0 samples, 1 roughness), axes u8 (1 or 2), zero u16, first word of its rows u32; two axes, of one the second is zero: channel u8 (0 or 1 of roughness), zero u8, bins − 1 u16 (to 4095), high i32, low i32, slope u32 (see [`crate::Binner`]) |
//! | K × 4 | floors, if any, per class: of samples u16, of roughness u16 |
//! | K names | per class: length u8 (not zero), UTF-8; then zeros up to a multiple of four |
//! | rows | per table u16: `[bin of axis 1][bin of axis 2][class]`, a zero after an odd K |
//! | opinion | in version 3: see `opinion/section.rs` |
//! | u32 | CRC-32 (ISO-HDLC) of all before |
//!
//! A table entry is round(w (log2 p + 20) · 1024) with the table's weight w; the
//! offset is common to all classes and cancels in the posterior. The papers' models
//! have a table of samples a channel with w = 1, no rule of touches and no floors.
//! Rows are whole words, so that a core without unaligned loads reads them as fast.

use crate::binner::Binner;

/// Most whiskers that are heard: on a board one, two with the feature `pair`, 24 with `array`;
/// in a simulation 24.
pub const MAX_STREAMS: usize = if !cfg!(target_os = "none") || cfg!(feature = "array") {
    24
} else if cfg!(feature = "pair") {
    2
} else {
    1
};

pub(crate) const MAGIC: [u8; 4] = *b"WLIK";
/// Newest version of the format.
pub const VERSION: u16 = 3;
/// The version of models without an opinion.
pub(crate) const WITHOUT_OPINION: u16 = 2;
/// Most classes; on a board so many that their sums and evidence take 512 bytes.
pub const MAX_CLASSES: usize = if cfg!(target_os = "none") { 16 } else { 32 };
/// Most channels: x and y of twelve whiskers.
pub const MAX_CHANNELS: usize = 24;
/// Most tables.
pub const MAX_TABLES: usize = 24;
/// Most axes of the tables of samples together.
pub const MAX_SAMPLE_AXES: usize = 24;
/// Roughness is that of the first two channels, and has as many axes over all tables.
pub const ROUGH_CHANNELS: usize = 2;
/// Most bins an axis.
pub const MAX_BINS: usize = 4096;
/// Longest block, samples.
pub const MAX_BLOCK: u32 = 10_000;
/// Most lookups of the papers' models in one block: 65535 · [`ENTRY_MAX`] < 2³¹ keeps
/// sums in a word.
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
/// The entry of probability one where the weight is one.
pub const ENTRY_MAX: u16 = (ENTRY_OFFSET_BITS * ENTRIES_PER_BIT) as u16;

/// The most that the largest entries of all tables may sum up to in a block, so that
/// with 2²⁹ of deficit it stays below 2³¹.
pub(crate) const MAX_BLOCK_SUM: u64 = MAX_SAMPLES_TIMES_CHANNELS as u64 * ENTRY_MAX as u64;
/// [`Header::limit`] of a model without a rule of touches.
pub(crate) const NO_LIMIT: u32 = u32::MAX;

/// Bytes of the checksum at the end.
pub const CRC_BYTES: usize = 4;

/// So many words, wherever they lie.
pub(crate) fn words<const N: usize>(bytes: &[u8]) -> Option<[u32; N]> {
    let (words, _) = bytes.as_chunks();
    words
        .first_chunk()
        .map(|words| words.map(u32::from_le_bytes))
}

/// How a file begins, after its magic.
#[derive(Debug)]
pub(crate) struct Header {
    pub(crate) version: u16,
    pub(crate) classes: u8,
    pub(crate) channels: u8,
    pub(crate) sample_tables: u8,
    pub(crate) rough_tables: u8,
    pub(crate) block: u16,
    pub(crate) length: u32,
    pub(crate) limit: u32,
    pub(crate) gate: f32,
    pub(crate) gap: u32,
    pub(crate) floors: u32,
}

impl Header {
    pub(crate) const WORDS: usize = 8;
    pub(crate) const BYTES: usize = 4 * Self::WORDS;

    pub(crate) fn of(words: [u32; Self::WORDS]) -> Self {
        let [_, counts, tables, length, limit, gate, gap, floors] = words;
        let [_, _, classes, channels] = counts.to_le_bytes();
        let [sample_tables, rough_tables, ..] = tables.to_le_bytes();
        Self {
            version: counts as u16,
            classes,
            channels,
            sample_tables,
            rough_tables,
            block: (tables >> 16) as u16,
            length,
            limit,
            gate: f32::from_bits(gate),
            gap,
            floors,
        }
    }

    pub(crate) const fn opinion_words(&self) -> usize {
        (self.floors >> 8) as usize
    }
}

#[derive(Debug)]
pub(crate) struct ChannelRecord {
    pub(crate) origin: f64,
    pub(crate) low: i32,
    pub(crate) high: i32,
    pub(crate) exponent: i16,
    /// Of the first channel samples a second, 0: not known; of others zero.
    pub(crate) rate_hz: u16,
}

impl ChannelRecord {
    pub(crate) const WORDS: usize = 5;
    pub(crate) const BYTES: usize = 4 * Self::WORDS;

    pub(crate) fn of([lower, upper, low, high, last]: [u32; Self::WORDS]) -> Self {
        Self {
            origin: f64::from_bits(u64::from(lower) | u64::from(upper) << 32),
            low: low.cast_signed(),
            high: high.cast_signed(),
            exponent: last as i16,
            rate_hz: (last >> 16) as u16,
        }
    }
}

pub(crate) const TABLE_WORDS: usize = 10;

/// A table, as it is read in place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TableRecord<'m>(pub(crate) &'m [u32; TABLE_WORDS]);

impl TableRecord<'_> {
    pub(crate) const BYTES: usize = 4 * TABLE_WORDS;

    pub(crate) const fn source(self) -> u8 {
        self.0[0] as u8
    }

    #[inline]
    pub(crate) const fn axes(self) -> u8 {
        (self.0[0] >> 8) as u8
    }

    pub(crate) const fn reserved(self) -> u16 {
        (self.0[0] >> 16) as u16
    }

    /// The word of the file at which its rows begin.
    #[inline]
    pub(crate) const fn first(self) -> u32 {
        self.0[1]
    }

    #[inline]
    pub(crate) const fn first_axis(self) -> AxisRecord {
        let [_, _, a, b, c, d, ..] = *self.0;
        AxisRecord::of([a, b, c, d])
    }

    #[inline]
    pub(crate) const fn second_axis(self) -> AxisRecord {
        let [.., a, b, c, d] = *self.0;
        AxisRecord::of([a, b, c, d])
    }

    pub(crate) const fn axis(self) -> [AxisRecord; 2] {
        [self.first_axis(), self.second_axis()]
    }
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisRecord {
    pub(crate) channel: u8,
    pub(crate) reserved: u8,
    pub(crate) last_bin: u16,
    pub(crate) high: i32,
    pub(crate) binner: Binner,
}

impl AxisRecord {
    pub(crate) const WORDS: usize = 4;

    #[inline]
    const fn of([first, high, low, slope]: [u32; Self::WORDS]) -> Self {
        Self {
            channel: first as u8,
            reserved: (first >> 8) as u8,
            last_bin: (first >> 16) as u16,
            high: high.cast_signed(),
            binner: Binner::new(low.cast_signed(), slope),
        }
    }
}

/// [`TableRecord::source`] of a table that is looked up each sample.
pub(crate) const OF_SAMPLES: u8 = 0;
/// Of one that is looked up once a block, by the roughness of its channels.
pub(crate) const OF_ROUGHNESS: u8 = 1;

/// Two classes a word.
pub(crate) const fn row_words(classes: usize) -> usize {
    classes.div_ceil(2)
}

/// CRC-32 as in zip and Ethernet. Without a lookup table: it runs once at
/// start, and a kilobyte of flash is dearer than those milliseconds.
pub fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
            sum >> 1 ^ 0xEDB8_8320 & (sum & 1).wrapping_neg()
        })
    })
}
