//! From the constants of a module back to the keys of its scene.

use scene::{Scene, key_facts};

use super::live::{LIVE, LiveKey};

/// The constants that a scene comes to, and by which they are compared.
pub(super) trait Constants {
    /// The value of a constant of the scene; none where the scene cannot be.
    fn of(&self, scene: &Scene, number: u8) -> Option<f64>;

    /// What the module has; none where it has none of that number.
    fn found(&self, number: u8) -> Option<f64>;
}

/// A key with the value that a module has.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    /// With its section.
    pub(crate) key: &'static str,
    /// The shortest number that comes to the module's constants.
    pub(crate) value: f64,
}

/// The keys whose values in the module differ from those of `scene`, which becomes the module's
/// as far as keys can say it.
pub(super) fn infer(scene: &mut Scene, constants: &impl Constants) -> Vec<Found> {
    let mut differing = Vec::new();
    for live in LIVE {
        let lead = live.lead_in(scene);
        let (Some(found), Some(own)) = (constants.found(lead), constants.of(scene, lead)) else {
            continue;
        };
        if found == own {
            continue;
        }
        if let Some(value) = invert(live, scene, constants, found) {
            if let Some(place) = (live.place)(scene) {
                *place = value;
            }
            let key = live.key;
            differing.push(Found { key, value });
        }
    }
    differing
}

/// The shortest number that gives the constant `target` where the key stands for it.
fn invert(live: &LiveKey, scene: &Scene, constants: &impl Constants, target: f64) -> Option<f64> {
    let mut trial = scene.clone();
    let lead = live.lead_in(scene);
    let mut constant = |value: f64| {
        *(live.place)(&mut trial)? = value;
        constants.of(&trial, lead)
    };
    let own = *(live.place)(&mut scene.clone())?;
    let ends = key_facts(live.key)?.ends?;
    let from = constant(own)?;
    for end in ends {
        // Where the constant has come to the target or gone beyond it, or the scene cannot be.
        let mut has_passed =
            |value| constant(value).is_none_or(|x| (x - target) * (from - target) <= 0.0);
        if !has_passed(end) {
            continue;
        }
        let first = bisect(own, end, &mut has_passed);
        if constant(first) != Some(target) {
            continue;
        }
        let last = bisect(first, end, &mut |value| constant(value) != Some(target));
        // The end of the range itself may have the constant too.
        let last = if constant(end) == Some(target) {
            end
        } else {
            last
        };
        return Some(shortest(first, last, &mut |value| {
            constant(value) == Some(target)
        }));
    }
    None
}

/// The first number from `from` to `to` for which it holds, as it does at `to`.
fn bisect(from: f64, to: f64, holds: &mut impl FnMut(f64) -> bool) -> f64 {
    let (mut not, mut is) = (from, to);
    loop {
        let middle = not + (is - not) / 2.0;
        if middle == not || middle == is {
            return is;
        }
        if holds(middle) {
            is = middle;
        } else {
            not = middle;
        }
    }
}

/// The number of the fewest digits near the middle of two for which it holds.
fn shortest(first: f64, last: f64, holds: &mut impl FnMut(f64) -> bool) -> f64 {
    let middle = first + (last - first) / 2.0;
    let rounded = (0..17).filter_map(|digits| format!("{middle:.digits$e}").parse().ok());
    let mut rounded = rounded.filter(|value: &f64| holds(*value));
    rounded.next().unwrap_or(first)
}
