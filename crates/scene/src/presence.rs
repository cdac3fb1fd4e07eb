//! What the declarations ask for: which sections and keys are there, and how long lists are.

use crate::key::{Condition, Need, Row};
use crate::kind::Kind;
use crate::section::{Presence, Section};
use crate::sections::{Arm, Sides, Texture, sections};
use crate::text::Text;
use crate::value::Value;
use crate::values::{Entry, Given, Values};

pub(crate) fn check(values: &Values, text: &mut Text<'_>) {
    for section in sections() {
        match values.section(section.name) {
            Some(given) => {
                needed_section(section, given, values, text);
                if given.readable {
                    for key in section.keys() {
                        presence(section, given, key, values, text);
                        length(section, key, values, text);
                    }
                }
            }
            None if matches!(section.presence, Presence::Required) => {
                let keys: Vec<&str> = section.keys().map(|key| key.name).collect();
                let required = format!("required: a table with the keys {}", keys.join(", "));
                text.report(0, section.title(), "missing".to_owned(), required);
            }
            None => {}
        }
    }
}

/// Completes the values of a file without problems: one number for all whiskers
/// becomes one for each, the default of a key that would be an error here is
/// removed, and a module in a world arms at its start.
pub(crate) fn settle(values: &mut Values) {
    // Nobody stands at a module that is simulated.
    if values.section("plant").is_some() {
        let value = Some(Value::Text(Arm::AtStart.to_string()));
        let offset = None;
        values.add("motor", "arm", Entry { offset, value });
    }
    let whiskers = match head(values) {
        Some((sides, Some(whiskers))) => sides * whiskers,
        _ => 0,
    };
    for section in sections() {
        for key in section.keys() {
            let barred = is_barred(section, key, values);
            let value = match (&key.kind, values.value(section.name, key.name)) {
                (_, Some(_)) if barred => None,
                (Kind::PerWhisker(_), Some(Value::Number(x))) => {
                    Some(Value::Numbers(vec![*x; whiskers]))
                }
                _ => continue,
            };
            values.replace(section.name, key.name, value);
        }
    }
}

/// Whether the key is an error: where none of the conditions under which it is allowed holds.
fn is_barred(section: &Section, key: &Row, values: &Values) -> bool {
    none_holds(section, key.only, values)
}

fn none_holds(section: &Section, conditions: &[Condition], values: &Values) -> bool {
    let fails = |condition| values.holds(section.name, condition) == Some(false);
    !conditions.is_empty() && conditions.iter().all(|condition| fails(*condition))
}

/// The keys that are given without effect, each with what would give it one.
pub(crate) fn idle(values: &Values) -> Vec<(String, String)> {
    let keys = sections().flat_map(|section| section.keys().map(move |key| (section, key)));
    let idle = keys.filter_map(|(section, key)| {
        values.offset(section.name, key.name)?;
        let used: Vec<String> = key.used.iter().map(ToString::to_string).collect();
        let said = format!("has no effect; used only where {}", used.join(" or "));
        none_holds(section, key.used, values).then(|| (section.path(key.name), said))
    });
    idle.collect()
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
            "[{}] acts on {needed}: add [{needed}], or leave [{}] out",
            section.name, section.name
        );
        text.report(given.offset, section.title(), found, allowed);
    }
}

fn presence(section: &Section, given: Given, key: &Row, values: &Values, text: &mut Text<'_>) {
    let path = section.path(key.name);
    if let Some(offset) = values.offset(section.name, key.name) {
        if is_barred(section, key, values) {
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
        Need::When { any, .. } => match any
            .iter()
            .find(|c| values.holds(section.name, **c) == Some(true))
        {
            Some(condition) => format!(" because {condition}"),
            None => return,
        },
    };
    let required = format!("required{reason}: {}", key.allowed());
    text.report(given.offset, path, "missing".to_owned(), required);
}

/// Checks the length of a list that has one entry a whisker, a side or an own surface.
fn length(section: &Section, key: &Row, values: &Values, text: &mut Text<'_>) {
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
        Kind::PerOwn(_) => {
            let textures: Option<Vec<Texture>> = values.get(section.name, "textures");
            let own = |textures: Vec<Texture>| textures.iter().filter_map(|t| t.own()).count();
            let why = "that many of \"own-1\" to \"own-4\" are in `textures`";
            (textures.map(own), why.to_owned())
        }
        _ => return,
    };
    let entries = match values.value(section.name, key.name) {
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
    let sides: Sides = values.get("head", "sides")?;
    Some((sides.count(), values.get("head", "whiskers_per_side")))
}
