//! A model that owns its bytes: made by training, or read from a file on a PC.

use std::boxed::Box;
use std::string::String;
use std::vec::Vec;

use zerocopy::IntoBytes;

use crate::error::ModelError;
use crate::format::{
    CRC_BYTES, ChannelRecord, Header, MAGIC, MAX_NAME_BYTES, VERSION, checksum, row_words,
};
use crate::layout::{Layout, check_counts};
use crate::model::Model;
use crate::quantiser::Quantiser;

/// What a model is made of.
#[derive(Debug, Clone, Copy)]
pub struct ModelParts<'p> {
    /// Class names, in order.
    pub names: &'p [String],
    /// Samples in a block.
    pub block: u32,
    /// Bins a channel.
    pub bins: usize,
    /// A quantiser a channel.
    pub quantisers: &'p [Quantiser],
    /// Table entries, `[bin][channel][class]` without gaps:
    /// round((log2 p + 20) · 1024).
    pub entries: &'p [u16],
}

/// A model that owns its words.
pub type ModelBuf = Model<Box<[u32]>>;

impl ModelBuf {
    /// Puts a model together.
    ///
    /// # Errors
    ///
    /// As [`Model::parse`]: whatever could not be read back.
    pub fn new(parts: &ModelParts<'_>) -> Result<Self, ModelError> {
        let classes = parts.names.len();
        let channels = parts.quantisers.len();
        check_counts(classes, channels, parts.bins, parts.block)?;
        if parts.entries.len() != parts.bins * channels * classes {
            return Err(ModelError::Length);
        }
        let mut body = Vec::new();
        for (channel, q) in parts.quantisers.iter().enumerate() {
            q.check(parts.bins)
                .map_err(|reason| ModelError::Quantiser { channel, reason })?;
            let record = ChannelRecord {
                origin: q.origin.into(),
                low: q.low.into(),
                high: q.high.into(),
                // Checked: at most 1000 either way.
                exponent: (q.exponent as i16).into(),
                reserved: 0.into(),
            };
            body.extend_from_slice(record.as_bytes());
        }
        for (class, name) in parts.names.iter().enumerate() {
            if name.is_empty() || name.len() > MAX_NAME_BYTES {
                return Err(ModelError::NameLength { class });
            }
            body.push(name.len() as u8);
            body.extend_from_slice(name.as_bytes());
        }
        body.resize(body.len().next_multiple_of(4), 0);
        for row in parts.entries.chunks(classes) {
            let row_bytes = row_words(classes) * size_of::<u32>();
            let end = body.len() + row_bytes;
            body.extend(row.iter().flat_map(|e| e.to_le_bytes()));
            body.resize(end, 0);
        }
        // Counts are checked: the fields fit, and the whole is below 7 MB.
        let header = Header {
            magic: MAGIC,
            version: VERSION.into(),
            classes: classes as u8,
            channels: channels as u8,
            bins: (parts.bins as u16).into(),
            block: (parts.block as u16).into(),
            length: ((size_of::<Header>() + body.len() + CRC_BYTES) as u32).into(),
        };
        let mut bytes = header.as_bytes().to_vec();
        bytes.append(&mut body);
        let crc = checksum(&bytes);
        bytes.extend_from_slice(&crc.to_le_bytes());
        Self::from_bytes(&bytes)
    }

    /// Copies and checks the content of a model file, however it is aligned.
    ///
    /// # Errors
    ///
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
