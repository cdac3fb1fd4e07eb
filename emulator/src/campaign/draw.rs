//! From the number of a run to what is injected in it.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::injection::{Injection, Kind};

/// How long a run lasts, s: the injection, a rest after a fault, and whisks after that.
pub(super) const RUN_S: f64 = 2.2;
/// The injection falls between these, s.
const FROM_S: f64 = 0.25;
const TO_S: f64 = 0.5;
/// The longest that is taken away again, s.
const LONGEST_S: f64 = 0.4;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Plan {
    /// What a run's number draws.
    Drawn,
    /// A bit of the word of RAM that has the run's number; which bit, and when, is drawn.
    Words,
}

/// What a scene and its subject have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Has {
    /// Motors that move.
    pub(super) motors: bool,
    /// A chip.
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

fn one_of(random: &mut Xoshiro256PlusPlus, kinds: &[Kind]) -> Kind {
    let n = below(random, kinds.len() as u64) as usize;
    kinds.get(n).copied().unwrap_or(Kind::SensorSilent)
}

/// Draws the injection of a run. Half of those that can be taken away again stay to the end.
pub(super) fn injection(
    plan: Plan,
    number: u64,
    has: Has,
    random: &mut Xoshiro256PlusPlus,
) -> Injection {
    let kind = match below(random, 10) {
        _ if plan == Plan::Words => Kind::RamBit,
        0..6 if has.chip => one_of(random, &Kind::CHIP),
        n if has.motors && n % 2 == 0 => one_of(random, &Kind::MOTOR),
        _ => one_of(random, &Kind::SENSOR),
    };
    let ticks = |seconds: f64| (seconds * f64::from(has.tick_hz)) as u64;
    let start = ticks(FROM_S) + below(random, ticks(TO_S - FROM_S));
    let longest = LONGEST_S * f64::from(has.tick_hz);
    let share = below(random, 1001) as f64 / 1000.0;
    let stays = random.next_u64().is_multiple_of(2);
    let length = if kind.is_momentary() {
        Some(1)
    } else {
        (!stays).then(|| longest.powf(share) as u64)
    };
    let drawn = Injection {
        kind,
        whisker: below(random, has.whiskers as u64) as usize,
        start,
        ticks: length,
        detail: random.next_u64(),
    };
    match plan {
        Plan::Drawn => drawn,
        Plan::Words => Injection {
            detail: drawn.detail & !u64::from(u32::MAX) | number & u64::from(u32::MAX),
            ..drawn
        },
    }
}

#[cfg(test)]
mod tests {
    use super::{Has, Kind, Plan, injection, random};

    #[test]
    fn every_word_has_its_run() {
        let has = Has {
            motors: true,
            chip: true,
            whiskers: 1,
            tick_hz: 2_000,
        };
        for number in [0, 1, 700, u64::from(u32::MAX)] {
            let drawn = injection(Plan::Words, number, has, &mut random(number));
            assert_eq!(
                (drawn.kind, drawn.detail as u32),
                (Kind::RamBit, number as u32)
            );
            assert_eq!(drawn.ticks, Some(1));
        }
    }
}
