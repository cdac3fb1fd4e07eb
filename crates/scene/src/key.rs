//! How a key is declared: its type and range, unit, default, and when it is needed.
//!
//! A declaration reads from left to right, such as
//! `number(0.0..=10.0).unit("duty per degree").default("0.05")`. Without
//! [`Key::default`], [`Key::optional`] or [`Key::required_if`] a key must be there.

use std::fmt;
use std::marker::PhantomData;
use std::ops::RangeInclusive;

use crate::choice::Choice;
use crate::kind::{Kind, Range};

#[derive(Clone, Copy)]
pub(crate) struct Row {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    /// Unit of the numbers; empty where there is none.
    pub(crate) unit: &'static str,
    pub(crate) need: Need,
    /// The key is an error unless one of these holds; empty: it never is.
    pub(crate) only: &'static [Condition],
    /// The key has no effect unless one of these holds; empty: it always has.
    pub(crate) used: &'static [Condition],
    pub(crate) meaning: &'static str,
}

/// Whether a key must be there, once its section is.
#[derive(Clone, Copy)]
pub(crate) enum Need {
    Always,
    /// No: this TOML value stands in for it.
    Default(&'static str),
    /// When any of the conditions holds.
    When {
        any: &'static [Condition],
        /// What leaving it out means where none holds.
        without: &'static str,
    },
}

/// Something about another key of the same section.
#[derive(Clone, Copy)]
pub(crate) enum Condition {
    /// The key has this word as its value.
    Is(&'static str, &'static str),
    Given(&'static str),
    /// The key has this word as its value, and another key is not given.
    IsWithout(&'static str, &'static str, &'static str),
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Is(key, word) => write!(f, "{key} = {word:?}"),
            Self::Given(key) => write!(f, "{key} is given"),
            Self::IsWithout(key, word, other) => write!(f, "{key} = {word:?} without {other}"),
        }
    }
}

impl Row {
    pub(crate) fn allowed(&self) -> String {
        if self.unit.is_empty() {
            self.kind.to_string()
        } else {
            format!("{}, in {}", self.kind, self.unit)
        }
    }
}

/// The declaration of a key whose value is a `T`; its field gives it the name,
/// the field's documentation the meaning.
pub(crate) struct Key<T> {
    row: Row,
    value: PhantomData<fn() -> T>,
}

impl<T> Key<T> {
    const fn of(kind: Kind) -> Self {
        let row = Row {
            name: "",
            kind,
            unit: "",
            need: Need::Always,
            only: &[],
            used: &[],
            meaning: "",
        };
        Self::from_row(row)
    }

    const fn from_row(row: Row) -> Self {
        Self {
            row,
            value: PhantomData,
        }
    }

    pub(crate) const fn unit(self, unit: &'static str) -> Self {
        Self::from_row(Row { unit, ..self.row })
    }

    pub(crate) const fn default(self, toml: &'static str) -> Self {
        let need = Need::Default(toml);
        Self::from_row(Row { need, ..self.row })
    }

    pub(crate) const fn optional(self, without: &'static str) -> Key<Option<T>> {
        let need = Need::When { any: &[], without };
        Key::from_row(Row { need, ..self.row })
    }

    /// The key must be there only where a condition holds; elsewhere, leaving
    /// it out means `without`.
    pub(crate) const fn required_if(
        self,
        any: &'static [Condition],
        without: &'static str,
    ) -> Self {
        let need = Need::When { any, without };
        Self::from_row(Row { need, ..self.row })
    }

    pub(crate) const fn only_if(self, only: &'static [Condition]) -> Self {
        Self::from_row(Row { only, ..self.row })
    }

    pub(crate) const fn used_if(self, used: &'static [Condition]) -> Self {
        Self::from_row(Row { used, ..self.row })
    }

    /// Another type reads the same values.
    pub(crate) const fn read_as<U>(self) -> Key<U> {
        Key::from_row(self.row)
    }

    pub(crate) const fn row(self, name: &'static str, meaning: &'static str) -> Row {
        Row {
            name,
            meaning: meaning.trim_ascii(),
            ..self.row
        }
    }
}

pub(crate) const fn yes_or_no() -> Key<bool> {
    Key::of(Kind::Bool)
}

/// A whole number, both ends included.
pub(crate) const fn integer<T: TryFrom<u64>>(ends: RangeInclusive<u64>) -> Key<T> {
    Key::of(Kind::Integer {
        low: *ends.start(),
        high: *ends.end(),
    })
}

/// A real number, both ends included.
pub(crate) const fn number(ends: RangeInclusive<f64>) -> Key<f64> {
    Key::of(Kind::Number(Range::closed(&ends)))
}

/// A real number above 0, up to and including `high`.
pub(crate) const fn positive(high: f64) -> Key<f64> {
    Key::of(Kind::Number(Range::positive(high)))
}

/// A real number strictly between `low` and `high`.
pub(crate) const fn between(low: f64, high: f64) -> Key<f64> {
    Key::of(Kind::Number(Range::open(low, high)))
}

pub(crate) const fn word<T: Choice>() -> Key<T> {
    Key::of(Kind::Word(T::WORDS))
}

/// A list of distinct words of `T`, at least one.
pub(crate) const fn words<T: Choice>() -> Key<Vec<T>> {
    Key::of(Kind::Words(T::WORDS))
}

/// A name that is safe in file names, of at most this many characters.
pub(crate) const fn name(longest: usize) -> Key<String> {
    Key::of(Kind::Name { longest })
}

pub(crate) const fn path() -> Key<String> {
    Key::of(Kind::Path)
}

/// A real number for all whiskers, or a list with one for each.
pub(crate) const fn per_whisker(ends: RangeInclusive<f64>) -> Key<Vec<f64>> {
    Key::of(Kind::PerWhisker(Range::closed(&ends)))
}

pub(crate) const fn per_side(ends: RangeInclusive<f64>) -> Key<Vec<f64>> {
    Key::of(Kind::PerSide(Range::closed(&ends)))
}

/// A list of real numbers, one for each of the scene's own surfaces.
pub(crate) const fn per_own(ends: RangeInclusive<f64>) -> Key<Vec<f64>> {
    Key::of(Kind::PerOwn(Range::closed(&ends)))
}

/// A table of real numbers, one for each of the model's classes that it names.
pub(crate) const fn per_class(range: Range) -> Key<Vec<(String, f64)>> {
    Key::of(Kind::PerClass(range))
}

pub(crate) const fn pair_per_side(ends: RangeInclusive<f64>) -> Key<Vec<[f64; 2]>> {
    Key::of(Kind::PairPerSide(Range::closed(&ends)))
}
