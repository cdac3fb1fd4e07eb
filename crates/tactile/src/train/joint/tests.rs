//! Parts of the trainer against closed forms.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::blocks::{Blocks, scales};
use super::pieces::Piece;
use super::run::{Decided, Felt, Rule, decisions};
use super::tables::Evidence;
use super::trial::{Options, Trial};
use super::weights::Prior;
use super::{first_names, floors, weights};

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

fn blocks(samples: Vec<[f64; 2]>, touches: Vec<u16>, block: u32) -> Blocks {
    let trial = Trial {
        label: String::from("a"),
        samples,
        touches,
        ..Trial::default()
    };
    let options = Options {
        block,
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
        let found = blocks(wave.collect(), vec![1; 100], 20);
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
    let samples: Vec<[f64; 2]> = (0..48).map(|n| [f64::from(n), 0.0]).collect();
    // Eight that have no difference; three, two that do not count, three, then nine of another.
    let touches = "333333333330033300000000000077777777700000000000".bytes();
    let found = blocks(samples, touches.map(|c| u16::from(c - b'0')).collect(), 4);
    assert_eq!(found.touches, [3, 7, 7]);
    let firsts: Vec<i32> = found.samples.iter().map(|codes| codes[0]).collect();
    assert_eq!(firsts, [8, 9, 10, 13, 28, 29, 30, 31, 32, 33, 34, 35]);
    // A straight line is smooth, however much of it was felt in the air.
    assert!(found.roughness[1..].iter().all(|codes| *codes == [0, 0]));
}

const LENGTHS: [usize; 4] = [4, 8, 16, 32];

/// By the data alone.
fn fitted(evidence: &[Evidence]) -> Vec<f64> {
    weights::fitted(evidence, &LENGTHS, None, None)
}

/// Evidence of two classes: in each block the right one is ahead by a normal number.
fn evidence(seed: u64, tables: usize) -> Vec<Evidence> {
    let mut dice = Dice(seed);
    let piece = |n: usize| {
        let mut means = Vec::new();
        for _ in 0..50 {
            let ahead = 0.2 + dice.normal();
            let mut row = [0.0; 2];
            row[n % 2] = ahead;
            means.extend(row.repeat(tables));
        }
        Evidence {
            class: n % 2,
            fold: n / 2,
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
    let found = fitted(&evidence(1, 1))[0];
    assert!((found / expected - 1.0).abs() < 0.15, "{found} {expected}");
}

#[test]
fn tables_that_say_the_same_share_their_weight() {
    let alone = fitted(&evidence(2, 1))[0];
    let twice = fitted(&evidence(2, 2));
    for share in twice {
        assert!((2.0 * share - alone).abs() < 2e-6, "{share} {alone}");
    }
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
    let found = fitted(&misleading);
    assert!(found[0] > 0.3 && found[1] >= 0.0, "{found:?}");
    for piece in &mut misleading {
        // Noise in the place of the first table.
        for (n, block) in piece.means.chunks_exact_mut(4).enumerate() {
            block[0] = (n % 3) as f64;
            block[1] = (n % 3) as f64;
        }
    }
    assert_eq!(fitted(&misleading)[1], 0.0);
}

#[test]
fn without_evidence_weights_are_what_the_prior_expects() {
    let mut nothing = evidence(5, 2);
    for piece in &mut nothing {
        piece.means.fill(0.0);
    }
    let found = weights::fitted(&nothing, &LENGTHS, Some(Prior::TEXTURES), None);
    let sum: f64 = found.iter().sum();
    assert!((sum - Prior::TEXTURES.mean).abs() < 1e-6, "{found:?}");
}

#[test]
fn many_trials_outweigh_the_prior() {
    let prior = Some(Prior {
        mean: 2.0,
        ..Prior::TEXTURES
    });
    let far = |pieces: &[Evidence]| {
        let fit = |prior| weights::fitted(pieces, &LENGTHS, prior, None)[0];
        fit(prior) - fit(None)
    };
    let all = evidence(6, 1);
    let [few, many] = [far(&all[..8]), far(&all)];
    assert!(few > 0.1 && many > 0.0 && many < few / 3.0, "{few} {many}");
}

fn rule(weight: f64) -> Rule {
    Rule {
        threshold: 0.99,
        block: 20,
        weights: vec![weight],
        unknown: None,
        apart: false,
    }
}

/// Pieces of one touch for evidence of two classes: in each block the right one is ahead by a
/// normal number, in a whole trial by one more of this deviation.
fn trials(seed: u64, count: usize, deviation: f64) -> (Vec<Piece<'static>>, Vec<Evidence>) {
    let mut dice = Dice(seed);
    let mut all: Vec<Evidence> = (0..count / 200)
        .flat_map(|part| evidence(seed + part as u64, 1))
        .collect();
    for piece in &mut all {
        let character = deviation * dice.normal();
        for block in piece.means.chunks_exact_mut(2) {
            block[piece.class] += character;
        }
    }
    let piece = |(fold, of): (usize, &Evidence)| Piece {
        class: of.class,
        recording: "",
        fold,
        blocks: blocks(vec![[0.0; 2]; 50], vec![1; 50], 1),
    };
    (all.iter().enumerate().map(piece).collect(), all)
}

#[test]
fn first_names_are_right_as_often_as_stated_where_trials_have_a_character() {
    let right = |factor: f64, deviation: f64| {
        let (pieces, evidence) = trials(100, 2000, deviation);
        let rule = Rule {
            apart: true,
            ..rule(factor)
        };
        let mut names = decisions(&pieces, &evidence, &rule);
        names.dedup_by_key(|name| name.piece);
        let right = names.iter().filter(|name| name.class == name.truth);
        right.count() as f64 / names.len() as f64
    };
    let lowered = |weight: f64, deviation: f64| {
        let (pieces, evidence) = trials(8, 200, deviation);
        first_names::lowered(&rule(weight), &pieces, &evidence, |_| Vec::new())[0]
    };
    // The log-likelihood ratio, as above: trials that do not differ ask for nothing less.
    let weight = 2.0 * 0.2 / core::f64::consts::LN_2;
    assert_eq!(lowered(weight, 0.0), weight);
    assert!(right(weight, 0.0) > 0.985);
    // Others, which were not there, bear it out.
    let less = lowered(weight, 0.2);
    let [before, after] = [weight, less].map(|weight| right(weight, 0.2));
    assert!(
        before < 0.96 && after > 0.97,
        "{weight} {less}: {before} {after}"
    );
}

#[test]
fn what_floors_refuse_does_not_weigh() {
    let clean = evidence(7, 1);
    let mut mixed = clean.clone();
    // Each fourth trial speaks for the other class, by entries far below the floors.
    for piece in mixed.iter_mut().step_by(4) {
        piece.class = 1 - piece.class;
        for x in &mut piece.means {
            *x -= 15.0;
        }
    }
    let rule = rule(1.0);
    let floor = floors::Floor {
        samples: 10.0,
        roughness: 0.0,
    };
    let known = weights::Known {
        rule: &rule,
        floors: &[floor; 2],
    };
    let kept: Vec<Evidence> = clean
        .chunks(4)
        .flat_map(|four| four[1..].to_vec())
        .collect();
    let fit = |pieces: &[Evidence], known| weights::fitted(pieces, &LENGTHS, None, known)[0];
    let expected = fit(&kept, None);
    assert!((fit(&mixed, Some(known)) - expected).abs() < 1e-9);
    assert!(fit(&mixed, None) < 0.5 * expected);
}

/// What is felt of a class in trials that differ, and that differ within.
fn felt(dice: &mut Dice, trials: usize, decisions: usize) -> Vec<Felt> {
    let mut all = Vec::new();
    for piece in 0..trials {
        let trial = [0.5 * dice.normal(), 0.1 * dice.normal()];
        all.extend((0..decisions).map(|_| Felt {
            piece,
            class: 0,
            entries: [
                8.0 + trial[0] + 0.2 * dice.normal(),
                3.0 + trial[1] + 0.3 * dice.normal(),
            ],
        }));
    }
    all
}

#[test]
fn floors_refuse_the_share_of_another_trial_that_they_were_asked_for() {
    let mut dice = Dice(4);
    let mut refused = 0;
    let runs = 2000;
    for _ in 0..runs {
        let floors = floors::of(&felt(&mut dice, 6, 10), 1, 0.1, &[]);
        let [fresh] = felt(&mut dice, 1, 1)[..] else {
            unreachable!()
        };
        refused += u32::from(floors[0].refuses(fresh.entries));
    }
    // Binomial: 0.1 ± 0.007, and less the 0.0025 of those that lie below both.
    let share = f64::from(refused) / f64::from(runs);
    assert!((0.075..=0.12).contains(&share), "{share}");
}

#[test]
fn floors_are_put_where_a_class_that_was_not_trained_shows() {
    let felt = felt(&mut Dice(5), 6, 10);
    let stranger = |entries| Decided {
        piece: 0,
        truth: 1,
        class: 0,
        posterior: 0.995,
        samples: 100,
        is_named: true,
        entries,
    };
    // One unlike in its samples, one in its roughness, each by more and more.
    let unlike = |entries: fn(f64) -> [f64; 2]| {
        let steps = (0..200).map(|n| stranger(entries(0.01 * f64::from(n))));
        floors::of(&felt, 1, 0.1, &[steps.collect()])[0]
    };
    let by_samples = unlike(|less| [8.0 - less, 3.0]);
    let by_roughness = unlike(|less| [8.0, 3.0 - less]);
    let even = floors::of(&felt, 1, 0.1, &[])[0];
    assert!(by_samples.samples > even.samples && by_samples.roughness < even.roughness);
    assert!(by_roughness.samples < even.samples && by_roughness.roughness > even.roughness);
    // Nothing is refused of a class of which too little is known.
    let nothing = floors::of(&felt[..10], 2, 0.1, &[]);
    assert!(nothing.iter().all(|floor| !floor.refuses([0.0, 0.0])));
}
