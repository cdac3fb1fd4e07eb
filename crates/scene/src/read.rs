//! From TOML to checked values, key by key as the sections declare them.
//!
//! This stage checks each key alone; [`crate::presence`] and [`crate::rules`]
//! then check keys against each other. A misspelt section or key is reported and
//! then read as the one that was meant, so that one slip causes one message.

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use crate::key::{Need, Row};
use crate::section::Section;
use crate::sections::{TOP, section, sections};
use crate::suggest;
use crate::text::Text;
use crate::value::check;
use crate::values::{Entry, Given, Values};

type Item<'t, 'i> = (&'t Spanned<DeString<'i>>, &'t Spanned<DeValue<'i>>);

/// Reads all sections and keys of a document, noting problems in `text`; no defaults.
pub(crate) fn read(document: &DeTable<'_>, text: &mut Text<'_>) -> Values {
    let mut values = Values::default();
    let top = Given {
        offset: 0,
        readable: true,
    };
    values.add_section(TOP.name, top);
    let tables = sections().map(|s| s.name).filter(|name| !name.is_empty());
    let candidates: Vec<&'static str> = TOP.keys().map(|key| key.name).chain(tables).collect();
    for item in in_file_order(document) {
        let Some(meant) = resolve(&TOP, &candidates, document, item, text) else {
            continue;
        };
        match (section(meant), TOP.key(meant)) {
            (Some(section), _) => read_section(section, item, text, &mut values),
            (None, Some(key)) => read_key(&TOP, key, item, text, &mut values),
            (None, None) => {}
        }
    }
    values
}

fn read_section(
    section: &'static Section,
    (name, value): Item<'_, '_>,
    text: &mut Text<'_>,
    values: &mut Values,
) {
    let offset = name.span().start;
    let table = value.get_ref().as_table();
    let given = Given {
        offset,
        readable: table.is_some(),
    };
    values.add_section(section.name, given);
    let Some(table) = table else {
        let found = format!("found {}", text.excerpt(value.span()));
        let allowed = format!(
            "allowed: a table of keys under the header [{}]",
            section.name
        );
        text.report(offset, section.title(), found, allowed);
        return;
    };
    let candidates: Vec<&'static str> = section.keys().map(|key| key.name).collect();
    for item in in_file_order(table) {
        let Some(meant) = resolve(section, &candidates, table, item, text) else {
            continue;
        };
        if let Some(key) = section.key(meant) {
            read_key(section, key, item, text, values);
        }
    }
}

fn read_key(
    section: &Section,
    key: &'static Row,
    (name, value): Item<'_, '_>,
    text: &mut Text<'_>,
    values: &mut Values,
) {
    let checked = check(&key.kind, value);
    for fault in checked.as_ref().err().into_iter().flatten() {
        let mut found = format!("found {}", text.excerpt(fault.span.clone()));
        if !fault.note.is_empty() {
            found = format!("{found} {}", fault.note);
        }
        let mut allowed = format!("allowed: {}", key.allowed());
        if let Some(word) = fault.suggestion {
            allowed = format!("did you mean {word:?}? {allowed}");
        }
        text.report(fault.span.start, section.path(key.name), found, allowed);
    }
    let entry = Entry {
        offset: Some(name.span().start),
        value: checked.ok(),
    };
    values.add(section.name, key.name, entry);
}

/// Which candidate an item's name means: itself, or after a report the one it
/// is a misspelling of, unless that one is there as well.
fn resolve(
    section: &Section,
    candidates: &[&'static str],
    table: &DeTable<'_>,
    (name, _): Item<'_, '_>,
    text: &mut Text<'_>,
) -> Option<&'static str> {
    let written: &str = name.get_ref();
    if let Some(exact) = candidates.iter().find(|c| **c == written) {
        return Some(exact);
    }
    if text.is_full() {
        text.count();
        return None;
    }
    // A key that another section has stands in the wrong place; so does a table inside a table.
    let homes: Vec<String> = sections()
        .filter(|home| {
            let is_table = home.name.is_empty() && self::section(written).is_some();
            is_table || home.key(written).is_some()
        })
        .map(Section::title)
        .collect();
    let nearest = suggest::nearest(written, candidates.iter().copied());
    let list = candidates.join(", ");
    let (meant, allowed) = match (homes.is_empty(), nearest) {
        (false, _) => (
            None,
            format!("it belongs to {}; allowed here: {list}", homes.join(", ")),
        ),
        (true, Some(word)) => {
            let taken = table.iter().any(|(other, _)| other.get_ref() == word);
            let hint = format!("did you mean `{word}`? allowed here: {list}");
            ((!taken).then_some(word), hint)
        }
        (true, None) => (None, format!("allowed here: {list}")),
    };
    let key = section.path(&text.excerpt(name.span()));
    text.report(name.span().start, key, "unknown key".to_owned(), allowed);
    meant
}

pub(crate) fn add_defaults(values: &mut Values) {
    for section in sections() {
        for key in section.keys() {
            if let Need::Default(toml) = key.need {
                let value = DeValue::parse(toml).ok();
                let value = value.and_then(|value| check(&key.kind, &value).ok());
                let default = Entry {
                    offset: None,
                    value,
                };
                values.add(section.name, key.name, default);
            }
        }
    }
}

fn in_file_order<'t, 'i>(table: &'t DeTable<'i>) -> Vec<Item<'t, 'i>> {
    let mut items: Vec<Item<'t, 'i>> = table.iter().collect();
    items.sort_by_key(|(name, _)| name.span().start);
    items
}
