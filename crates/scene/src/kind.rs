//! Types and ranges of values, as the reader checks them and messages word them.

use std::fmt;
use std::ops::RangeInclusive;

#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Bool,
    Integer { low: u64, high: u64 },
    Number(Range),
    Word(&'static [&'static str]),
    Name { longest: usize },
    Path,
    PerWhisker(Range),
    PerSide(Range),
    PairPerSide(Range),
    PerOwn(Range),
    PerClass(Range),
    Words(&'static [&'static str]),
}

#[derive(Clone, Copy)]
pub(crate) struct Range {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) with_low: bool,
    pub(crate) with_high: bool,
}

impl Range {
    pub(crate) const fn closed(ends: &RangeInclusive<f64>) -> Self {
        Self {
            low: *ends.start(),
            high: *ends.end(),
            with_low: true,
            with_high: true,
        }
    }

    pub(crate) const fn positive(high: f64) -> Self {
        Self {
            with_high: true,
            ..Self::open(0.0, high)
        }
    }

    pub(crate) const fn open(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            with_low: false,
            with_high: false,
        }
    }

    /// NaN never is.
    pub(crate) fn contains(self, x: f64) -> bool {
        let above = x > self.low || (self.with_low && x >= self.low);
        let below = x < self.high || (self.with_high && x <= self.high);
        above && below
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high, .. } = *self;
        match (self.with_low, self.with_high) {
            (true, true) => write!(f, "from {low} to {high}"),
            (false, true) => write!(f, "above {low} and at most {high}"),
            (true, false) => write!(f, "at least {low} and below {high}"),
            (false, false) => write!(f, "above {low} and below {high}"),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool => f.write_str("true or false"),
            Self::Integer { low, high } => write!(f, "a whole number from {low} to {high}"),
            Self::Number(range) => write!(f, "a number {range}"),
            Self::Word(words) => f.write_str(&quoted(words)),
            Self::Name { longest } => write!(
                f,
                "1 to {longest} of the letters A-Z and a-z, the digits, '-', '_' and '.', \
                 not dots alone"
            ),
            Self::Path => f.write_str("a path"),
            Self::PerWhisker(range) => write!(
                f,
                "a number {range}, or a list of such, one a whisker, left side first"
            ),
            Self::PerSide(range) => write!(f, "a list of numbers {range}, one a side, left first"),
            Self::PairPerSide(range) => write!(
                f,
                "a list of pairs of numbers {range}, one pair a side, left first"
            ),
            Self::PerOwn(range) => write!(
                f,
                "a list of numbers {range}, one for each of \"own-1\" to \"own-4\" in `textures`"
            ),
            Self::PerClass(range) => write!(
                f,
                "a table of numbers {range}, each under the name of a class of the model"
            ),
            Self::Words(words) => write!(
                f,
                "a list of at least one of {}, each at most once",
                quoted(words)
            ),
        }
    }
}

fn quoted(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("{word:?}")).collect();
    quoted.join(" or ")
}
