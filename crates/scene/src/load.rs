//! From a file or its text to a scene, or to everything that is wrong with it.

use std::path::Path;

use toml::de::DeTable;

use crate::file;
use crate::overriding::Override;
use crate::places::Places;
use crate::problem::{Problem, Problems};
use crate::sections::{Scene, TOP};
use crate::table::Keys;
use crate::text::Text;
use crate::values::Values;
use crate::{presence, read, rules};

/// How the TOML parser words a key or table that is given twice: the one fault
/// of syntax that leaves the rest of the document as it was meant.
const DUPLICATE: &str = "duplicate key";

impl Scene {
    /// Reads a scene from its text. `file` is what messages call it.
    ///
    /// # Errors
    /// All problems of the text, in the order of its lines. Where the TOML syntax is broken, only
    /// that is reported (once a line): keys read past a broken line might not be what was meant.
    pub fn from_str(file: &str, text: &str) -> Result<Self, Problems> {
        Self::from_str_with(file, text, &[]).map(|(scene, _)| scene)
    }

    /// The same with keys that are given beside the file, of which the last counts, and
    /// where all keys stand.
    ///
    /// # Errors
    /// As [`Scene::from_str`].
    pub fn from_str_with(
        file: &str,
        text: &str,
        overrides: &[Override],
    ) -> Result<(Self, Places), Problems> {
        let mut text = Text::new(file, text, overrides);
        let mut values = Values::default();
        for (n, document) in text.documents().iter().enumerate() {
            let (parsed, faults) = DeTable::parse_recoverable(document);
            if report_syntax(&faults, document.len(), &mut text) {
                return Err(text.into_problems());
            }
            let read = read::read(parsed.get_ref(), &mut text);
            if n == 0 {
                values = read;
            } else {
                values.override_with(read);
            }
        }
        read::add_defaults(&mut values);
        presence::check(&values, &mut text);
        rules::apply(&values, &mut text);
        if !text.is_clean() {
            return Err(text.into_problems());
        }
        presence::settle(&mut values);
        let scene = <Self as Keys>::read(values.part(TOP.name));
        let Some(scene) = scene else {
            // Only a field whose key may be left out leads here: that key must
            // be optional, or the field one of an `Option` of some keys.
            let found = "the catalogue lets a key be left out that a field needs".to_owned();
            text.report(0, "scene".to_owned(), found, String::new());
            return Err(text.into_problems());
        };
        let mut places = Places::new(file, presence::idle(&values));
        for (key, offset) in values.offsets() {
            places.add(key, text.place_in_words(offset));
        }
        Ok((scene, places))
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// A file that cannot be read, named; else as [`Scene::from_str`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Problems> {
        Self::load_with(path, &[]).map(|(scene, _)| scene)
    }

    /// The same with keys that are given beside the file, of which the last counts, and
    /// where all keys stand.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn load_with(
        path: impl AsRef<Path>,
        overrides: &[Override],
    ) -> Result<(Self, Places), Problems> {
        let path = path.as_ref();
        let name = path.display().to_string();
        match file::read_text(path) {
            Ok(text) => Self::from_str_with(&name, &text, overrides),
            Err(error) => {
                let problem = Problem {
                    file: name,
                    line: None,
                    key: String::new(),
                    found: format!("cannot be read: {error}"),
                    allowed: "allowed: a readable scene file in UTF-8".to_owned(),
                };
                Err(Problems::new(vec![problem], 0))
            }
        }
    }
}

/// Reports faults of syntax, one a line; `end`: where its document ends. Returns whether what was
/// read past them might not be what was meant.
fn report_syntax(faults: &[toml::de::Error], end: usize, text: &mut Text<'_>) -> bool {
    let mut last_line = None;
    let mut is_broken = false;
    for fault in faults {
        let is_duplicate = fault.message() == DUPLICATE;
        is_broken |= !is_duplicate;
        let span = fault.span().unwrap_or(end..end);
        let line = text.line(span.start);
        if last_line.replace(line) == Some(line) {
            continue;
        }
        let found = format!("found {}", text.line_at(span.start));
        let (key, allowed) = if is_duplicate {
            (
                text.excerpt(span.clone()),
                "given twice; allowed: once".to_owned(),
            )
        } else {
            ("TOML syntax".to_owned(), fault.message().replace('\n', " "))
        };
        text.report(span.start, key, found, allowed);
    }
    is_broken
}
