//! Checking the bytes of a model file, and where in it things lie.

use crate::error::ModelError;
use crate::format::{
    CRC_BYTES, ChannelRecord, Header, MAGIC, MAX_BINS, MAX_BLOCK, MAX_BLOCK_SUM, MAX_CHANNELS,
    MAX_CLASSES, MAX_SAMPLE_AXES, MAX_SAMPLES_TIMES_CHANNELS, MAX_TABLES, NO_LIMIT, OF_ROUGHNESS,
    OF_SAMPLES, ROUGH_CHANNELS, TABLE_WORDS, TableRecord, VERSION, WITHOUT_OPINION, checksum,
    row_words, words,
};
use crate::name;
use crate::opinion::Section;
use crate::quantiser::Quantiser;

/// Counts of a checked model and where its parts begin, in words of four bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layout {
    pub(crate) classes: usize,
    pub(crate) channels: usize,
    pub(crate) row_words: usize,
    pub(crate) block: u32,
    pub(crate) touch: Option<TouchRule>,
    /// The channels' records end and those of the tables of samples begin.
    pub(crate) tables: usize,
    pub(crate) rough_tables: usize,
    /// The tables' records end and the floors begin, if there are any.
    pub(crate) floors: usize,
    pub(crate) names: usize,
    pub(crate) rows: usize,
    pub(crate) opinion: usize,
    /// The opinion ends, and the checksum begins.
    pub(crate) end: usize,
}

/// What a touch means for the evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchRule {
    /// To how much a touch limits what came before, in 1/1024 bit: no class is left
    /// further behind the leader. The surface may have changed in the air.
    pub limit: u32,
    /// Contact π from which a sample counts, 0 to 1.
    pub gate: f32,
    /// Samples without contact after which the next contact is another touch.
    pub gap: u32,
}

/// The word at which the channels' records begin.
pub(crate) const RECORDS: usize = Header::WORDS;

impl Layout {
    /// Of a file that was checked before: looks only at magic, version, length and checksum.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, ModelError> {
        let header = header(bytes)?;
        whole(&header, bytes)?;
        Ok(Self::of(&header, bytes))
    }

    /// Bytes.
    pub(crate) fn length(bytes: &[u8]) -> Result<usize, ModelError> {
        Ok(header(bytes)?.length as usize)
    }

    /// Magic, version and header first, then length, checksum and content.
    pub(crate) fn check(bytes: &[u8]) -> Result<Self, ModelError> {
        let header = header(bytes)?;
        let classes = usize::from(header.classes);
        let channels = usize::from(header.channels);
        let sample_tables = usize::from(header.sample_tables);
        let count = sample_tables + usize::from(header.rough_tables);
        let block = u32::from(header.block);
        check_counts(classes, channels, block)?;
        let opinion_words = header.opinion_words();
        if sample_tables == 0 && opinion_words == 0 || count > MAX_TABLES {
            return Err(ModelError::Tables(count));
        }
        check_touch_rule(&header)?;
        whole(&header, bytes)?;

        let layout = Self::of(&header, bytes);
        let (_, rest) = bytes.split_at(Header::BYTES);
        // Of a header alone the checksum is its own last word.
        let (rest, _) = rest
            .split_last_chunk::<CRC_BYTES>()
            .ok_or(ModelError::Length)?;
        let (records, rest) = rest
            .split_at_checked(channels * ChannelRecord::BYTES)
            .ok_or(ModelError::Length)?;
        check_channels(records)?;
        let (records, rest) = rest
            .split_at_checked(count * TableRecord::BYTES)
            .ok_or(ModelError::Length)?;
        let floor_bytes = match header.floors & 0xff {
            0 => 0,
            1 => classes * size_of::<u32>(),
            _ => return Err(ModelError::Padding),
        };
        if (opinion_words > 0) != (header.version == VERSION) {
            return Err(ModelError::Padding);
        }
        let (rest, opinion) = rest
            .len()
            .checked_sub(opinion_words * size_of::<u32>())
            .and_then(|at| rest.split_at_checked(at))
            .ok_or(ModelError::Length)?;
        check_opinion(opinion, &header)?;
        let (_, rest) = rest
            .split_at_checked(floor_bytes)
            .ok_or(ModelError::Length)?;

        // Counts are checked: at most 2³² words a table.
        let (records, _) = records.as_chunks::<{ TableRecord::BYTES }>();
        let records = records.iter().map(record);
        let row_words = row_words(classes);
        let mut table_words = 0;
        for (n, record) in records.clone().enumerate() {
            let source = [OF_SAMPLES, OF_ROUGHNESS][usize::from(n >= sample_tables)];
            let record = TableRecord(&record);
            check_table_record(record, source, channels)?;
            table_words += rows(record) * row_words as u64;
        }
        let axes = records
            .clone()
            .map(|record| usize::from(TableRecord(&record).axes()));
        let of_samples: usize = axes.clone().take(sample_tables).sum();
        let of_roughness: usize = axes.skip(sample_tables).sum();
        let rough = records.clone().skip(sample_tables);
        let mut rough = rough.flat_map(|record| TableRecord(&record).axis());
        let is_third = rough.any(|axis| usize::from(axis.channel) >= ROUGH_CHANNELS);
        if of_samples > MAX_SAMPLE_AXES || of_roughness > ROUGH_CHANNELS || is_third {
            return Err(ModelError::Axes);
        }
        let table_bytes = usize::try_from(table_words * 4).map_err(|_| ModelError::Length)?;
        let (names, table) = rest
            .len()
            .checked_sub(table_bytes)
            .and_then(|at| rest.split_at_checked(at))
            .ok_or(ModelError::Length)?;
        check_names(names, classes)?;

        // The names are padded to whole words, and all other parts are such.
        let first = layout.opinion - table.len() / size_of::<u32>();
        check_rows(table, first, records, &layout)?;
        Ok(layout)
    }

    fn of(header: &Header, bytes: &[u8]) -> Self {
        let classes = usize::from(header.classes);
        let channels = usize::from(header.channels);
        let tables = RECORDS + channels * ChannelRecord::WORDS;
        let rough_tables = tables + usize::from(header.sample_tables) * TABLE_WORDS;
        let floors = rough_tables + usize::from(header.rough_tables) * TABLE_WORDS;
        let record = bytes.get(size_of::<u32>() * tables..).and_then(words);
        let limit = header.limit;
        let end = (bytes.len() / size_of::<u32>()).saturating_sub(1);
        let opinion = end.saturating_sub(header.opinion_words());
        // Where there is no table, there is none that says where its rows begin.
        let has_tables = floors > tables;
        let first = record.map_or(0, |record| TableRecord(&record).first() as usize);
        Self {
            classes,
            channels,
            row_words: row_words(classes),
            block: header.block.into(),
            touch: (limit != NO_LIMIT).then_some(TouchRule {
                limit,
                gate: header.gate,
                gap: header.gap,
            }),
            tables,
            rough_tables,
            floors,
            names: floors + if header.floors & 1 == 0 { 0 } else { classes },
            rows: if has_tables { first } else { opinion },
            opinion,
            end,
        }
    }

    #[inline]
    pub(crate) const fn has_roughness(&self) -> bool {
        self.floors > self.rough_tables
    }

    #[inline]
    pub(crate) const fn has_floors(&self) -> bool {
        self.names > self.floors
    }
}

/// The opinion can be read, and a model without tables has one that names.
fn check_opinion(bytes: &[u8], header: &Header) -> Result<(), ModelError> {
    if bytes.is_empty() {
        return Ok(());
    }
    let channels = usize::from(header.channels);
    let is_touching = header.limit != NO_LIMIT;
    if channels != ROUGH_CHANNELS || !is_touching {
        return Err(ModelError::Opinion);
    }
    // Where it lies in words: of bytes that may lie anywhere.
    let (chunks, _) = bytes.as_chunks::<4>();
    let word = |at: usize| chunks.get(at).map_or(0, |word| u32::from_le_bytes(*word));
    let head = [word(0)];
    Section::check(&head, chunks.len(), header.classes.into())?;
    let names = Section::new(&head, header.classes.into()).names();
    if names != (header.sample_tables == 0) {
        return Err(ModelError::Opinion);
    }
    Ok(())
}

impl ChannelRecord {
    pub(crate) fn quantiser(&self) -> Quantiser {
        Quantiser {
            origin: self.origin,
            exponent: i32::from(self.exponent),
            low: self.low,
            high: self.high,
        }
    }
}

/// A table's record wherever it lies. A function of its own: four would be unrolled.
#[inline(never)]
fn record(bytes: &[u8; TableRecord::BYTES]) -> [u32; TABLE_WORDS] {
    words(bytes).unwrap_or([0; TABLE_WORDS])
}

fn rows(record: TableRecord<'_>) -> u64 {
    let [a, b] = record.axis().map(|axis| u64::from(axis.last_bin) + 1);
    a * b
}

fn header(bytes: &[u8]) -> Result<Header, ModelError> {
    let (magic, _) = bytes.split_first_chunk::<4>().ok_or(ModelError::TooShort)?;
    if *magic != MAGIC {
        return Err(ModelError::BadMagic);
    }
    let header = Header::of(words(bytes).ok_or(ModelError::TooShort)?);
    match header.version {
        WITHOUT_OPINION..=VERSION => Ok(header),
        other => Err(ModelError::UnknownVersion(other)),
    }
}

/// Whether a file is as long as its header says, and undamaged.
fn whole(header: &Header, bytes: &[u8]) -> Result<(), ModelError> {
    let length = header.length as usize;
    if bytes.len() < length {
        return Err(ModelError::TooShort);
    }
    if bytes.len() > length {
        return Err(ModelError::TrailingBytes);
    }
    let (body, crc) = bytes
        .split_last_chunk::<CRC_BYTES>()
        .ok_or(ModelError::TooShort)?;
    if checksum(body) == u32::from_le_bytes(*crc) {
        Ok(())
    } else {
        Err(ModelError::Checksum)
    }
}

fn check_touch_rule(header: &Header) -> Result<(), ModelError> {
    let gate = header.gate;
    let fits = if header.limit == NO_LIMIT {
        gate.to_bits() == 0 && header.gap == 0
    } else {
        (0.0..=1.0).contains(&gate)
    };
    fits.then_some(()).ok_or(ModelError::TouchRule)
}

pub(crate) fn check_counts(classes: usize, channels: usize, block: u32) -> Result<(), ModelError> {
    if !(2..=MAX_CLASSES).contains(&classes) {
        return Err(ModelError::Classes(classes));
    }
    if !(1..=MAX_CHANNELS).contains(&channels) {
        return Err(ModelError::Channels(channels));
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

pub(crate) fn check_bins(bins: usize) -> Result<(), ModelError> {
    if !(1..=MAX_BINS).contains(&bins) {
        return Err(ModelError::Bins(bins));
    }
    Ok(())
}

fn check_channels(records: &[u8]) -> Result<(), ModelError> {
    let (records, _) = records.as_chunks::<{ ChannelRecord::BYTES }>();
    let records = records.iter().filter_map(|record| words(record));
    for (channel, record) in records.map(ChannelRecord::of).enumerate() {
        record
            .quantiser()
            .check(1)
            .map_err(|reason| ModelError::Quantiser { channel, reason })?;
        if channel > 0 && record.rate_hz != 0 {
            return Err(ModelError::Padding);
        }
    }
    Ok(())
}

fn check_table_record(
    record: TableRecord<'_>,
    source: u8,
    channels: usize,
) -> Result<(), ModelError> {
    let axes = record.axes();
    if record.source() != source || !(1..=2).contains(&axes) || record.reserved() != 0 {
        return Err(ModelError::Padding);
    }
    for (n, axis) in record.axis().iter().enumerate() {
        let channel = usize::from(axis.channel);
        let bins = usize::from(axis.last_bin) + 1;
        check_bins(bins)?;
        if axis.reserved != 0 || channel >= channels {
            return Err(ModelError::Padding);
        }
        let quantiser = Quantiser::of_codes(axis.binner.low(), axis.high);
        let binner = quantiser
            .binner(bins)
            .map_err(|reason| ModelError::Quantiser { channel, reason })?;
        let is_unused = n >= usize::from(axes);
        if binner != axis.binner || is_unused && (bins, channel, axis.high) != (1, 0, 0) {
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
        let text = core::str::from_utf8(name);
        let text = text.map_err(|_| ModelError::NameNotUtf8 { class })?;
        name::check(text).map_err(|reason| ModelError::Name { class, reason })?;
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

/// The rows of all tables: each table's begin where its record says, and no block can
/// sum up to too much.
fn check_rows(
    mut bytes: &[u8],
    mut first: usize,
    records: impl Iterator<Item = [u32; TABLE_WORDS]>,
    layout: &Layout,
) -> Result<(), ModelError> {
    let mut most = 0;
    for record in records {
        let record = TableRecord(&record);
        if record.first() as usize != first {
            return Err(ModelError::Length);
        }
        // The length of all was checked.
        let size = rows(record) as usize * layout.row_words;
        let (entries, rest) = bytes.split_at_checked(4 * size).ok_or(ModelError::Length)?;
        most += u64::from(largest_entry(entries, layout.classes)?);
        (bytes, first) = (rest, first + size);
    }
    if most * u64::from(layout.block) > MAX_BLOCK_SUM {
        return Err(ModelError::TableEntry);
    }
    Ok(())
}

/// The largest entry of a table's rows, which may have nothing in their gaps.
fn largest_entry(bytes: &[u8], classes: usize) -> Result<u16, ModelError> {
    let (entries, _) = bytes.as_chunks::<2>();
    let entry = |bytes: &[u8; 2]| u16::from_le_bytes(*bytes);
    let odd = classes % 2 == 1;
    // At least two classes: said where the compiler sees that no row is empty.
    let mut rows = entries.chunks((2 * row_words(classes)).max(2));
    if odd && rows.any(|row| row.last().is_some_and(|e| entry(e) != 0)) {
        return Err(ModelError::Padding);
    }
    Ok(entries.iter().map(entry).max().unwrap_or(0))
}
