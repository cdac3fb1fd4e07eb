//! From the number of a run to what is injected in it.

use std::iter;

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::injection::{Befallen, Injection, Kind};

/// How long a run lasts, s: injections, rests after a fault, and whisks after that.
pub(super) const RUN_S: f64 = 10.0;
/// An injection begins between these, s: in some scenes while a whisker is homed.
const FROM_S: f64 = 0.25;
const TO_S: f64 = 3.0;
/// And before this where every word has its run, of which there are many, s.
const WORDS_TO_S: f64 = 0.5;
/// The longest that is taken away again, s.
const LONGEST_S: f64 = 2.0;
/// Of so many runs one has a second injection, if that befalls something else.
const TWO_IN: u64 = 2;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Plan {
    Drawn,
    /// A bit of the word of RAM that has the run's number; which bit, and when, is drawn.
    Words,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Has {
    pub(super) motors: bool,
    pub(super) chip: bool,
    pub(super) whiskers: usize,
    pub(super) tick_hz: u32,
}

pub(super) fn random(run: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(run)
}

fn below(random: &mut Xoshiro256PlusPlus, bound: u64) -> u64 {
    random.next_u64() % bound.max(1)
}

fn one_of(random: &mut Xoshiro256PlusPlus, at: Befallen) -> Kind {
    let kinds = Kind::all(at);
    kinds[below(random, kinds.len() as u64) as usize]
}

pub(super) fn injections(
    plan: Plan,
    number: u64,
    has: Has,
    random: &mut Xoshiro256PlusPlus,
) -> Vec<Injection> {
    match plan {
        Plan::Words => {
            let first = injection(random, has, WORDS_TO_S);
            let word = number & u64::from(u32::MAX);
            vec![Injection {
                kind: Kind::RamBit,
                ticks: Some(1),
                detail: first.detail & !u64::from(u32::MAX) | word,
                ..first
            }]
        }
        Plan::Drawn => {
            let first = injection(random, has, TO_S);
            let is_alone = below(random, TWO_IN) != 0;
            // Two at one motor, or one sensor, would undo each other.
            let second = injection(random, has, TO_S);
            let is_elsewhere = second.kind.befalls() != first.kind.befalls();
            let second = (is_elsewhere && !is_alone).then_some(second);
            iter::once(first).chain(second).collect()
        }
    }
}

/// Half of those that can be taken away again stay to the end.
fn injection(random: &mut Xoshiro256PlusPlus, has: Has, to_s: f64) -> Injection {
    let kind = match below(random, 10) {
        0..6 if has.chip => one_of(random, Befallen::Chip),
        n if has.motors && n % 2 == 0 => one_of(random, Befallen::Motor),
        _ => one_of(random, Befallen::Sensor),
    };
    let ticks = |seconds: f64| (seconds * f64::from(has.tick_hz)) as u64;
    let start = ticks(FROM_S) + below(random, ticks(to_s - FROM_S));
    let longest = LONGEST_S * f64::from(has.tick_hz);
    let share = below(random, 1001) as f64 / 1000.0;
    let stays = random.next_u64().is_multiple_of(2);
    let length = if kind.is_momentary() {
        Some(1)
    } else {
        (!stays).then(|| longest.powf(share) as u64)
    };
    Injection {
        kind,
        whisker: below(random, has.whiskers as u64) as usize,
        start,
        ticks: length,
        detail: random.next_u64(),
    }
}
