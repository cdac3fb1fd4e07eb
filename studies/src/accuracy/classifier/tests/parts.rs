//! The parts by themselves: exponentials, evidence, and how decisions are counted.

use scene::Rule;
use tactile::train::Options;

use super::super::data::Recording;
use super::super::evidence::Evidence;
use super::super::ground::{Fallen, restarted, shared};
use super::super::listeners::{Fell, Listener};
use super::super::measure::Same;
use super::super::model::{Deficit, Exponential, Variant};
use host_sim::recording::Stream;

#[test]
fn exponentials_are_as_good_as_their_closed_forms() {
    // A chord lies above 2^−x by at most (ln 2 / n)² / 8.
    let chord = |n: f64| (std::f64::consts::LN_2 / n).powi(2) / 8.0;
    let within = |found: f64, low: f64, high: f64| {
        assert!((low..=high).contains(&found), "{found}");
    };
    within(Exponential::Exact.error(), 0.0, 1e-15);
    within(
        Exponential::Lines128.error(),
        0.98 * chord(128.0),
        1.05 * chord(128.0),
    );
    within(
        Exponential::Lines16.error(),
        0.98 * chord(16.0),
        1.02 * chord(16.0),
    );
    within(Exponential::Micromath.error(), 1e-3, 3e-3);
    within(Exponential::Shift.error(), 0.99, 1.0);
    for exponential in Exponential::ALL {
        assert_eq!(exponential.term(0.0), 1.0);
        assert!((exponential.term(3.0) - 0.125).abs() < 4e-4);
        assert!(exponential.term(5000.0) < 1e-30);
    }
}

#[test]
fn small_odds_keep_their_precision_under_a_threshold_near_one() {
    let limit = 1e-9;
    let deficits = [30.5, 31.25, 40.0];
    let exact: f64 = deficits.iter().map(|x: &f64| (-x).exp2()).sum();
    // Terms of 2⁻³⁰ are nothing in 26 bits; lifted by 28 they are almost one.
    for (exponential, bound) in [
        (Exponential::Exact, 1e-14),
        (Exponential::Lines128, 1e-5),
        (Exponential::Lines16, 3e-4),
    ] {
        let odds = exponential.odds(deficits.into_iter(), limit);
        assert!((odds / exact - 1.0).abs() < bound, "{odds} {exact}");
        let near = exponential.odds([1.0].into_iter(), limit);
        assert!(near > limit);
    }
}

#[test]
fn evidence_follows_its_definition_at_every_width() {
    let in_bit = |deficit| {
        let variant = Variant {
            deficit,
            ..Variant::PRODUCT
        };
        let mut evidence = Evidence::new(variant, 20, 3);
        // Over the block class 1 leads class 0 by 1.5 bit and class 2 by 100.
        let per_sample = [98.5, 100.0, 0.0];
        evidence.add(&per_sample.map(|bits: f64| (bits * 20.0 * 1024.0) as i64));
        assert_eq!((evidence.leader(), evidence.samples()), (1, 20));
        let first = evidence.deficits().to_vec();
        // Then class 0 comes back by 2.
        evidence.add(&[2 * 20 * 1024, 0, 0]);
        assert_eq!((evidence.leader(), evidence.samples()), (0, 40));
        let second = evidence.deficits().to_vec();
        let p = evidence.posteriors();
        assert!((p[1] / p[0] - 0.5_f64.sqrt()).abs() < 1e-5);
        assert!(evidence.decides(Rule::Sequential { threshold: 0.58 }));
        assert!(!evidence.decides(Rule::Sequential { threshold: 0.59 }));
        assert!(evidence.decides(Rule::Window { samples: 40 }));
        assert!(!evidence.decides(Rule::Window { samples: 60 }));
        evidence.forget();
        assert_eq!(evidence.deficits(), [0; 3]);
        [first, second]
    };
    assert_eq!(
        in_bit(Deficit::Bits16),
        [vec![3072, 0, 65535], vec![0, 1024, 65535]]
    );
    let exact = [vec![30_720, 0, 2_048_000], vec![0, 10_240, 2_058_240]];
    assert_eq!(in_bit(Deficit::Bits32), exact);
    assert_eq!(in_bit(Deficit::Bits64), exact);
}

/// Decides `waits[n]` blocks after it started for the n-th time, for class n.
struct Scripted {
    waits: [usize; 3],
    done: usize,
    since: usize,
}

impl Listener for Scripted {
    fn hear(&mut self, _stream: usize, _block: usize) -> Fell {
        self.since += 1;
        (self.waits.get(self.done) == Some(&self.since)).then(|| {
            self.since = 0;
            self.done += 1;
            (self.done - 1, 0)
        })
    }

    fn forget(&mut self) {
        self.since = 0;
    }

    fn posteriors(&self) -> Vec<f64> {
        Vec::new()
    }
}

#[test]
fn identical_decisions_are_counted_of_all_that_either_makes() {
    let fallen = |block, class| Fallen {
        stream: 0,
        block,
        class,
        samples: 0,
    };
    let exact = [fallen(1, 0), fallen(3, 1), fallen(6, 2)];
    let found = [fallen(1, 0), fallen(4, 1), fallen(6, 0), fallen(8, 0)];
    // The same at 1; different at 3, 4, 6 and 8.
    assert_eq!(shared(&exact, &found), Same { same: 1, of: 5 });

    let stream = |label: &str, from: i32| Stream {
        label: label.to_owned(),
        trial: "1".to_owned(),
        samples: (0..200).map(|n| [f64::from(from + 7 * n); 2]).collect(),
    };
    let learn = [stream("a", 0), stream("b", 500)];
    let recording = Recording::learnt("two", &learn, &learn[..1]).unwrap();
    assert_eq!(recording.blocks(0), 200 / Options::default().block as usize);
    let count = |waits| {
        let mut scripted = Scripted {
            waits,
            done: 0,
            since: 0,
        };
        restarted(&recording, &exact, &mut scripted)
    };
    // Blocks 1, 3 and 6 end waits of two, two and three.
    assert_eq!(count([2, 2, 3]), Same { same: 3, of: 3 });
    // A late first one is not made up for, but the next starts anew: here at
    // block 3, as class 0 in place of 1.
    assert_eq!(count([3, 9, 9]), Same { same: 0, of: 3 });
    // An early one counts as different, and so does one after the last.
    assert_eq!(count([1, 9, 9]), Same { same: 0, of: 3 });
    assert_eq!(count([2, 2, 9]), Same { same: 2, of: 3 });
    let exact = &exact[..2];
    let mut scripted = Scripted {
        waits: [2, 2, 3],
        done: 0,
        since: 0,
    };
    assert_eq!(
        restarted(&recording, exact, &mut scripted),
        Same { same: 2, of: 3 }
    );
}
