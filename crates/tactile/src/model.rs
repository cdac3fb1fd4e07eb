//! A likelihood model read in place: from flash, with nothing copied.
//!
//! [`Model::parse`] checks everything once, outside the tick; see `format.rs`
//! for the layout. A model linked into a program comes by
//! [`crate::include_model`], which also sees to its alignment.

use zerocopy::FromBytes;

use crate::error::ModelError;
use crate::format::{
    CRC_BYTES, ChannelRecord, ENTRIES_PER_BIT, ENTRY_MAX, ENTRY_OFFSET_BITS, Header, MAGIC,
    MAX_BINS, MAX_BLOCK, MAX_CHANNELS, MAX_CLASSES, MAX_SAMPLES_TIMES_CHANNELS, VERSION, checksum,
    row_words,
};
use crate::quantiser::Quantiser;

/// Bytes on a four-byte boundary, as a model must lie.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(4))]
pub struct Aligned<B: ?Sized>(pub B);

/// The bytes of a model file, linked into the program and aligned:
/// `Model::parse(include_model!("example.model"))`. The path is relative to
/// the source file, as for `include_bytes!`.
#[macro_export]
macro_rules! include_model {
    ($path:expr $(,)?) => {{
        static BYTES: &$crate::Aligned<[u8]> = &$crate::Aligned(*::core::include_bytes!($path));
        &BYTES.0
    }};
}

/// A checked model, borrowing its bytes.
#[derive(Debug, Clone, Copy)]
pub struct Model<'a> {
    classes: usize,
    bins: usize,
    block: u32,
    channels: &'a [ChannelRecord],
    /// Length-prefixed names, one after the other.
    names: &'a [u8],
    table: &'a [u32],
}

impl<'a> Model<'a> {
    /// Reads a model. `bytes` must be the file and no more, and start on a
    /// four-byte boundary.
    ///
    /// # Errors
    ///
    /// [`ModelError`] with the first thing found wrong: the checks go from the
    /// magic, version and header to the length, the checksum and the content.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ModelError> {
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
        for (channel, record) in records.iter().enumerate() {
            record
                .quantiser()
                .check(bins)
                .map_err(|reason| ModelError::Quantiser { channel, reason })?;
            if record.reserved.get() != 0 {
                return Err(ModelError::Padding);
            }
        }
        // Counts are checked: at most 6.3 MB.
        let table_bytes = bins * channels * row_words(classes) * size_of::<u32>();
        let (names, table) = rest
            .len()
            .checked_sub(table_bytes)
            .and_then(|at| rest.split_at_checked(at))
            .ok_or(ModelError::Length)?;
        check_names(names, classes)?;
        let table = <[u32]>::ref_from_bytes(table).map_err(|_| ModelError::Misaligned)?;
        check_table(table, classes)?;
        Ok(Self {
            classes,
            bins,
            block,
            channels: records,
            names,
            table,
        })
    }

    /// Number of classes K, 2 to 32.
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// Number of channels C, 1 to 24.
    pub fn channels(&self) -> usize {
        self.channels.len()
    }

    /// Bins a channel B, 1 to 4096.
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// Samples in a block, 1 to 10000.
    pub fn block(&self) -> u32 {
        self.block
    }

    /// The quantiser of a channel.
    pub fn quantiser(&self, channel: usize) -> Option<Quantiser> {
        self.channels.get(channel).map(ChannelRecord::quantiser)
    }

    /// The names of the classes, in order.
    pub fn names(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        names(self.names)
            .take(self.classes)
            .map(|name| core::str::from_utf8(name).unwrap_or(""))
    }

    /// The name of a class.
    pub fn name(&self, class: usize) -> Option<&'a str> {
        self.names().nth(class)
    }

    /// log2 of the smoothed probability of a bin, −19.93 to 0, to 2⁻¹¹ bit.
    pub fn log2_likelihood(&self, channel: usize, bin: usize, class: usize) -> Option<f32> {
        if channel >= self.channels() || bin >= self.bins || class >= self.classes {
            return None;
        }
        let row = bin * self.channels() + channel;
        let word = *self.table.get(row * row_words(self.classes) + class / 2)?;
        let entry = (word >> (class % 2 * 16)) as u16;
        Some(f32::from(entry) / ENTRIES_PER_BIT as f32 - ENTRY_OFFSET_BITS as f32)
    }

    pub(crate) fn table(&self) -> &'a [u32] {
        self.table
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

/// Splits length-prefixed names; ends where the bytes do.
fn names(mut bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
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

/// Larger entries would carry from one class into the next.
fn check_table(table: &[u32], classes: usize) -> Result<(), ModelError> {
    let most = u32::from(ENTRY_MAX);
    if table.iter().any(|w| w & 0xffff > most || w >> 16 > most) {
        return Err(ModelError::TableEntry);
    }
    let odd = classes % 2 == 1;
    if odd
        && table
            .chunks(row_words(classes))
            .any(|row| row.last().is_some_and(|w| w >> 16 != 0))
    {
        return Err(ModelError::Padding);
    }
    Ok(())
}
