//! One value of a scene file, checked against its type and range.

use std::ops::Range as Span;

use tactile::name;
use toml::Spanned;
use toml::de::{DeArray, DeValue};

use crate::kind::{Kind, Range};
use crate::suggest;

/// A value that is in range.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Bool(bool),
    Integer(u64),
    /// Of [`Kind::Number`], or the one number of [`Kind::PerWhisker`].
    Number(f64),
    /// Of [`Kind::Word`], [`Kind::Name`] or [`Kind::Path`].
    Text(String),
    /// Of [`Kind::PerSide`] and [`Kind::PerOwn`], or the list of [`Kind::PerWhisker`].
    Numbers(Vec<f64>),
    Pairs(Vec<[f64; 2]>),
    PerClass(Vec<(String, f64)>),
    /// Of [`Kind::Words`].
    Texts(Vec<String>),
}

/// Why a value, or one entry of a list, was refused.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) span: Span<usize>,
    /// More than the excerpt tells, such as which entry it is; may be empty.
    pub(crate) note: String,
    pub(crate) suggestion: Option<&'static str>,
}

impl Fault {
    fn at(value: &Spanned<DeValue<'_>>) -> Self {
        Self {
            span: value.span(),
            note: String::new(),
            suggestion: None,
        }
    }

    fn with_note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }
}

/// The value, if it is of this kind and in range, else all that is wrong with
/// it (at least one fault).
pub(crate) fn check(kind: &Kind, value: &Spanned<DeValue<'_>>) -> Result<Value, Vec<Fault>> {
    let one = |result: Result<Value, Fault>| result.map_err(|fault| vec![fault]);
    let some = |found: Option<Value>| found.ok_or_else(|| vec![Fault::at(value)]);
    match kind {
        Kind::Bool => some(value.get_ref().as_bool().map(Value::Bool)),
        Kind::Integer { low, high } => {
            let integer = integer(value).filter(|n| (*low..=*high).contains(n));
            some(integer.map(Value::Integer))
        }
        Kind::Number(range) => one(number(*range, value).map(Value::Number)),
        Kind::Word(words) => one(word(words, value).map(|w| Value::Text(w.to_owned()))),
        Kind::Name { longest } => one(text(value, |name| is_name(name, *longest))),
        Kind::Path => one(path(value)),
        Kind::PerWhisker(range) if value.get_ref().as_array().is_none() => {
            one(number(*range, value).map(Value::Number))
        }
        Kind::PerWhisker(range) | Kind::PerSide(range) | Kind::PerOwn(range) => {
            let entries = entries(value)?;
            each(entries, |entry| number(*range, entry)).map(Value::Numbers)
        }
        Kind::PairPerSide(range) => {
            let entries = entries(value)?;
            each(entries, |entry| pair(*range, entry)).map(Value::Pairs)
        }
        Kind::PerClass(range) => per_class(*range, value).map(Value::PerClass),
        Kind::Words(words) => distinct_words(words, value).map(Value::Texts),
    }
}

fn entries<'v, 'i>(value: &'v Spanned<DeValue<'i>>) -> Result<&'v DeArray<'i>, Vec<Fault>> {
    let array = value.get_ref().as_array();
    array.ok_or_else(|| vec![Fault::at(value)])
}

/// All entries checked, or the faults of all that fail.
fn each<T>(
    entries: &DeArray<'_>,
    check: impl Fn(&Spanned<DeValue<'_>>) -> Result<T, Fault>,
) -> Result<Vec<T>, Vec<Fault>> {
    sorted((1..).zip(entries).map(|(n, entry)| {
        let checked = check(entry);
        checked.map_err(|fault| fault.with_note(format!("as entry {n}")))
    }))
}

fn sorted<T>(checked: impl Iterator<Item = Result<T, Fault>>) -> Result<Vec<T>, Vec<Fault>> {
    let (mut good, mut faults) = (Vec::new(), Vec::new());
    for one in checked {
        match one {
            Ok(value) => good.push(value),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() {
        Ok(good)
    } else {
        Err(faults)
    }
}

fn integer(value: &Spanned<DeValue<'_>>) -> Option<u64> {
    let integer = value.get_ref().as_integer()?;
    u64::from_str_radix(integer.as_str(), integer.radix()).ok()
}

fn number(range: Range, value: &Spanned<DeValue<'_>>) -> Result<f64, Fault> {
    let parsed = match value.get_ref() {
        DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
        // Only whole numbers up to the range's ends, all exact in f64, pass on.
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .map(|n| n as f64),
        _ => None,
    };
    parsed
        .filter(|x| x.is_finite() && range.contains(*x))
        // Makes negative zero positive, so that no later division or sign tells them apart.
        .map(|x| x + 0.0)
        .ok_or_else(|| Fault::at(value))
}

fn pair(range: Range, value: &Spanned<DeValue<'_>>) -> Result<[f64; 2], Fault> {
    let array = value.get_ref().as_array();
    let both: Vec<&Spanned<DeValue<'_>>> = array.into_iter().flatten().collect();
    let [first, second] = both.as_slice() else {
        return Err(Fault::at(value));
    };
    Ok([number(range, first)?, number(range, second)?])
}

fn per_class(range: Range, value: &Spanned<DeValue<'_>>) -> Result<Vec<(String, f64)>, Vec<Fault>> {
    let table = value.get_ref().as_table();
    let table = table.filter(|table| !table.is_empty());
    let table = table.ok_or_else(|| vec![Fault::at(value)])?;
    sorted(table.iter().map(|(class, entry)| {
        let class = class.get_ref();
        let number = number(range, entry);
        let number = number.map_err(|fault| fault.with_note(format!("of class {class:?}")))?;
        Ok((class.to_string(), number))
    }))
}

fn word(
    words: &'static [&'static str],
    value: &Spanned<DeValue<'_>>,
) -> Result<&'static str, Fault> {
    let mut fault = Fault::at(value);
    let Some(written) = value.get_ref().as_str() else {
        return Err(fault);
    };
    if let Some(word) = words.iter().find(|word| **word == written) {
        return Ok(word);
    }
    fault.suggestion = suggest::nearest(written, words.iter().copied());
    Err(fault)
}

fn distinct_words(
    words: &'static [&'static str],
    value: &Spanned<DeValue<'_>>,
) -> Result<Vec<String>, Vec<Fault>> {
    let entries = entries(value)?;
    if entries.is_empty() {
        return Err(vec![Fault::at(value)]);
    }
    let found = each(entries, |entry| word(words, entry))?;
    sorted(
        found
            .iter()
            .zip(entries)
            .enumerate()
            .map(|(i, (word, entry))| {
                if found.iter().take(i).any(|before| before == word) {
                    return Err(Fault::at(entry).with_note(format!("again as entry {}", i + 1)));
                }
                Ok((*word).to_owned())
            }),
    )
}

fn text(value: &Spanned<DeValue<'_>>, is_good: impl Fn(&str) -> bool) -> Result<Value, Fault> {
    match value.get_ref().as_str() {
        Some(text) if is_good(text) => Ok(Value::Text(text.to_owned())),
        _ => Err(Fault::at(value)),
    }
}

/// A path, which messages print and tables have.
fn path(value: &Spanned<DeValue<'_>>) -> Result<Value, Fault> {
    let path = text(value, |path| !path.is_empty())?;
    let written = value.get_ref().as_str().unwrap_or_default();
    name::check(written).map_err(|reason| Fault::at(value).with_note(format!("which {reason}")))?;
    Ok(path)
}

/// Whether a name can stand in a file name: short, of plain characters, and not
/// `.`, `..` or the like, which name folders.
fn is_name(name: &str, longest: usize) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    (1..=longest).contains(&name.len())
        && name.chars().all(plain)
        && !name.chars().all(|c| c == '.')
}
