//! The checked values of a file, and how they become values of Rust types.

use std::collections::BTreeMap;

use crate::choice::Choice;
use crate::key::Condition;
use crate::section::path;
use crate::value::Value;

#[derive(Default)]
pub(crate) struct Values {
    sections: BTreeMap<&'static str, Given>,
    keys: BTreeMap<(&'static str, &'static str), Entry>,
}

/// A section that is in the file.
#[derive(Clone, Copy)]
pub(crate) struct Given {
    /// Where it begins, as a byte offset.
    pub(crate) offset: usize,
    /// Whether it is a table, so that its keys could be read.
    pub(crate) readable: bool,
}

/// A key that is in the file or has a default.
pub(crate) struct Entry {
    /// Where it stands; `None` for a default.
    pub(crate) offset: Option<usize>,
    /// Its value; `None` when that was refused.
    pub(crate) value: Option<Value>,
}

impl Values {
    /// Adds a section; the first of the same name stays.
    pub(crate) fn add_section(&mut self, section: &'static str, given: Given) {
        self.sections.entry(section).or_insert(given);
    }

    /// Adds a key; the first of the same name stays.
    pub(crate) fn add(&mut self, section: &'static str, key: &'static str, entry: Entry) {
        self.keys.entry((section, key)).or_insert(entry);
    }

    pub(crate) fn override_with(&mut self, others: Self) {
        for (section, given) in others.sections {
            self.add_section(section, given);
        }
        self.keys.extend(others.keys);
    }

    /// Each section and each key that is given, and where.
    pub(crate) fn offsets(&self) -> impl Iterator<Item = (String, usize)> + '_ {
        let sections = self.sections.iter();
        let sections = sections.map(|(name, given)| ((*name).to_owned(), given.offset));
        let keys = self.keys.iter().filter_map(|((section, key), entry)| {
            let path = path(section, key);
            Some((path, entry.offset?))
        });
        sections.chain(keys)
    }

    pub(crate) fn replace(
        &mut self,
        section: &'static str,
        key: &'static str,
        value: Option<Value>,
    ) {
        if let Some(entry) = self.keys.get_mut(&(section, key)) {
            entry.value = value;
        }
    }

    pub(crate) fn section(&self, section: &str) -> Option<Given> {
        self.sections.get(section).copied()
    }

    /// The key's value, given or by default; `None` also when it was refused.
    pub(crate) fn value(&self, section: &'static str, key: &'static str) -> Option<&Value> {
        self.keys.get(&(section, key))?.value.as_ref()
    }

    pub(crate) fn get<T: Read>(&self, section: &'static str, key: &'static str) -> Option<T> {
        self.part(section).get(key)
    }

    /// Where the key stands in the file, whatever its value.
    pub(crate) fn offset(&self, section: &'static str, key: &'static str) -> Option<usize> {
        self.keys.get(&(section, key))?.offset
    }

    /// Whether a condition holds in a section; `None` where a refused value leaves it open.
    pub(crate) fn holds(&self, section: &'static str, condition: Condition) -> Option<bool> {
        match condition {
            Condition::Given(key) => Some(self.offset(section, key).is_some()),
            Condition::IsWithout(key, word, other) => {
                let is_given = self.offset(section, other).is_some();
                self.holds(section, Condition::Is(key, word))
                    .map(|is_word| is_word && !is_given)
            }
            Condition::Is(key, word) => match self.value(section, key)? {
                Value::Text(text) => Some(text == word),
                _ => None,
            },
        }
    }

    pub(crate) fn part(&self, section: &'static str) -> Part<'_> {
        Part {
            values: self,
            section,
        }
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Part<'v> {
    pub(crate) values: &'v Values,
    section: &'static str,
}

impl<'v> Part<'v> {
    pub(crate) fn get<T: Read>(self, key: &'static str) -> Option<T> {
        T::read(self, key)
    }

    fn value(self, key: &'static str) -> Option<&'v Value> {
        self.values.value(self.section, key)
    }
}

pub(crate) trait Read: Sized {
    fn read(from: Part<'_>, key: &'static str) -> Option<Self>;
}

/// Reads a type from one variant of [`Value`].
macro_rules! read {
    ($($type:ty: $variant:ident($value:ident) => $read:expr;)+) => {$(
        impl Read for $type {
            fn read(from: Part<'_>, key: &'static str) -> Option<Self> {
                match from.value(key)? {
                    Value::$variant($value) => $read,
                    _ => None,
                }
            }
        }
    )+};
}

read! {
    bool: Bool(bool) => Some(*bool);
    u8: Integer(n) => Self::try_from(*n).ok();
    u16: Integer(n) => Self::try_from(*n).ok();
    u32: Integer(n) => Self::try_from(*n).ok();
    u64: Integer(n) => Some(*n);
    usize: Integer(n) => Self::try_from(*n).ok();
    f64: Number(x) => Some(*x);
    String: Text(text) => Some(text.clone());
    Vec<f64>: Numbers(list) => Some(list.clone());
    Vec<[f64; 2]>: Pairs(list) => Some(list.clone());
    Vec<(String, f64)>: PerClass(list) => Some(list.clone());
}

impl<T: Choice> Read for T {
    fn read(from: Part<'_>, key: &'static str) -> Option<Self> {
        match from.value(key)? {
            Value::Text(word) => T::of_word(word),
            _ => None,
        }
    }
}

impl<T: Choice> Read for Vec<T> {
    fn read(from: Part<'_>, key: &'static str) -> Option<Self> {
        match from.value(key)? {
            Value::Texts(words) => words.iter().map(|word| T::of_word(word)).collect(),
            _ => None,
        }
    }
}

/// A key that may be left out.
impl<T: Read> Read for Option<T> {
    fn read(from: Part<'_>, key: &'static str) -> Option<Self> {
        Some(T::read(from, key))
    }
}
