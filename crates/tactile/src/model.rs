//! A likelihood model read in place: from flash on a board, from memory that it
//! owns on a PC.
//!
//! [`Model::parse`] checks everything once, outside the tick; see `format.rs`
//! for the file. A model linked into a program comes by
//! [`crate::include_model`], which also sees to its alignment.

use zerocopy::{FromBytes, IntoBytes};

use crate::error::ModelError;
use crate::format::{ChannelRecord, ENTRIES_PER_BIT, ENTRY_OFFSET_BITS};
use crate::layout::{Layout, RECORDS, names};
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

/// A checked model. `W` holds the words of the file: a slice on a board, which
/// reads its flash, or `Box<[u32]>` ([`crate::ModelBuf`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Model<W = &'static [u32]> {
    words: W,
    layout: Layout,
}

impl<'a> Model<&'a [u32]> {
    /// Reads a model. `bytes` must be the file and no more, and start on a
    /// four-byte boundary.
    ///
    /// # Errors
    ///
    /// [`ModelError`] with the first thing found wrong: the checks go from the
    /// magic, version and header to the length, the checksum and the content.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ModelError> {
        let layout = Layout::check(bytes)?;
        let words = <[u32]>::ref_from_bytes(bytes).map_err(|_| ModelError::Misaligned)?;
        Ok(Self { words, layout })
    }
}

impl<W: AsRef<[u32]>> Model<W> {
    /// Reads a model from the words of its file.
    ///
    /// # Errors
    ///
    /// As [`Model::parse`].
    pub fn from_words(words: W) -> Result<Self, ModelError> {
        let layout = Layout::check(words.as_ref().as_bytes())?;
        Ok(Self { words, layout })
    }

    /// The same model, borrowed.
    pub fn view(&self) -> Model<&[u32]> {
        Model {
            words: self.words.as_ref(),
            layout: self.layout,
        }
    }

    /// The bytes as they stand in a file.
    pub fn as_bytes(&self) -> &[u8] {
        self.words.as_ref().as_bytes()
    }

    /// Number of classes K, 2 to 32.
    pub const fn classes(&self) -> usize {
        self.layout.classes
    }

    /// Number of channels C, 1 to 24.
    pub const fn channels(&self) -> usize {
        self.layout.channels
    }

    /// Bins a channel B, 1 to 4096.
    pub const fn bins(&self) -> usize {
        self.layout.last_bin + 1
    }

    /// The last bin of a channel.
    #[inline]
    pub(crate) const fn last_bin(&self) -> usize {
        self.layout.last_bin
    }

    /// Samples in a block, 1 to 10000.
    pub const fn block(&self) -> u32 {
        self.layout.block
    }

    /// The quantiser of a channel.
    pub fn quantiser(&self, channel: usize) -> Option<Quantiser> {
        let records = self.part(RECORDS, self.layout.names).as_bytes();
        let records = <[ChannelRecord]>::ref_from_bytes(records).ok()?;
        records.get(channel).map(ChannelRecord::quantiser)
    }

    /// The names of the classes, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        names(self.part(self.layout.names, self.layout.table).as_bytes())
            .take(self.layout.classes)
            .map(|name| core::str::from_utf8(name).unwrap_or(""))
    }

    /// The name of a class.
    pub fn name(&self, class: usize) -> Option<&str> {
        self.names().nth(class)
    }

    /// log2 of the smoothed probability of a bin, −19.93 to 0, to 2⁻¹¹ bit.
    pub fn log2_likelihood(&self, channel: usize, bin: usize, class: usize) -> Option<f32> {
        if channel >= self.channels() || bin >= self.bins() || class >= self.classes() {
            return None;
        }
        let word = *self.row(bin, channel).get(class / 2)?;
        let entry = (word >> (16 * (class % 2))) as u16;
        Some(f32::from(entry) / ENTRIES_PER_BIT as f32 - ENTRY_OFFSET_BITS as f32)
    }

    /// Words of a row of the table, two classes each.
    #[inline]
    pub(crate) const fn row_words(&self) -> usize {
        self.layout.row_words
    }

    /// The words from the row on that says of each class what a channel in a bin
    /// says of it: table entries, two classes a word, the even one in its lower
    /// half. Empty outside the model.
    #[inline]
    pub(crate) fn row(&self, bin: usize, channel: usize) -> &[u32] {
        let row = bin * self.layout.channels + channel;
        let first = self.layout.table + row * self.layout.row_words;
        self.words.as_ref().get(first..).unwrap_or_default()
    }

    #[inline]
    fn part(&self, first: usize, end: usize) -> &[u32] {
        let words = self.words.as_ref();
        words.get(first..end).unwrap_or_default()
    }
}
