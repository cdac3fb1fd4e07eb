//! Sections of a scene file and their lists of keys.

use crate::key::Row;

/// A TOML table of the scene file, or the top of the file (empty name).
#[derive(Clone, Copy)]
pub(crate) struct Section {
    pub(crate) name: &'static str,
    pub(crate) presence: Presence,
    pub(crate) meaning: &'static str,
    pub(crate) entries: &'static [Entry],
}

#[derive(Clone, Copy)]
pub(crate) enum Presence {
    Required,
    Optional {
        /// What leaving it out means.
        without: &'static str,
        /// The section without which this one makes no sense.
        needs: Option<&'static str>,
    },
}

impl Presence {
    /// Leaving it out means `without`.
    pub(crate) const fn optional(without: &'static str) -> Self {
        let needs = None;
        Self::Optional { without, needs }
    }
}

/// A key, or several that one struct holds.
#[derive(Clone, Copy)]
pub(crate) enum Entry {
    Key(Row),
    Keys(&'static [Entry]),
}

impl Section {
    /// Its keys in the order in which they are declared.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &'static Row> + use<> {
        let mut keys = Vec::new();
        collect(self.entries, &mut keys);
        keys.into_iter()
    }

    pub(crate) fn key(&self, name: &str) -> Option<&'static Row> {
        self.keys().find(|key| key.name == name)
    }

    pub(crate) fn path(&self, key: &str) -> String {
        path(self.name, key)
    }

    pub(crate) fn title(&self) -> String {
        if self.name.is_empty() {
            "the top of the file".to_owned()
        } else {
            format!("[{}]", self.name)
        }
    }
}

/// The key as messages name it: with its section, if that has a name.
pub(crate) fn path(section: &str, key: &str) -> String {
    match section {
        "" => key.to_owned(),
        _ => format!("{section}.{key}"),
    }
}

fn collect(entries: &'static [Entry], keys: &mut Vec<&'static Row>) {
    for entry in entries {
        match entry {
            Entry::Key(row) => keys.push(row),
            Entry::Keys(entries) => collect(entries, keys),
        }
    }
}
