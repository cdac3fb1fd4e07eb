//! A likelihood model read in place: from flash on a board, from memory that it
//! owns on a PC.
//!
//! [`Model::parse`] checks everything once, outside the tick; see `format.rs`
//! for the file. A model linked into a program comes by
//! [`crate::include_model`], which also sees to its alignment.

use zerocopy::{FromBytes, IntoBytes, transmute_ref};

use crate::error::ModelError;
use crate::format::{
    AxisRecord, ChannelRecord, ENTRIES_PER_BIT, ENTRY_OFFSET_BITS, TABLE_WORDS, TableRecord,
};
use crate::layout::{Layout, RECORDS, TouchRule, names};
use crate::quantiser::Quantiser;
use crate::roughness::Roughness;

/// Bytes on a four-byte boundary, as a model must lie.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(4))]
pub struct Aligned<B: ?Sized>(pub B);

/// The mean entries of a class below which what is felt is none of the classes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Floors {
    /// Of the tables of samples together, a sample.
    pub samples: u16,
    /// Of the tables of roughness together, a block.
    pub roughness: u16,
}

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
#[derive(Debug, Clone, Copy, PartialEq)]
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

    /// Samples in a block, 1 to 10000.
    pub const fn block(&self) -> u32 {
        self.layout.block
    }

    /// What a touch means, if anything.
    pub const fn touch_rule(&self) -> Option<TouchRule> {
        self.layout.touch
    }

    /// The scale of a channel's codes, and its range in training.
    pub fn quantiser(&self, channel: usize) -> Option<Quantiser> {
        let records = self.part(RECORDS, self.layout.tables).as_bytes();
        let records = <[ChannelRecord]>::ref_from_bytes(records).ok()?;
        records.get(channel).map(ChannelRecord::quantiser)
    }

    /// The floors of a class, if there are any.
    pub fn floors(&self, class: usize) -> Option<Floors> {
        let word = *self.all_floors().get(class)?;
        Some(Floors {
            samples: word as u16,
            roughness: (word >> 16) as u16,
        })
    }

    /// The floors of the classes, a word each; none where there are none.
    #[inline]
    pub(crate) fn all_floors(&self) -> &[u32] {
        self.part(self.layout.floors, self.layout.names)
    }

    /// What is kept of the channels of roughness, before the first sample.
    pub(crate) fn roughness(&self) -> Roughness {
        Roughness::of(self.rough_tables().flat_map(TableRecord::channels))
    }

    /// The names of the classes, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        names(self.part(self.layout.names, self.layout.rows).as_bytes())
            .take(self.layout.classes)
            .map(|name| core::str::from_utf8(name).unwrap_or(""))
    }

    /// The name of a class.
    pub fn name(&self, class: usize) -> Option<&str> {
        self.names().nth(class)
    }

    /// Bins of the table of one channel's samples alone, if there is one.
    pub fn bins(&self, channel: usize) -> Option<usize> {
        Some(usize::from(self.single(channel)?.axis[0].last_bin) + 1)
    }

    /// In that table, log2 of the smoothed probability of a bin, −19.93 to 0, to
    /// 2⁻¹¹ bit; of a table with another weight than one not that.
    pub fn log2_likelihood(&self, channel: usize, bin: usize, class: usize) -> Option<f32> {
        if bin >= self.bins(channel)? || class >= self.classes() {
            return None;
        }
        let word = *self.row(self.single(channel)?, bin).get(class / 2)?;
        let entry = (word >> (16 * (class % 2))) as u16;
        Some(f32::from(entry) / ENTRIES_PER_BIT as f32 - ENTRY_OFFSET_BITS as f32)
    }

    fn single(&self, channel: usize) -> Option<&TableRecord> {
        let of_it = |r: &&TableRecord| r.axes == 1 && usize::from(r.axis[0].channel) == channel;
        self.sample_tables().find(of_it)
    }

    /// The tables that are looked up each sample.
    #[inline]
    pub(crate) fn sample_tables(&self) -> impl Iterator<Item = &TableRecord> {
        self.tables(self.layout.tables, self.layout.rough_tables)
    }

    /// The tables that are looked up once a block.
    #[inline]
    pub(crate) fn rough_tables(&self) -> impl Iterator<Item = &TableRecord> {
        self.tables(self.layout.rough_tables, self.layout.floors)
    }

    /// Whether there are any.
    #[inline]
    pub(crate) const fn has_roughness(&self) -> bool {
        self.layout.floors > self.layout.rough_tables
    }

    /// Whether classes have floors.
    #[inline]
    pub(crate) const fn has_floors(&self) -> bool {
        self.layout.names > self.layout.floors
    }

    /// Words of a row of a table, two classes each.
    #[inline]
    pub(crate) const fn row_words(&self) -> usize {
        self.layout.row_words
    }

    #[inline]
    fn tables(&self, first: usize, end: usize) -> impl Iterator<Item = &TableRecord> {
        let mut at = first;
        core::iter::from_fn(move || {
            let words = self
                .words
                .as_ref()
                .get(at..end)?
                .first_chunk::<TABLE_WORDS>()?;
            at += TABLE_WORDS;
            Some(transmute_ref!(words))
        })
    }

    /// The words from a row of a table on that says of each class what its cell says
    /// of it: table entries, two classes a word, the even one in its lower half.
    /// Empty outside the model.
    #[inline]
    pub(crate) fn row(&self, table: &TableRecord, cell: usize) -> &[u32] {
        self.words_from(table.first as usize + cell * self.layout.row_words)
    }

    /// The words from one on.
    #[inline]
    pub(crate) fn words_from(&self, first: usize) -> &[u32] {
        self.words.as_ref().get(first..).unwrap_or_default()
    }

    #[inline]
    fn part(&self, first: usize, end: usize) -> &[u32] {
        let words = self.words.as_ref();
        words.get(first..end).unwrap_or_default()
    }
}

impl TableRecord {
    /// The channels of its axes.
    #[inline]
    fn channels(&self) -> impl Iterator<Item = u8> {
        let axes = self.axis.iter().take(usize::from(self.axes));
        axes.map(|axis| axis.channel)
    }

    /// The cell of the values `code` gives for an axis's place, 0 or 1, and channel.
    #[inline]
    pub(crate) fn cell(&self, code: impl Fn(usize, usize) -> i32) -> usize {
        let [a, b] = &self.axis;
        let first = a.bin(code(0, usize::from(a.channel)));
        if self.axes == 1 {
            return first;
        }
        let second = b.bin(code(1, usize::from(b.channel)));
        first * (usize::from(b.last_bin) + 1) + second
    }
}

impl AxisRecord {
    #[inline]
    fn bin(&self, code: i32) -> usize {
        self.binner.bin(code, usize::from(self.last_bin))
    }
}
