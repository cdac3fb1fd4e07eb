//! The step that all rules share: look up each channel's log-likelihoods and
//! add them to the sums of the open block.
//!
//! Two classes share a word. A word's halves add without carry for up to three
//! channels (entries are at most 20480), and two words a pair collect the
//! block: A = Σ w modulo 2³², B = Σ (w >> 16). At the end of the block B is
//! the sum of the upper class and A − 2¹⁶ B that of the lower, both exact.
//! That is two additions a pair and no unpacking.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::error::SetupError;
use crate::model::Model;
use crate::quantiser::{Binner, Quantiser};

/// Whether the target multiplies 32 bits by 32 to 64 in one instruction. Of the
/// Arm cores those without (ARMv6-M: Cortex-M0 and M0+) are those without
/// atomic read-modify-write.
const LONG_MULTIPLY: bool = cfg!(any(not(target_arch = "arm"), target_has_atomic = "32"));

/// Channels whose entries add in half a word without a carry: 3 · 20480 < 2¹⁶.
const CHANNELS_PER_ADD: usize = 3;

/// A number of classes as a type, to name the width of its table rows.
#[derive(Debug, Clone, Copy)]
pub struct Classes<const K: usize>;

/// Implemented for [`Classes`] of 2 to 32.
pub trait Supported: sealed::Sealed {
    /// A row of the table: two classes a word, a zero after an odd count.
    type Row: core::fmt::Debug + FromBytes + KnownLayout + Immutable + AsRef<[u32]> + Sync + 'static;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! supported {
    ($($k:literal)*) => {$(
        impl sealed::Sealed for Classes<$k> {}
        impl Supported for Classes<$k> {
            type Row = [u32; crate::format::row_words($k)];
        }
    )*};
}
supported!(2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32);

/// One row: what a channel in one bin says of each class.
pub(crate) type Row<const K: usize> = <Classes<K> as Supported>::Row;

/// Sums of the log-likelihoods of the open block, packed as above: A and B of
/// the first pair of classes, then of the next; K words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sums<const K: usize>([u32; K]);

impl<const K: usize> Default for Sums<K> {
    fn default() -> Self {
        Self([0; K])
    }
}

impl<const K: usize> Sums<K> {
    /// Adds up to [`CHANNELS_PER_ADD`] rows at once.
    #[inline]
    pub(crate) fn add<R: AsRef<[u32]>, const N: usize>(&mut self, rows: [&R; N]) {
        let (pairs, last) = self.0.as_chunks_mut::<2>();
        for (i, [a, b]) in pairs.iter_mut().enumerate() {
            let word = word(&rows, i);
            *a = a.wrapping_add(word);
            *b = b.wrapping_add(word >> 16);
        }
        if let [a] = last {
            *a = a.wrapping_add(word(&rows, K / 2));
        }
    }

    /// The sum of each class, and starts the next block at zero.
    #[inline]
    pub fn take(&mut self) -> [u32; K] {
        // A zero the compiler cannot see: stores in line are cheaper than
        // the call of memset that it would make of them.
        let zero = core::hint::black_box(0);
        let mut totals = core::mem::replace(&mut self.0, [zero; K]);
        for [a, b] in totals.as_chunks_mut::<2>().0 {
            *a = a.wrapping_sub(*b << 16);
        }
        totals
    }
}

/// Word `i` of the sum of up to [`CHANNELS_PER_ADD`] rows.
#[inline]
fn word<R: AsRef<[u32]>>(rows: &[&R], i: usize) -> u32 {
    rows.iter()
        .filter_map(|row| row.as_ref().get(i))
        .fold(0, |sum: u32, &word| sum.wrapping_add(word))
}

/// A model's quantisers and table as a classifier of C channels and K classes
/// uses them; it borrows the table where the model lies.
#[derive(Debug)]
pub struct Likelihoods<'m, const C: usize, const K: usize>
where
    Classes<K>: Supported,
{
    binners: [Binner; C],
    table: &'m [[Row<K>; C]],
    // For values above and below the range.
    edges: [&'m [Row<K>; C]; 2],
}

impl<'m, const C: usize, const K: usize> Likelihoods<'m, C, K>
where
    Classes<K>: Supported,
{
    /// Views a model as this shape.
    ///
    /// # Errors
    ///
    /// [`SetupError::Channels`] or [`SetupError::Classes`] where it has another.
    pub fn new(model: &Model<'m>) -> Result<Self, SetupError> {
        if model.channels() != C {
            return Err(SetupError::Channels {
                model: model.channels(),
                classifier: C,
            });
        }
        let table = rows::<[Row<K>; C], K>(model)?;
        let [first, .., last] = table else {
            // One bin only, which is both edges; or none, which cannot be.
            let only = table.first().ok_or(SetupError::Table)?;
            return Self::with(model, table, only, only);
        };
        Self::with(model, table, first, last)
    }

    fn with(
        model: &Model<'m>,
        table: &'m [[Row<K>; C]],
        first: &'m [Row<K>; C],
        last: &'m [Row<K>; C],
    ) -> Result<Self, SetupError> {
        let quantisers: [Option<Quantiser>; C] = core::array::from_fn(|c| model.quantiser(c));
        let mut binners = [Binner::default(); C];
        for (binner, quantiser) in binners.iter_mut().zip(quantisers) {
            *binner = quantiser
                .and_then(|q| q.binner(model.bins()).ok())
                .ok_or(SetupError::Table)?;
        }
        Ok(Self {
            binners,
            table,
            edges: [last, first],
        })
    }

    /// Adds one sample of all channels.
    #[inline]
    pub fn add(&self, codes: &[i32; C], sums: &mut Sums<K>) {
        if C <= CHANNELS_PER_ADD {
            return sums.add(self.rows(0, codes));
        }
        let (groups, rest) = codes.as_chunks::<CHANNELS_PER_ADD>();
        for (g, codes) in groups.iter().enumerate() {
            sums.add(self.rows(g * CHANNELS_PER_ADD, codes));
        }
        let first = groups.len() * CHANNELS_PER_ADD;
        for (i, &code) in rest.iter().enumerate() {
            sums.add(self.rows(first + i, &[code]));
        }
    }

    /// The rows of some channels, from `first` on. All bins are found before
    /// the first row: the two need different registers.
    #[inline]
    fn rows<const N: usize>(&self, first: usize, codes: &[i32; N]) -> [&'m Row<K>; N] {
        let bins: [i32; N] = core::array::from_fn(|i| {
            let binner = &self.binners[first + i];
            if LONG_MULTIPLY {
                binner.bin_unclamped(codes[i])
            } else {
                binner.bin_by_halves(codes[i])
            }
        });
        core::array::from_fn(|i| {
            // A negative bin turns into a huge index, so that one comparison
            // finds both edges and values inside the range pay for nothing else.
            let rows = self.table.get(bins[i] as u32 as usize);
            &rows.unwrap_or_else(|| self.edge(bins[i] < 0))[first + i]
        })
    }

    #[cold]
    fn edge(&self, below: bool) -> &'m [Row<K>; C] {
        self.edges[usize::from(below)]
    }
}

/// The model's table as rows of type R, where R holds words of K classes.
pub(crate) fn rows<'m, R, const K: usize>(model: &Model<'m>) -> Result<&'m [R], SetupError>
where
    R: FromBytes + KnownLayout + Immutable,
{
    if model.classes() != K {
        return Err(SetupError::Classes {
            model: model.classes(),
            classifier: K,
        });
    }
    <[R]>::ref_from_bytes(model.table().as_bytes()).map_err(|_| SetupError::Table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::{ENTRY_MAX, MAX_SAMPLES_TIMES_CHANNELS};

    fn pack(even: u16, odd: u16) -> u32 {
        u32::from(even) | (u32::from(odd) << 16)
    }

    #[test]
    fn packed_sums_are_exact_at_the_limit() {
        let mut sums = Sums::<5>::default();
        let row = [pack(ENTRY_MAX, ENTRY_MAX), pack(0, ENTRY_MAX), pack(3, 0)];
        for _ in 0..MAX_SAMPLES_TIMES_CHANNELS / 3 {
            sums.add([&row; 3]);
        }
        let full = MAX_SAMPLES_TIMES_CHANNELS * u32::from(ENTRY_MAX);
        let few = MAX_SAMPLES_TIMES_CHANNELS * 3;
        assert_eq!(sums.take(), [full, full, 0, full, few]);
        assert_eq!(sums.take(), [0; 5]);
    }

    #[test]
    fn any_number_of_rows_adds_up() {
        let row = [pack(1, 20_000), pack(20_480, 7)];
        let mut sums = Sums::<4>::default();
        sums.add([&row; 3]);
        sums.add([&row; 2]);
        sums.add([&row; 1]);
        assert_eq!(sums.take(), [6, 120_000, 122_880, 42]);
    }
}
