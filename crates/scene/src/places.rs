//! Where the keys of a scene stand.

use std::collections::BTreeMap;
use std::fmt::Display;

/// File and line of each key that was given, for messages on what only its user can check,
/// such as whether a model is where the scene says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Places {
    file: String,
    at: BTreeMap<String, String>,
    idle: Vec<(String, String)>,
}

impl Places {
    pub(crate) fn new(file: &str, idle: Vec<(String, String)>) -> Self {
        Self {
            file: file.to_owned(),
            at: BTreeMap::new(),
            idle,
        }
    }

    /// The keys that were given without effect, a line each.
    pub fn idle(&self) -> impl Iterator<Item = String> {
        self.idle.iter().map(|(key, said)| self.fault(key, said))
    }

    /// A key, or a section under its name alone, stands there.
    pub(crate) fn add(&mut self, key: String, place: String) {
        self.at.insert(key, place);
    }

    /// Where the key `key` (`classifier.model`) stands, as `file:line`, or what it was given
    /// by beside the file. Of a key that was left out it is its section.
    pub fn of(&self, key: &str) -> &str {
        let section = key.split_once('.').map_or("", |(section, _)| section);
        let place = self.at.get(key).or_else(|| self.at.get(section));
        place.unwrap_or(&self.file)
    }

    /// What is wrong with the key `key`, as `file:line: key: fault`.
    pub fn fault(&self, key: &str, fault: impl Display) -> String {
        format!("{}: {key}: {fault}", self.of(key))
    }
}
