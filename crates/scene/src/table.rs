//! How a table of the file becomes a struct.

use crate::section::{Entry, Presence, Section};
use crate::values::{Part, Values};

/// What [`keys!`](crate::keys::keys) writes: the list of some keys and their reader.
pub(crate) trait Keys {
    type Value;
    const ENTRIES: &'static [Entry];
    /// The tables; only the top of the file has any.
    const TABLES: &'static [Section];
    /// The struct; `None` where a key that it needs has no value.
    fn read(from: Part<'_>) -> Option<Self::Value>;
}

/// The declaration of a table that is read into a `T`; its field gives it the
/// name, the field's documentation the meaning.
pub(crate) struct Table<T> {
    presence: Presence,
    /// The section with which it comes; `None`: it stands for itself.
    with: Option<&'static str>,
    entries: &'static [Entry],
    /// Reads it; the flag says whether it is in the file.
    read: fn(Part<'_>, bool) -> Option<T>,
}

pub(crate) const fn required<K: Keys>() -> Table<K::Value> {
    Table {
        presence: Presence::Required,
        with: None,
        entries: K::ENTRIES,
        read: |from, _| K::read(from),
    }
}

/// A table that may be left out, which means `without`.
pub(crate) const fn optional<K: Keys>(without: &'static str) -> Table<Option<K::Value>> {
    Table {
        presence: Presence::optional(without),
        with: None,
        entries: K::ENTRIES,
        read: |from, is_there| {
            if is_there {
                K::read(from).map(Some)
            } else {
                Some(None)
            }
        },
    }
}

/// A table that may be left out, whose value is then its type's default, which means `without`.
pub(crate) const fn or_default<K: Keys<Value: Default>>(without: &'static str) -> Table<K::Value> {
    Table {
        presence: Presence::optional(without),
        with: None,
        entries: K::ENTRIES,
        read: |from, is_there| {
            if is_there {
                K::read(from)
            } else {
                Some(K::Value::default())
            }
        },
    }
}

/// A table whose keys all have defaults: it is always there. Leaving it out means `without`.
pub(crate) const fn by_default<K: Keys>(without: &'static str) -> Table<K::Value> {
    Table {
        presence: Presence::optional(without),
        ..required::<K>()
    }
}

/// A table whose keys all have defaults: it is there wherever the section
/// `other` is, and an error elsewhere. Leaving it out means `without`.
pub(crate) const fn implied<K: Keys>(
    other: &'static str,
    without: &'static str,
) -> Table<Option<K::Value>> {
    Table {
        with: Some(other),
        ..optional::<K>(without).needs(other)
    }
}

impl<T> Table<T> {
    pub(crate) const fn needs(mut self, section: &'static str) -> Self {
        if let Presence::Optional { needs, .. } = &mut self.presence {
            *needs = Some(section);
        }
        self
    }

    pub(crate) const fn section(&self, name: &'static str, meaning: &'static str) -> Section {
        Section {
            name,
            presence: self.presence,
            meaning: meaning.trim_ascii(),
            entries: self.entries,
        }
    }

    pub(crate) fn read(&self, values: &Values, name: &'static str) -> Option<T> {
        let is_there = values.section(self.with.unwrap_or(name)).is_some();
        (self.read)(values.part(name), is_there)
    }
}
