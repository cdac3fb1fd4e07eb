//! A likelihood model read in place: from flash on a board, from memory that it
//! owns on a PC.
//!
//! [`Model::parse`] checks everything once, outside the tick; see `format.rs`
//! for the file. A model linked into a program comes by
//! [`crate::include_model`], which also sees to its alignment.

use crate::error::ModelError;
use crate::format::{AxisRecord, ChannelRecord, ENTRIES_PER_BIT, ENTRY_OFFSET_BITS, TableRecord};
use crate::layout::{Layout, RECORDS, TouchRule, names};
use crate::opinion::{Section, Whisked};
use crate::quantiser::Quantiser;
use crate::words::{JOINT, OPINION, Words};

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
    pub(crate) words: W,
    layout: Layout,
}

impl<'a> Model<&'a [u32]> {
    /// Reads a model. `bytes` must be the file and no more, and start on a
    /// four-byte boundary.
    ///
    /// # Errors
    /// [`ModelError`] with the first thing found wrong: the checks go from the
    /// magic, version and header to the length, the checksum and the content.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ModelError> {
        Self::placed(bytes, Layout::check(bytes)?)
    }

    /// Reads a model that was checked when it was linked into the program: only whether
    /// it is this version and undamaged is looked at. What a wrong content says of the
    /// classes is wrong too, and no more.
    ///
    /// # Errors
    /// As [`Model::parse`], of the magic, version, length and checksum.
    pub fn linked(bytes: &'a [u8]) -> Result<Self, ModelError> {
        Self::placed(bytes, Layout::read(bytes)?)
    }

    /// Reads a model at the beginning of memory that may hold more than it: from a sector of
    /// flash. `bytes` must start on a four-byte boundary.
    ///
    /// # Errors
    /// As [`Model::parse`].
    pub fn at_start(bytes: &'a [u8]) -> Result<Self, ModelError> {
        let length = Layout::length(bytes)?;
        Self::parse(bytes.get(..length).ok_or(ModelError::TooShort)?)
    }

    fn placed(bytes: &'a [u8], layout: Layout) -> Result<Self, ModelError> {
        let words = bytemuck::try_cast_slice(bytes).map_err(|_| ModelError::Misaligned)?;
        Ok(Self { words, layout })
    }
}

impl<W: Words> Model<W> {
    /// Reads a model from the words of its file.
    ///
    /// # Errors
    /// As [`Model::parse`].
    pub fn from_words(words: W) -> Result<Self, ModelError> {
        let layout = Layout::check(bytes(words.as_ref()))?;
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
        bytes(self.words.as_ref())
    }

    /// The checksum at the end of the file: it tells one model from another.
    pub fn crc(&self) -> u32 {
        self.words.as_ref().last().copied().unwrap_or_default()
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
    #[inline]
    pub const fn touch_rule(&self) -> Option<TouchRule> {
        if JOINT { self.layout.touch } else { None }
    }

    #[inline]
    pub(crate) fn opinion(&self) -> Option<Section<'_>> {
        let Layout {
            opinion,
            end,
            classes,
            ..
        } = self.layout;
        if !OPINION || opinion >= end {
            return None;
        }
        Some(Section::new(self.part(opinion, end), classes))
    }

    /// Whether it has a second opinion: what it says of poses of which it was not trained is
    /// held against it.
    pub const fn has_opinion(&self) -> bool {
        self.layout.opinion < self.layout.end
    }

    /// Whether poses are estimated of what is named.
    pub fn has_pose(&self) -> bool {
        self.opinion().is_some_and(Section::has_pose)
    }

    /// How it was whisked in training, where that is known.
    pub fn whisked(&self) -> Whisked {
        self.opinion().map(Section::whisked).unwrap_or_default()
    }

    /// Whether it was trained in so many poses that it names classes between them by itself;
    /// otherwise it is honest in the pose of training, and at most silent elsewhere.
    pub fn names_between_poses(&self) -> bool {
        self.opinion().is_some_and(Section::names)
    }

    /// Poses of training between which a touch may lie: 1 of fewer than three and of more than
    /// twelve, 0 of a model without a second opinion.
    pub fn poses(&self) -> usize {
        self.opinion().map_or(0, Section::poses)
    }

    /// Whether it has roughness, floors or touches, which the papers' models have not.
    pub const fn is_joint(&self) -> bool {
        let layout = &self.layout;
        layout.has_roughness() || layout.has_floors() || layout.touch.is_some()
    }

    /// The scale of a channel's codes, and its range in training.
    pub fn quantiser(&self, channel: usize) -> Option<Quantiser> {
        Some(self.channel(channel)?.quantiser())
    }

    /// The samples a second of training, where they are known.
    pub fn rate_hz(&self) -> Option<u32> {
        let rate_hz = self.channel(0)?.rate_hz;
        (rate_hz > 0).then_some(rate_hz.into())
    }

    fn channel(&self, channel: usize) -> Option<ChannelRecord> {
        let (records, _) = self.part(RECORDS, self.layout.tables).as_chunks();
        records.get(channel).copied().map(ChannelRecord::of)
    }

    /// The floors of a class, if there are any.
    pub fn floors(&self, class: usize) -> Option<Floors> {
        let word = *self.parts().floors().get(class)?;
        Some(Floors {
            samples: word as u16,
            roughness: (word >> 16) as u16,
        })
    }

    #[inline]
    pub(crate) fn parts(&self) -> Parts<'_> {
        Parts::new(self.words.as_ref(), &self.layout)
    }

    /// The names of the classes, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        names(bytes(self.part(self.layout.names, self.layout.rows)))
            .take(self.layout.classes)
            .map(|name| core::str::from_utf8(name).unwrap_or(""))
    }

    /// The name of a class.
    pub fn name(&self, class: usize) -> Option<&str> {
        self.names().nth(class)
    }

    /// Bins of the table of one channel's samples alone, if there is one.
    pub fn bins(&self, channel: usize) -> Option<usize> {
        let axis = self.of_channel(channel)?.first_axis();
        Some(usize::from(axis.last_bin) + 1)
    }

    /// In that table, log2 of the smoothed probability of a bin, −19.93 to 0, to
    /// 2⁻¹¹ bit; of a table with another weight than one not that.
    pub fn log2_likelihood(&self, channel: usize, bin: usize, class: usize) -> Option<f32> {
        if bin >= self.bins(channel)? || class >= self.classes() {
            return None;
        }
        let row = self.parts().row(self.of_channel(channel)?, bin)?;
        let word = *row.get(class / 2)?;
        let entry = (word >> (16 * (class % 2))) as u16;
        Some(f32::from(entry) / ENTRIES_PER_BIT as f32 - ENTRY_OFFSET_BITS as f32)
    }

    fn of_channel(&self, channel: usize) -> Option<TableRecord<'_>> {
        let of_it = |table: &TableRecord<'_>| {
            let axis = table.first_axis();
            table.axes() == 1 && usize::from(axis.channel) == channel
        };
        self.parts().sample_tables().find(of_it)
    }

    #[inline]
    pub(crate) const fn has_roughness(&self) -> bool {
        JOINT && self.layout.has_roughness()
    }

    #[inline]
    pub(crate) const fn has_floors(&self) -> bool {
        JOINT && self.layout.has_floors()
    }

    #[inline]
    fn part(&self, first: usize, end: usize) -> &[u32] {
        self.parts().part(first, end)
    }
}

/// The words of a model and where things lie in them. Not generic, so that the code
/// that reads them is there once, and as small as this crate is built.
#[derive(Clone, Copy)]
pub(crate) struct Parts<'m> {
    words: &'m [u32],
    layout: &'m Layout,
}

impl<'m> Parts<'m> {
    #[inline]
    pub(crate) const fn new(words: &'m [u32], layout: &'m Layout) -> Self {
        Self { words, layout }
    }

    #[inline]
    pub(crate) const fn classes(self) -> usize {
        self.layout.classes
    }

    #[inline]
    pub(crate) const fn block(self) -> u32 {
        self.layout.block
    }

    #[inline]
    pub(crate) fn sample_tables(self) -> impl Iterator<Item = TableRecord<'m>> {
        self.tables(self.layout.tables, self.layout.rough_tables)
    }

    #[inline]
    pub(crate) fn rough_tables(self) -> impl Iterator<Item = TableRecord<'m>> {
        self.tables(self.layout.rough_tables, self.layout.floors)
    }

    /// A word a class; none where there are none.
    #[inline]
    pub(crate) fn floors(self) -> &'m [u32] {
        self.part(self.layout.floors, self.layout.names)
    }

    #[inline]
    fn tables(self, first: usize, end: usize) -> impl Iterator<Item = TableRecord<'m>> {
        let mut records = self.part(first, end);
        core::iter::from_fn(move || {
            let (record, rest) = records.split_first_chunk()?;
            records = rest;
            Some(TableRecord(record))
        })
    }

    /// The row of a table that says of each class what a cell says of it: table entries,
    /// two classes a word, the even one in its lower half. `None` outside the model.
    #[inline]
    pub(crate) fn row(self, table: TableRecord<'_>, cell: usize) -> Option<&'m [u32]> {
        let row_words = self.layout.row_words;
        let first = table.first() as usize + cell * row_words;
        self.words.get(first..)?.get(..row_words)
    }

    #[inline]
    fn part(self, first: usize, end: usize) -> &'m [u32] {
        self.words.get(first..end).unwrap_or_default()
    }
}

/// Of words as they lie in memory: models are little-endian, as all targets are.
fn bytes(words: &[u32]) -> &[u8] {
    bytemuck::try_cast_slice(words).unwrap_or_default()
}

impl TableRecord<'_> {
    #[inline]
    pub(crate) fn cell(self, code: impl Fn(usize) -> Option<i32>) -> Option<usize> {
        let a = self.first_axis();
        let first = a.bin(code(usize::from(a.channel))?);
        if self.axes() == 1 {
            return Some(first);
        }
        let b = self.second_axis();
        let second = b.bin(code(usize::from(b.channel))?);
        Some(first * (usize::from(b.last_bin) + 1) + second)
    }
}

impl AxisRecord {
    #[inline]
    fn bin(&self, code: i32) -> usize {
        self.binner.bin(code, usize::from(self.last_bin))
    }
}
