//! The variants: widths of entries and deficits, and ways to 2^−x, with the
//! bytes that each would need on a module.

use std::f32::consts::LN_2;

use micromath::F32Ext;
use tactile::{ENTRIES_PER_BIT, ENTRY_OFFSET_BITS, Scale};

use super::data::CHANNELS;

/// Entries of the table: round((log2 p + 20) · units), from zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Entry {
    /// So many bits, with as many whole units a bit of likelihood as fit.
    Full(u32),
    /// The product's: in 16 bits, but below 2¹⁶/3, so that three channels add
    /// in half a word.
    Product,
}

/// What a deficit is held in. The leader's is zero after every block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Deficit {
    /// Units of 2⁻¹¹ bit, to 32 bit: the block mean is rounded to them.
    Bits16,
    /// Units of the table over the block, exact, to 2²⁹: the product's.
    Bits32,
    /// The same to 2⁶¹.
    Bits64,
}

/// How 2^−x is had.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Exponential {
    /// In f64, to the last bits.
    Exact,
    /// The product's: 128 straight lines, 26 bits.
    Lines128,
    /// 16 straight lines between the entries of a table, 26 bits.
    Lines16,
    /// `micromath` in f32.
    Micromath,
    /// One shifted by the whole part of x.
    Shift,
}

/// One choice of the three.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Variant {
    pub(super) entry: Entry,
    pub(super) deficit: Deficit,
    pub(super) exponential: Exponential,
}

impl Entry {
    pub(super) const ALL: [Self; 4] =
        [Self::Full(8), Self::Full(12), Self::Full(16), Self::Product];

    /// Bits of an entry.
    pub(super) const fn bits(self) -> u32 {
        match self {
            Self::Full(bits) => bits,
            Self::Product => 16,
        }
    }

    /// Units in a bit of likelihood.
    pub(super) const fn per_bit(self) -> u32 {
        match self {
            Self::Full(bits) => ((1 << bits) - 1) / ENTRY_OFFSET_BITS,
            Self::Product => ENTRIES_PER_BIT,
        }
    }

    /// The entry of a likelihood.
    pub(super) fn of(self, p: f64) -> i64 {
        let units = f64::from(self.per_bit());
        let most = i64::from(ENTRY_OFFSET_BITS * self.per_bit());
        let entry = ((p.log2() + f64::from(ENTRY_OFFSET_BITS)) * units).round();
        (entry as i64).clamp(0, most)
    }
}

impl Deficit {
    pub(super) const ALL: [Self; 3] = [Self::Bits16, Self::Bits32, Self::Bits64];

    /// Units of 2⁻¹¹ bit.
    const PER_BIT_16: i64 = 2048;

    pub(super) const fn bits(self) -> u32 {
        match self {
            Self::Bits16 => 16,
            Self::Bits32 => 32,
            Self::Bits64 => 64,
        }
    }

    /// How many bit [`Self::Bits16`] tells apart.
    pub(super) const fn range_bit_16() -> f64 {
        Self::Bits16.most() as f64 / Self::PER_BIT_16 as f64
    }

    /// The largest that is told apart.
    pub(super) const fn most(self) -> i64 {
        match self {
            Self::Bits16 => (1 << 16) - 1,
            Self::Bits32 => (1 << 29) - 1,
            Self::Bits64 => 1 << 61,
        }
    }
}

impl Exponential {
    pub(super) const ALL: [Self; 5] = [
        Self::Exact,
        Self::Lines128,
        Self::Lines16,
        Self::Micromath,
        Self::Shift,
    ];

    /// Bytes of its table.
    pub(super) const fn bytes(self) -> usize {
        match self {
            Self::Lines128 => 512,
            Self::Lines16 => 64,
            Self::Exact | Self::Micromath | Self::Shift => 0,
        }
    }

    /// What it is, in a table.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Exact => "f64",
            Self::Lines128 => "128 lines",
            Self::Lines16 => "16 lines",
            Self::Micromath => "micromath",
            Self::Shift => "shift",
        }
    }

    /// Largest error of 2^−x, relative, for x from 0 to 2.
    pub(super) fn error(self) -> f64 {
        let grid = (0..1 << 13).map(|n| f64::from(n) / f64::from(1 << 12));
        let errors = grid.map(|x| (self.term(x) * x.exp2() - 1.0).abs());
        errors.fold(0.0, f64::max)
    }

    /// 2^−x, x not negative, in its own arithmetic.
    pub(super) fn term(self, x: f64) -> f64 {
        /// Fraction bits of x where it is an integer.
        const X: u32 = 20;
        /// One, as an integer result.
        const ONE: f64 = (1 << 26) as f64;
        // `as` saturates, at 4096 bit.
        let integer = (x * f64::from(1 << X)).round() as u32;
        match self {
            Self::Exact => (-x).exp2(),
            Self::Lines128 => {
                // The product's function is reached by the posterior of one
                // rival, t/(1 + t): 2³² is fine enough to have t back exactly.
                let units = Scale::per_samples((1 << X) / ENTRIES_PER_BIT);
                let [leader, rival] = units.posteriors(&[0, integer]).map(f64::from);
                (rival / leader * ONE).round() / ONE
            }
            Self::Lines16 => {
                let (whole, cell) = (integer >> X, (integer >> (X - 4)) % 16);
                let entry = |i: u32| ((-f64::from(i) / 16.0).exp2() * ONE).round() as u32;
                let start = entry(cell);
                let fall = u64::from(start - entry(cell + 1));
                let part = u64::from(integer % (1 << (X - 4)));
                // Below `fall`, so below 2²⁶.
                let value = start - ((fall * part) >> (X - 4)) as u32;
                f64::from(value.checked_shr(whole).unwrap_or(0)) / ONE
            }
            Self::Micromath => f64::from(F32Ext::exp(-(x as f32) * LN_2)),
            Self::Shift => {
                let one = ONE as u32;
                f64::from(one.checked_shr(integer >> X).unwrap_or(0)) / ONE
            }
        }
    }

    /// Odds against the leader, of deficits in bit, for the comparison with
    /// `limit`: terms are lifted by as many bits as `limit` lies below a
    /// quarter, so that small ones keep their precision. A term that the lift
    /// takes beyond one stays at one, which is above the limit then.
    pub(super) fn odds(self, deficits: impl Iterator<Item = f64>, limit: f64) -> f64 {
        // Thresholds end at 1 − 1e-12, 38 bits below a quarter.
        let lift = (-2.0 - limit.log2()).ceil().clamp(0.0, 38.0);
        let terms = deficits.map(|x| self.term((x - lift).max(0.0)));
        terms.sum::<f64>() * (-lift).exp2()
    }
}

impl Variant {
    /// What the product is, as a variant.
    pub(super) const PRODUCT: Self = Self {
        entry: Entry::Product,
        deficit: Deficit::Bits32,
        exponential: Exponential::Lines128,
    };

    /// All combinations.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        Entry::ALL.into_iter().flat_map(|entry| {
            Deficit::ALL.into_iter().flat_map(move |deficit| {
                Exponential::ALL.into_iter().map(move |exponential| Self {
                    entry,
                    deficit,
                    exponential,
                })
            })
        })
    }

    /// Bytes of constants: likelihoods packed without gaps (the product pads
    /// an odd number of classes to a word), and the exponential's table.
    pub(super) fn constant_bytes(self, bins: usize, classes: usize) -> usize {
        let padded = match self.entry {
            Entry::Full(_) => classes,
            Entry::Product => classes.next_multiple_of(2),
        };
        let bits = bins * CHANNELS * padded * self.entry.bits() as usize;
        bits.div_ceil(8) + self.exponential.bytes()
    }

    /// Bytes that change: the open block's sums in half a word where they fit
    /// one, deficits, and two counters of a word.
    pub(super) fn state_bytes(self, block: u32, classes: usize) -> usize {
        let largest = block * CHANNELS as u32 * ENTRY_OFFSET_BITS * self.entry.per_bit();
        let sum = if largest < 1 << 16 { 2 } else { 4 };
        classes * (sum + self.deficit.bits() as usize / 8) + 8
    }

    /// Units of a deficit in a bit of evidence.
    pub(super) fn per_bit(self, block: u32) -> i64 {
        match self.deficit {
            Deficit::Bits16 => Deficit::PER_BIT_16,
            Deficit::Bits32 | Deficit::Bits64 => self.exact_per_bit(block),
        }
    }

    /// The same without a loss: units of the table over the block.
    pub(super) fn exact_per_bit(self, block: u32) -> i64 {
        i64::from(self.entry.per_bit()) * i64::from(block)
    }
}
