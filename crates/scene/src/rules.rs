//! What keys ask of each other: presence, list lengths, and order of limits.
//!
//! A rule that turns on a value that was itself refused is left alone: that
//! value's own message comes first.

use crate::catalogue::SECTIONS;
use crate::read::{Given, Values};
use crate::spec::{Condition, Key, Kind, Need, Presence, Section};
use crate::text::Text;
use crate::types::{PlantKind, Sides};
use crate::value::Value;

/// Applies all rules, noting problems in `text`.
pub(crate) fn apply(values: &Values, text: &mut Text<'_>) {
    for section in SECTIONS {
        match values.section(section.name) {
            Some(given) => {
                needed_section(section, given, values, text);
                if given.readable {
                    for key in section.keys {
                        presence(section, given, key, values, text);
                        length(section, key, values, text);
                    }
                }
            }
            None => absent_section(section, text),
        }
    }
    at_least_one_tick("", "duration_s", values, text);
    at_least_one_tick("plant", "present_s", values, text);
    limits_in_order(values, text);
    textured_is_active(values, text);
    shaft_is_slender(values, text);
}

fn absent_section(section: &Section, text: &mut Text<'_>) {
    if matches!(section.presence, Presence::Required) {
        let keys: Vec<&str> = section.keys.iter().map(|key| key.name).collect();
        let required = format!("required: a table with the keys {}", keys.join(", "));
        text.report(0, section.title(), "missing".to_owned(), required);
    }
}

fn needed_section(section: &Section, given: Given, values: &Values, text: &mut Text<'_>) {
    let Presence::Optional {
        needs: Some(needed),
        ..
    } = section.presence
    else {
        return;
    };
    if values.section(needed).is_none() {
        let found = format!("found without [{needed}]");
        let allowed = format!(
            "[{}] acts on whisking: add [{needed}], or leave [{}] out",
            section.name, section.name
        );
        text.report(given.offset, section.title(), found, allowed);
    }
}

fn presence(section: &Section, given: Given, key: &Key, values: &Values, text: &mut Text<'_>) {
    let holds = |condition: Condition| holds(section, condition, values);
    let path = section.path(key.name);
    if let Some(offset) = values.offset(section.name, key.name) {
        let barred = key.only.iter().all(|c| holds(*c) == Some(false));
        if barred && !key.only.is_empty() {
            let found = "found, but not used here".to_owned();
            let only: Vec<String> = key.only.iter().map(ToString::to_string).collect();
            let allowed = format!("allowed only where {}", only.join(" or "));
            text.report(offset, path, found, allowed);
        }
        return;
    }
    let reason = match &key.need {
        Need::Always => String::new(),
        Need::Default(_) => return,
        Need::When { any, .. } => match any.iter().find(|c| holds(**c) == Some(true)) {
            Some(condition) => format!(" because {condition}"),
            None => return,
        },
    };
    let required = format!("required{reason}: {}", key.allowed());
    text.report(given.offset, path, "missing".to_owned(), required);
}

/// Whether a condition holds; `None` where a refused value leaves it open.
fn holds(section: &Section, condition: Condition, values: &Values) -> Option<bool> {
    match condition {
        Condition::Given(key) => Some(values.offset(section.name, key).is_some()),
        Condition::Is(key, word) => match values.get(section.name, key)? {
            Value::Text(text) => Some(text == word),
            _ => None,
        },
    }
}

/// Checks the length of a list that has one entry a whisker or a side.
fn length(section: &Section, key: &Key, values: &Values, text: &mut Text<'_>) {
    let Some((sides, whiskers)) = head(values) else {
        return;
    };
    let sides_in_words = if sides == 1 { "1 side" } else { "2 sides" };
    let (wanted, why) = match &key.kind {
        Kind::PerSide(_) | Kind::PairPerSide(_) => {
            (Some(sides), format!("the head has {sides_in_words}"))
        }
        Kind::PerWhisker(_) => (
            whiskers.map(|n| n * sides),
            format!("the head has {sides_in_words} of {}", whiskers.unwrap_or(0)),
        ),
        _ => return,
    };
    let entries = match values.get(section.name, key.name) {
        Some(Value::Numbers(list)) => list.len(),
        Some(Value::Pairs(list)) => list.len(),
        _ => return,
    };
    let Some(wanted) = wanted.filter(|wanted| *wanted != entries) else {
        return;
    };
    let plural = |n: usize| if n == 1 { "entry" } else { "entries" };
    let offset = values.offset(section.name, key.name).unwrap_or(0);
    let found = format!("found {entries} {}", plural(entries));
    let allowed = format!("allowed: exactly {wanted} {}, as {why}", plural(wanted));
    text.report(offset, section.path(key.name), found, allowed);
}

/// Sides of the head, and whiskers on each, as far as they could be read.
fn head(values: &Values) -> Option<(usize, Option<usize>)> {
    values.section("head").filter(|head| head.readable)?;
    let Value::Text(sides) = values.get("head", "sides")? else {
        return None;
    };
    let sides = Sides::from_name(sides)?.count();
    let whiskers = match values.get("head", "whiskers_per_side") {
        Some(Value::Integer(n)) => usize::try_from(*n).ok(),
        _ => None,
    };
    Some((sides, whiskers))
}

fn at_least_one_tick(
    section: &'static str,
    key: &'static str,
    values: &Values,
    text: &mut Text<'_>,
) {
    let (Some(Value::Number(seconds)), Some(Value::Integer(tick_hz)), Some(offset)) = (
        values.get(section, key),
        values.get("", "tick_hz"),
        values.offset(section, key),
    ) else {
        return;
    };
    if seconds * (*tick_hz as f64) < 1.0 {
        let path = match section {
            "" => key.to_owned(),
            _ => format!("{section}.{key}"),
        };
        let allowed = format!("allowed: at least one tick, that is 1/{tick_hz} s");
        text.report(offset, path, format!("found {seconds} s"), allowed);
    }
}

fn limits_in_order(values: &Values, text: &mut Text<'_>) {
    let number = |key| match values.get("motor", key) {
        Some(Value::Number(x)) => Some(*x),
        _ => None,
    };
    let (Some(min), Some(max)) = (number("min_deg"), number("max_deg")) else {
        return;
    };
    if min < max {
        return;
    }
    // The message goes to the limit that is in the file; to the lower if both are.
    let at_min = values.offset("motor", "min_deg");
    let at_max = values.offset("motor", "max_deg");
    let (key, offset, found, allowed) = if let Some(offset) = at_min {
        (
            "min_deg",
            offset,
            min,
            format!("below max_deg, which is {max}"),
        )
    } else {
        let offset = at_max.unwrap_or(0);
        (
            "max_deg",
            offset,
            max,
            format!("above min_deg, which is {min}"),
        )
    };
    let path = format!("motor.{key}");
    text.report(
        offset,
        path,
        format!("found {found}"),
        format!("allowed: {allowed}"),
    );
}

fn textured_is_active(values: &Values, text: &mut Text<'_>) {
    let Some(Value::Text(kind)) = values.get("plant", "kind") else {
        return;
    };
    let has_textures = PlantKind::from_name(kind).is_some_and(PlantKind::has_textures);
    if has_textures && values.section("whisking").is_none() {
        let offset = values.offset("plant", "kind").unwrap_or(0);
        let found = format!("found {kind:?} without [whisking]");
        let allowed = format!(
            "the {kind} plant needs an active whisker: add [whisking], or choose \"ideal\""
        );
        text.report(offset, "plant.kind".to_owned(), found, allowed);
    }
}

/// Thicker shafts do not bend as Euler and Bernoulli have it.
fn shaft_is_slender(values: &Values, text: &mut Text<'_>) {
    let Some(Value::Number(length)) = values.get("plant", "length_m") else {
        return;
    };
    for key in ["hub_diameter_m", "tip_diameter_m"] {
        let (Some(Value::Number(diameter)), Some(offset)) =
            (values.get("plant", key), values.offset("plant", key))
        else {
            continue;
        };
        if *diameter > length / 5.0 {
            let found = format!("found {diameter}");
            let allowed = format!("allowed: at most a fifth of length_m, which is {length}");
            text.report(offset, format!("plant.{key}"), found, allowed);
        }
    }
}
