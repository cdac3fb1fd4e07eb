//! A model that owns its bytes: made by training, or read from a file on a PC.

use std::boxed::Box;
use std::string::String;
use std::vec::Vec;

use crate::error::ModelError;
use crate::format::{
    AxisRecord, CRC_BYTES, ChannelRecord, Header, MAGIC, MAX_NAME_BYTES, MAX_TABLES, NO_LIMIT,
    OF_ROUGHNESS, OF_SAMPLES, TABLE_WORDS, TableRecord, VERSION, WITHOUT_OPINION, checksum,
    row_words, words,
};
use crate::layout::{Layout, RECORDS, TouchRule, check_bins, check_counts};
use crate::model::{Floors, Model};
use crate::quantiser::Quantiser;

/// What a model is made of; by default nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModelParts<'p> {
    /// Class names, in order.
    pub names: &'p [String],
    /// Samples in a block.
    pub block: u32,
    /// A quantiser a channel: the scale of its codes, and its range in training.
    pub channels: &'p [Quantiser],
    /// The tables; those of samples come first.
    pub tables: &'p [TableParts<'p>],
    /// The floors of each class.
    pub floors: Option<&'p [Floors]>,
    /// What a touch means.
    pub touch: Option<TouchRule>,
    /// The words of a second opinion; none where it is empty.
    pub opinion: &'p [u32],
}

/// What a table is looked up by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableSource {
    /// The codes of each sample.
    Samples,
    /// The roughness of each block (`roughness.rs`).
    Roughness,
}

/// A table.
#[derive(Debug, Clone, Copy)]
pub struct TableParts<'p> {
    /// What it is looked up by.
    pub source: TableSource,
    /// One axis or two.
    pub axes: &'p [Axis],
    /// Entries, `[bin of the first axis][bin of the second][class]` without gaps:
    /// round(w (log2 p + 20) · 1024).
    pub entries: &'p [u16],
}

/// An axis of a table: equal bins over a range of codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axis {
    /// Of which channel.
    pub channel: usize,
    /// 1 to 4096.
    pub bins: usize,
    /// Code of the lower edge of the first bin.
    pub low: i32,
    /// Code of the upper edge of the last bin (see [`Quantiser`]).
    pub high: i32,
}

impl Axis {
    /// Of so many bins from one code to another.
    pub const fn new(channel: usize, bins: usize, [low, high]: [i32; 2]) -> Self {
        Self {
            channel,
            bins,
            low,
            high,
        }
    }

    fn record(&self) -> Result<[u32; AxisRecord::WORDS], ModelError> {
        let Self { channel, bins, .. } = *self;
        check_bins(bins)?;
        let quantiser = Quantiser::of_codes(self.low, self.high);
        let binner = quantiser.binner(bins);
        let binner = binner.map_err(|reason| ModelError::Quantiser { channel, reason })?;
        let channel = u8::try_from(channel).map_err(|_| ModelError::Channels(channel))?;
        // Checked: at most 4095.
        let last_bin = (bins - 1) as u32;
        let [low, high] = [self.low, self.high].map(i32::cast_unsigned);
        Ok([
            u32::from(channel) | last_bin << 16,
            high,
            low,
            binner.slope(),
        ])
    }
}

impl<'p> TableParts<'p> {
    /// A table of the samples of one channel, as the papers have them.
    pub fn of_channel(axis: &'p Axis, entries: &'p [u16]) -> Self {
        Self {
            source: TableSource::Samples,
            axes: std::slice::from_ref(axis),
            entries,
        }
    }

    /// Its record, whose rows begin at word `first`.
    fn record(&self, first: usize) -> Result<[u32; TABLE_WORDS], ModelError> {
        let source = match self.source {
            TableSource::Samples => OF_SAMPLES,
            TableSource::Roughness => OF_ROUGHNESS,
        };
        let (axes, [a, b, c, d], [e, f, g, h]) = match self.axes {
            [one] => (1, one.record()?, [0; 4]),
            [one, other] => (2, one.record()?, other.record()?),
            _ => return Err(ModelError::Length),
        };
        let first = u32::try_from(first).map_err(|_| ModelError::Length)?;
        Ok([u32::from(source) | axes << 8, first, a, b, c, d, e, f, g, h])
    }

    fn cells(&self) -> usize {
        self.axes.iter().map(|axis| axis.bins).product()
    }
}

impl Header {
    const fn words(&self) -> [u32; Self::WORDS] {
        let [a, b] = self.version.to_le_bytes();
        let [c, d] = self.block.to_le_bytes();
        [
            u32::from_le_bytes(MAGIC),
            u32::from_le_bytes([a, b, self.classes, self.channels]),
            u32::from_le_bytes([self.sample_tables, self.rough_tables, c, d]),
            self.length,
            self.limit,
            self.gate.to_bits(),
            self.gap,
            self.floors,
        ]
    }
}

impl ChannelRecord {
    fn words(&self) -> [u32; Self::WORDS] {
        let origin = self.origin.to_bits();
        let [low, high] = [self.low, self.high].map(i32::cast_unsigned);
        let exponent = u32::from(self.exponent.cast_unsigned());
        let last = exponent | u32::from(self.rate_hz) << 16;
        [origin as u32, (origin >> 32) as u32, low, high, last]
    }
}

fn le_bytes(words: impl IntoIterator<Item = u32>) -> impl Iterator<Item = u8> {
    words.into_iter().flat_map(u32::to_le_bytes)
}

/// A model that owns its words.
pub type ModelBuf = Model<Box<[u32]>>;

impl ModelBuf {
    /// Puts a model together.
    ///
    /// # Errors
    /// As [`Model::parse`]: whatever could not be read back.
    pub fn new(parts: &ModelParts<'_>) -> Result<Self, ModelError> {
        let classes = parts.names.len();
        let channels = parts.channels.len();
        check_counts(classes, channels, parts.block)?;
        let of_roughness = |table: &&TableParts<'_>| table.source == TableSource::Roughness;
        let rough_tables = parts.tables.iter().filter(of_roughness).count();
        if parts.tables.len() > MAX_TABLES {
            return Err(ModelError::Tables(parts.tables.len()));
        }

        let mut body: Vec<u8> = Vec::new();
        for (channel, q) in parts.channels.iter().enumerate() {
            q.check(1)
                .map_err(|reason| ModelError::Quantiser { channel, reason })?;
            let record = ChannelRecord {
                origin: q.origin,
                low: q.low,
                high: q.high,
                // Checked: at most 1000 either way.
                exponent: q.exponent as i16,
                rate_hz: 0,
            };
            body.extend(le_bytes(record.words()));
        }
        let mut tail = Vec::new();
        if let Some(floors) = parts.floors {
            if floors.len() != classes {
                return Err(ModelError::Length);
            }
            let words = |floors: &Floors| [floors.samples, floors.roughness].map(u16::to_le_bytes);
            tail.extend(floors.iter().flat_map(words).flatten());
        }
        for (class, name) in parts.names.iter().enumerate() {
            if name.is_empty() || name.len() > MAX_NAME_BYTES {
                return Err(ModelError::NameLength { class });
            }
            tail.push(name.len() as u8);
            tail.extend_from_slice(name.as_bytes());
        }
        tail.resize(tail.len().next_multiple_of(4), 0);

        let before_rows = body.len() + parts.tables.len() * TableRecord::BYTES + tail.len();
        let mut first = (Header::BYTES + before_rows) / size_of::<u32>();
        for table in parts.tables {
            body.extend(le_bytes(table.record(first)?));
            if table.entries.len() != table.cells() * classes {
                return Err(ModelError::Length);
            }
            first += table.cells() * row_words(classes);
        }
        body.append(&mut tail);
        for row in parts
            .tables
            .iter()
            .flat_map(|table| table.entries.chunks(classes))
        {
            let row_bytes = row_words(classes) * size_of::<u32>();
            let end = body.len() + row_bytes;
            body.extend(row.iter().flat_map(|e| e.to_le_bytes()));
            body.resize(end, 0);
        }
        body.extend(parts.opinion.iter().flat_map(|word| word.to_le_bytes()));
        let length = Header::BYTES + body.len() + CRC_BYTES;
        let touch = parts.touch;
        // Counts are checked: the fields fit.
        let header = Header {
            version: if parts.opinion.is_empty() {
                WITHOUT_OPINION
            } else {
                VERSION
            },
            classes: classes as u8,
            channels: channels as u8,
            sample_tables: (parts.tables.len() - rough_tables) as u8,
            rough_tables: rough_tables as u8,
            block: parts.block as u16,
            length: u32::try_from(length).map_err(|_| ModelError::Length)?,
            limit: touch.map_or(NO_LIMIT, |touch| touch.limit),
            gate: touch.map_or(0.0, |touch| touch.gate),
            gap: touch.map_or(0, |touch| touch.gap),
            floors: u32::from(parts.floors.is_some()) | (parts.opinion.len() as u32) << 8,
        };
        Self::summed(le_bytes(header.words()).chain(body).collect())
    }

    /// From all bytes but the sum over them.
    fn summed(mut bytes: Vec<u8>) -> Result<Self, ModelError> {
        let crc = checksum(&bytes);
        bytes.extend_from_slice(&crc.to_le_bytes());
        Self::from_bytes(&bytes)
    }

    /// The same model, which knows the samples a second of its training; of more than 65535 it
    /// knows nothing.
    #[must_use]
    pub fn at_rate(&self, rate_hz: u32) -> Self {
        let mut model = self.clone();
        // In the first channel's record, above its exponent.
        let place = RECORDS + ChannelRecord::WORDS - 1;
        if let Some((sum, words)) = model.words.split_last_mut() {
            let rate_hz = u16::try_from(rate_hz).unwrap_or(0);
            words[place] = u32::from(words[place] as u16) | u32::from(rate_hz) << 16;
            *sum = checksum(bytemuck::cast_slice(words));
        }
        model
    }

    /// The same model without its second opinion: as training makes it where nothing is expected
    /// to differ ([`Expect::Same`](crate::train::Expect::Same)). `None` where it has none, or
    /// names by that alone.
    pub fn without_opinion(&self) -> Option<Self> {
        let (first, rest) = self.as_bytes().split_at_checked(Header::BYTES)?;
        let header = Header::of(words(first)?);
        let opinion = header.opinion_words();
        if opinion == 0 || header.sample_tables == 0 {
            return None;
        }
        let header = Header {
            version: WITHOUT_OPINION,
            length: header.length - 4 * opinion as u32,
            floors: header.floors & 1,
            ..header
        };
        let body = rest.get(..header.length as usize - Header::BYTES - CRC_BYTES)?;
        Self::summed(
            le_bytes(header.words())
                .chain(body.iter().copied())
                .collect(),
        )
        .ok()
    }

    /// Copies and checks the content of a model file, however it is aligned.
    ///
    /// # Errors
    /// As [`Model::parse`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ModelError> {
        let (chunks, rest) = bytes.as_chunks();
        if !rest.is_empty() {
            // No model has such a length: the check says what is wrong.
            Layout::check(bytes)?;
            return Err(ModelError::Length);
        }
        Self::from_words(chunks.iter().map(|c| u32::from_ne_bytes(*c)).collect())
    }
}
