//! Checking the bytes of a model file, and where in it things lie.

use zerocopy::FromBytes;

use crate::error::ModelError;
use crate::format::{
    CRC_BYTES, ChannelRecord, ENTRY_MAX, Header, MAGIC, MAX_BINS, MAX_BLOCK, MAX_CHANNELS,
    MAX_CLASSES, MAX_SAMPLES_TIMES_CHANNELS, VERSION, checksum, row_words,
};
use crate::quantiser::Quantiser;

/// Counts of a checked model and where its parts begin, in words of four bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(crate) classes: usize,
    pub(crate) channels: usize,
    /// Bins a channel, less one.
    pub(crate) last_bin: usize,
    /// Words of a row of the table.
    pub(crate) row_words: usize,
    /// Samples.
    pub(crate) block: u32,
    /// The channels' records end and the names begin.
    pub(crate) names: usize,
    /// The names end and the table begins.
    pub(crate) table: usize,
    /// The table ends and the checksum begins.
    pub(crate) end: usize,
}

/// The word at which the channels' records begin.
pub(crate) const RECORDS: usize = size_of::<Header>() / size_of::<u32>();

impl Layout {
    /// Checks a model file: its magic, version and header, then its length, its
    /// checksum and its content.
    ///
    /// # Errors
    ///
    /// The first thing found wrong.
    pub(crate) fn check(bytes: &[u8]) -> Result<Self, ModelError> {
        let (header, _) = Header::ref_from_prefix(bytes).map_err(|_| ModelError::TooShort)?;
        if header.magic != MAGIC {
            return Err(ModelError::BadMagic);
        }
        if header.version.get() != VERSION {
            return Err(ModelError::UnknownVersion(header.version.get()));
        }
        let classes = usize::from(header.classes);
        let channels = usize::from(header.channels);
        let bins = usize::from(header.bins.get());
        let block = u32::from(header.block.get());
        check_counts(classes, channels, bins, block)?;

        let length = header.length.get() as usize;
        if bytes.len() < length {
            return Err(ModelError::TooShort);
        }
        if bytes.len() > length {
            return Err(ModelError::TrailingBytes);
        }
        let (body, crc) = bytes
            .split_last_chunk::<CRC_BYTES>()
            .ok_or(ModelError::TooShort)?;
        if checksum(body) != u32::from_le_bytes(*crc) {
            return Err(ModelError::Checksum);
        }

        let rest = body.get(size_of::<Header>()..).ok_or(ModelError::Length)?;
        let (records, rest) = <[ChannelRecord]>::ref_from_prefix_with_elems(rest, channels)
            .map_err(|_| ModelError::Length)?;
        check_records(records, bins)?;
        // Counts are checked: at most 6.3 MB.
        let table_bytes = bins * channels * row_words(classes) * size_of::<u32>();
        let (names, table) = rest
            .len()
            .checked_sub(table_bytes)
            .and_then(|at| rest.split_at_checked(at))
            .ok_or(ModelError::Length)?;
        check_names(names, classes)?;
        check_table(table, classes)?;
        // The names are padded to whole words, and all other parts are such.
        let words = |bytes: &[u8]| bytes.len() / size_of::<u32>();
        Ok(Self {
            classes,
            channels,
            last_bin: bins - 1,
            row_words: row_words(classes),
            block,
            names: words(body) - words(rest),
            table: words(body) - words(table),
            end: words(body),
        })
    }
}

impl ChannelRecord {
    pub(crate) fn quantiser(&self) -> Quantiser {
        Quantiser {
            origin: self.origin.get(),
            exponent: i32::from(self.exponent.get()),
            low: self.low.get(),
            high: self.high.get(),
        }
    }
}

/// The ranges of the header's counts.
pub(crate) fn check_counts(
    classes: usize,
    channels: usize,
    bins: usize,
    block: u32,
) -> Result<(), ModelError> {
    if !(2..=MAX_CLASSES).contains(&classes) {
        return Err(ModelError::Classes(classes));
    }
    if !(1..=MAX_CHANNELS).contains(&channels) {
        return Err(ModelError::Channels(channels));
    }
    if !(1..=MAX_BINS).contains(&bins) {
        return Err(ModelError::Bins(bins));
    }
    if !(1..=MAX_BLOCK).contains(&block) {
        return Err(ModelError::Block(block));
    }
    let product = block * channels as u32;
    if product > MAX_SAMPLES_TIMES_CHANNELS {
        return Err(ModelError::BlockTimesChannels(product));
    }
    Ok(())
}

fn check_records(records: &[ChannelRecord], bins: usize) -> Result<(), ModelError> {
    for (channel, record) in records.iter().enumerate() {
        record
            .quantiser()
            .check(bins)
            .map_err(|reason| ModelError::Quantiser { channel, reason })?;
        if record.reserved.get() != 0 {
            return Err(ModelError::Padding);
        }
    }
    Ok(())
}

/// Splits length-prefixed names; ends where the bytes do.
pub(crate) fn names(mut bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    core::iter::from_fn(move || {
        let (&length, rest) = bytes.split_first()?;
        let (name, rest) = rest.split_at_checked(usize::from(length))?;
        bytes = rest;
        Some(name)
    })
}

fn check_names(bytes: &[u8], classes: usize) -> Result<(), ModelError> {
    let mut used = 0;
    let mut found = names(bytes);
    for class in 0..classes {
        let name = found.next().ok_or(ModelError::Length)?;
        if name.is_empty() {
            return Err(ModelError::NameLength { class });
        }
        if core::str::from_utf8(name).is_err() {
            return Err(ModelError::NameNotUtf8 { class });
        }
        used += 1 + name.len();
    }
    let padding = bytes.get(used..).ok_or(ModelError::Length)?;
    if bytes.len() != used.next_multiple_of(4) {
        return Err(ModelError::Length);
    }
    if padding.iter().any(|&b| b != 0) {
        return Err(ModelError::Padding);
    }
    Ok(())
}

/// Larger entries could overflow the sums of a block.
fn check_table(bytes: &[u8], classes: usize) -> Result<(), ModelError> {
    let (entries, _) = bytes.as_chunks::<2>();
    let entry = |bytes: &[u8; 2]| u16::from_le_bytes(*bytes);
    if entries.iter().any(|e| entry(e) > ENTRY_MAX) {
        return Err(ModelError::TableEntry);
    }
    let odd = classes % 2 == 1;
    let mut rows = entries.chunks(2 * row_words(classes));
    if odd && rows.any(|row| row.last().is_some_and(|e| entry(e) != 0)) {
        return Err(ModelError::Padding);
    }
    Ok(())
}
