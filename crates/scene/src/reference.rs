//! The reference page of scene files, written from the declarations.

use std::fmt::Write;

use crate::key::{Condition, Need, Row};
use crate::section::{Presence, Section};
use crate::sections::sections;

/// A scene that shows most keys; the tests read it.
const EXAMPLE: &str = include_str!("example.toml");

/// The reference page of scene files, in Markdown: every section and key with
/// type, range, unit, default and meaning.
///
/// It is written from the declarations that files are checked against.
pub fn reference() -> String {
    let mut page = String::from(
        "# Scene files\n\n\
         <!-- Generated from crates/scene/src/sections by `cargo xtask docs`; do not edit by hand. -->\n\n\
         One TOML file says what a module is and what happens to it, for the simulator and, by \
         `whisker deploy` or its program, for a board. What a scene does not name is not computed.\n\n\
         An unknown key, a missing one and a value out of range are errors. Whole numbers may \
         stand for real ones; NaN and infinity are refused.\n\n\
         ## Example\n\n```toml\n",
    );
    page.push_str(EXAMPLE);
    page.push_str("```\n");
    for section in sections() {
        add_section(&mut page, section);
    }
    page
}

fn add_section(page: &mut String, section: &Section) {
    let title = match section.name {
        "" => "Top of the file".to_owned(),
        name => format!("`[{name}]`"),
    };
    let presence = match &section.presence {
        Presence::Required => "Required.".to_owned(),
        Presence::Optional { without, needs } => {
            let needs = needs.map(|needed| format!("; needs `[{needed}]`"));
            format!(
                "Optional{}. Left out: {without}.",
                needs.unwrap_or_default()
            )
        }
    };
    // Here and below: writing to a String cannot fail.
    let _ = write!(
        page,
        "\n## {title}\n\n{} {presence}\n\n\
         | key | value | unit | if left out | meaning |\n|---|---|---|---|---|\n",
        section.meaning
    );
    for key in section.keys() {
        let _ = writeln!(
            page,
            "| `{}` | {} | {} | {} | {} |",
            key.name,
            key.kind,
            key.unit,
            left_out(key),
            meaning(key)
        );
    }
}

fn left_out(key: &Row) -> String {
    match &key.need {
        Need::Always => "an error".to_owned(),
        Need::Default(toml) => format!("`{toml}`"),
        Need::When { any: [], without } => (*without).to_owned(),
        Need::When { any, without } => {
            let any: Vec<String> = any.iter().map(|c| in_code(*c)).collect();
            format!("an error if {}; else {without}", any.join(" or "))
        }
    }
}

fn meaning(key: &Row) -> String {
    if key.only.is_empty() {
        return key.meaning.to_owned();
    }
    let only = key.only.iter().map(|condition| match condition {
        Condition::Given(key) => format!("`{key}`"),
        other => in_code(*other),
    });
    let only: Vec<String> = only.collect();
    format!("{} Only with {}.", key.meaning, only.join(" or "))
}

/// The condition with its TOML set as code.
fn in_code(condition: Condition) -> String {
    match condition {
        Condition::Is(..) => format!("`{condition}`"),
        Condition::Given(key) => format!("`{key}` is given"),
        Condition::IsWithout(key, word, other) => {
            format!("`{key} = \"{word}\"` without `{other}`")
        }
    }
}
