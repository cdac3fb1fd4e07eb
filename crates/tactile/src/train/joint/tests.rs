//! Parts of the trainer against closed forms.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::blocks::{Blocks, scales};
use super::run::Decided;
use super::tables::Evidence;
use super::trial::{Options, Trial};
use super::{floors, weights};

/// Uniform in 0 to 1: a linear congruential generator is random enough.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal to four decimals of its variance: twelve uniform numbers.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.roll()).sum::<f64>() - 6.0
    }
}

fn blocks(samples: Vec<[f64; 2]>, counts: Vec<bool>, block: u32) -> Blocks {
    let trial = Trial {
        label: String::from("a"),
        recording: String::new(),
        samples,
        counts,
    };
    let options = Options {
        block,
        gap: 10,
        ..Options::default()
    };
    let scales = scales(core::slice::from_ref(&trial)).unwrap();
    Blocks::of(&trial, &scales, &options)
}

#[test]
fn the_roughness_of_a_sine_is_its_closed_form() {
    // sin(wn) - 2 sin(w(n-4)) + sin(w(n-8)) = -4 sin²(2w) sin(w(n-4)); over the 20
    // samples of a period the amounts of the sine sum up to 2 cot(w/2).
    let w = core::f64::consts::TAU / 20.0;
    for amplitude in [100.0, 1000.0, 8000.0] {
        let wave = (0..100).map(|n| {
            let x = (amplitude * (w * f64::from(n)).sin()).round();
            [x, 3.0]
        });
        let found = blocks(wave.collect(), vec![true; 100], 20);
        let sum = amplitude * 4.0 * (2.0 * w).sin().powi(2) * 2.0 / (w / 2.0).tan();
        let code = 64.0 * (1.0 + sum).log2();
        for [x, y] in &found.roughness[1..] {
            // The interpolation is up to 5.5 low, a rounded code half a code off.
            let off = f64::from(*x) - code;
            assert!((-7.0..=1.5).contains(&off), "{amplitude}: {x} {code}");
            assert_eq!(*y, 0);
        }
    }
}

#[test]
fn a_touch_drops_the_open_block() {
    let samples: Vec<[f64; 2]> = (0..40).map(|n| [f64::from(n), 0.0]).collect();
    // Three, a short gap, three, a long gap, then nine.
    let counts: Vec<bool> = "###..###............#########..........."
        .bytes()
        .map(|c| c == b'#')
        .collect();
    let found = blocks(samples, counts, 4);
    assert_eq!(found.touches, [1, 2, 2]);
    let firsts: Vec<i32> = found.samples.iter().map(|codes| codes[0]).collect();
    assert_eq!(firsts, [0, 1, 2, 5, 20, 21, 22, 23, 24, 25, 26, 27]);
    // A straight line is smooth, however much of it was felt in the air.
    assert!(found.roughness[1..].iter().all(|codes| *codes == [0, 0]));
}

const LENGTHS: [usize; 4] = [4, 8, 16, 32];

/// Evidence of two classes: in each block the right one is ahead by a normal number.
fn evidence(seed: u64, tables: usize) -> Vec<Evidence> {
    let mut dice = Dice(seed);
    let piece = |n: usize| {
        let mut means = Vec::new();
        for _ in 0..50 {
            let ahead = 0.2 + dice.normal();
            let row = if n.is_multiple_of(2) {
                [ahead, 0.0]
            } else {
                [0.0, ahead]
            };
            means.extend(row.repeat(tables));
        }
        Evidence {
            class: n % 2,
            tables,
            classes: 2,
            means,
        }
    };
    (0..200).map(piece).collect()
}

#[test]
fn weights_turn_evidence_into_probability() {
    // Normal differences of mean m and variance v: the log-likelihood ratio of a
    // stretch of any length is 2 m/v times their sum, in natural units.
    let expected = 2.0 * 0.2 / core::f64::consts::LN_2;
    let found = weights::fitted(&evidence(1, 1), &LENGTHS);
    assert!(
        (found[0] / expected - 1.0).abs() < 0.15,
        "{found:?} {expected}"
    );
}

#[test]
fn tables_that_say_the_same_share_their_weight() {
    let alone = weights::fitted(&evidence(2, 1), &LENGTHS);
    let twice = weights::fitted(&evidence(2, 2), &LENGTHS);
    assert!((twice[0] - twice[1]).abs() < 1e-6, "{twice:?}");
    assert!(
        (twice[0] + twice[1] - alone[0]).abs() < 1e-6,
        "{twice:?} {alone:?}"
    );
}

#[test]
fn a_table_that_misleads_weighs_nothing() {
    let mut misleading = evidence(3, 2);
    for piece in &mut misleading {
        for block in piece.means.chunks_exact_mut(4) {
            block[2] = -block[2];
            block[3] = -block[3];
        }
    }
    let found = weights::fitted(&misleading, &LENGTHS);
    assert!(found[0] > 0.3 && found[1] >= 0.0, "{found:?}");
    for piece in &mut misleading {
        // Noise in the place of the first table.
        for (n, block) in piece.means.chunks_exact_mut(4).enumerate() {
            block[0] = (n % 3) as f64;
            block[1] = (n % 3) as f64;
        }
    }
    assert_eq!(weights::fitted(&misleading, &LENGTHS)[1], 0.0);
}

#[test]
fn floors_refuse_the_share_that_they_were_asked_for() {
    let mut dice = Dice(4);
    let mut decisions = |class: usize, count: usize| -> Vec<Decided> {
        let decided = |_| Decided {
            piece: 0,
            truth: class,
            class,
            posterior: 0.995,
            samples: 100,
            entries: [
                8.0 + dice.normal() + 4.0 * class as f64,
                3.0 + 0.1 * dice.normal(),
            ],
        };
        (0..count).map(decided).collect()
    };
    // The third class has too few of its own.
    let all: Vec<Decided> = [decisions(0, 2000), decisions(1, 2000), decisions(2, 10)].concat();
    let floors = floors::of(&all, 3, 0.05);
    let fresh = [decisions(0, 4000), decisions(1, 4000), decisions(2, 4000)];
    for (class, fresh) in fresh.iter().enumerate().take(2) {
        let refused = fresh.iter().filter(|d| floors[class].refuses(d)).count();
        assert!((160..=240).contains(&refused), "{class}: {refused} of 4000");
    }
    // Its mean is known to a third of the spread.
    let refused = fresh[2].iter().filter(|d| floors[2].refuses(d)).count();
    assert!((40..=800).contains(&refused), "{refused} of 4000");
    let stranger = Decided {
        entries: [4.0, 3.0],
        ..all[0]
    };
    assert!(floors[0].refuses(&stranger));
    assert!(
        floors::of(&[], 2, 0.05)
            .iter()
            .all(|floor| !floor.refuses(&stranger))
    );
}
