//! Several streams under one model: each by itself as a classifier of its own, and all
//! together by the sum of their evidence.

use proptest::prelude::*;
use tactile::train::{Options, TrainError, Trainer};
use tactile::{
    AnyRule, Axis, Deciding, Decision, Floors, MAX_STREAMS, ModelBuf, ModelParts, NaiveBayes,
    Posteriors, RuleSettings, Sequential, SetupError, StreamClassifier, TableParts, TableSource,
    TouchRule,
};

use crate::common::{TOUCHES, entry, model, of_two, threshold};

const BLOCK: u32 = 4;

#[derive(Debug, Clone)]
enum Act {
    Push([i32; 2]),
    Pass([i32; 2]),
    Touch(u16),
    Interrupt,
}

fn act() -> impl Strategy<Value = Act> {
    let codes = || [0..1000_i32, 0..1000_i32];
    prop_oneof![
        20 => codes().prop_map(Act::Push),
        3 => codes().prop_map(Act::Pass),
        1 => any::<u16>().prop_map(Act::Touch),
        1 => Just(Act::Interrupt),
    ]
}

type Owned = StreamClassifier<Box<[u32]>>;

fn act_on(streams: &mut Owned, n: usize, act: &Act) -> Option<Decision> {
    match act {
        Act::Push(codes) => return streams.push_to(n, codes).unwrap(),
        Act::Pass(codes) => streams.pass_to(n, codes).unwrap(),
        Act::Touch(number) => streams.begin_touch(n, *number),
        Act::Interrupt => streams.interrupt_stream(n),
    }
    None
}

fn act_alone(alone: &mut Sequential<Box<[u32]>>, act: &Act) -> Option<Decision> {
    match act {
        Act::Push(codes) => return alone.push(codes).unwrap(),
        Act::Pass(codes) => alone.pass(codes).unwrap(),
        Act::Touch(number) => alone.touch(*number),
        Act::Interrupt => alone.interrupt(),
    }
    None
}

fn sequential(model: ModelBuf, theta: f64, deciding: Deciding, whiskers: usize) -> Owned {
    let rule = RuleSettings::Sequential(threshold(theta));
    StreamClassifier::new(model, rule, deciding, whiskers).unwrap()
}

fn together(model: ModelBuf, theta: f64, whiskers: usize) -> Owned {
    sequential(model, theta, Deciding::Together, whiskers)
}

/// Three classes over four cells of x and y together, and two of the roughness of x.
fn joint(entries: &[u16], floor: u16) -> ModelBuf {
    let axis = |channel, high| Axis::new(channel, 2, [0, high]);
    let (both, rough) = ([axis(0, 1000), axis(1, 1000)], [axis(0, 1024)]);
    let tables = [
        TableParts {
            source: TableSource::Samples,
            axes: &both,
            entries: &entries[..12],
        },
        TableParts {
            source: TableSource::Roughness,
            axes: &rough,
            entries: &entries[12..18],
        },
    ];
    let floors = [Floors {
        samples: floor,
        roughness: floor,
    }; 3];
    let rest = ModelParts {
        block: BLOCK,
        tables: &tables,
        floors: Some(&floors),
        touch: Some(TOUCHES),
        ..ModelParts::default()
    };
    of_two(&["a", "b", "c"], rest)
}

/// Entries of some bits' difference.
fn entries() -> impl Strategy<Value = Vec<u16>> {
    prop::collection::vec(18_000..20_480_u16, 18)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn each_stream_decides_as_alone(
        entries in entries(),
        floor in 18_000..20_000_u16,
        acts in prop::collection::vec((0..3_usize, act()), 400),
    ) {
        let model = joint(&entries, floor);
        let mut each = sequential(model.clone(), 0.9, Deciding::Each, 3);
        let alone = || Sequential::new(model.clone(), threshold(0.9)).unwrap();
        let mut alone = [alone(), alone(), alone()];
        for (n, act) in &acts {
            let found = act_on(&mut each, *n, act);
            prop_assert_eq!(found, act_alone(&mut alone[*n], act));
            prop_assert_eq!(each.posteriors(*n), alone[*n].posteriors());
            if let Act::Touch(number) = act {
                prop_assert_eq!(each.touch_of(*n), *number);
            }
        }
        each.restart();
        prop_assert_eq!(each.posteriors(1), fresh(&model));
    }

    #[test]
    fn one_stream_together_decides_as_alone(
        entries in entries(),
        floor in 18_000..20_000_u16,
        theta in 0.2..0.999_f64,
        acts in prop::collection::vec(act(), 400),
    ) {
        let model = joint(&entries, floor);
        // Streams that say nothing change nothing.
        let mut together = together(model.clone(), theta, 24);
        let mut alone = Sequential::new(model, threshold(theta)).unwrap();
        for act in &acts {
            let found = act_on(&mut together, 7, act);
            prop_assert_eq!(found, act_alone(&mut alone, act));
            prop_assert_eq!(together.posteriors(0), alone.posteriors());
        }
    }

    /// Without touches, blocks of any streams are evidence as if one had sent them all.
    #[test]
    fn evidence_adds_up_whoever_has_it(
        bits in prop::collection::vec(-6.0..-0.5_f64, 24),
        theta in 0.5..0.9999_f64,
        blocks in prop::collection::vec((0..4_usize, prop::array::uniform4([0..1000_i32, 0..1000_i32])), 100),
    ) {
        let model = model(3, 2, 4, BLOCK, |bin, channel, class| bits[(bin * 2 + channel) * 3 + class]);
        let mut together = together(model.clone(), theta, 4);
        let mut alone = Sequential::new(model, threshold(theta)).unwrap();
        let mut decisions = 0;
        for (n, block) in &blocks {
            for codes in block {
                let found = together.push_to(*n, codes).unwrap();
                prop_assert_eq!(found, alone.push(codes).unwrap());
                decisions += u32::from(found.is_some());
            }
            prop_assert_eq!(together.posteriors(0), alone.posteriors());
        }
        // Tables that are all alike decide nothing; a test without decisions fails by its rejects.
        prop_assume!(decisions > 0);
    }
}

fn fresh(model: &ModelBuf) -> Posteriors {
    Sequential::new(model.clone(), threshold(0.9))
        .unwrap()
        .posteriors()
}

/// Two classes that differ by a bit a sample at code 0 and against it at code 900.
fn coin(floors: Option<&[Floors]>, touch: Option<TouchRule>) -> ModelBuf {
    let axis = Axis::new(0, 2, [0, 1000]);
    let entries = [-1.0, -2.0, -2.0, -1.0].map(entry);
    let rest = ModelParts {
        block: 1,
        tables: &[TableParts::of_channel(&axis, &entries)],
        floors,
        touch,
        ..ModelParts::default()
    };
    of_two(&["low", "high"], rest)
}

const LOW: [i32; 2] = [0, 0];
const HIGH: [i32; 2] = [900, 0];

/// 4 bits are 94.1 %.
const FOUR_BITS: f64 = 0.94;

#[test]
fn a_touch_limits_its_own_stream_alone() {
    let leader = |together: &Owned| {
        let posteriors: Vec<f64> = together.posteriors(0).to_f64().collect();
        (posteriors[0] / posteriors[1]).log2()
    };
    let model = coin(None, Some(TOUCHES));
    let mut together = together(model, 1.0 - 1e-6, 2);
    for n in 0..2 {
        together.begin_touch(n, 1);
        for _ in 0..5 {
            assert_eq!(together.push_to(n, &LOW).unwrap(), None);
        }
    }
    assert!((leader(&together) - 10.0).abs() < 1e-3);
    together.begin_touch(1, 2);
    assert!((leader(&together) - 7.0).abs() < 1e-3);
    assert_eq!([0, 1].map(|n| together.touch_of(n)), [1, 2]);
    together.begin_touch(0, 2);
    assert!((leader(&together) - 4.0).abs() < 1e-3);
}

#[test]
fn a_decision_bears_the_samples_of_all_and_all_begin_again() {
    let mut together = together(coin(None, None), FOUR_BITS, 2);
    let sent = [(0, LOW), (0, LOW), (1, HIGH), (1, LOW), (1, LOW), (0, LOW)];
    for round in 0..3 {
        together.begin_touch(0, 10 + round);
        together.begin_touch(1, 20 + round);
        for (n, codes) in &sent[..5] {
            assert_eq!(together.push_to(*n, codes).unwrap(), None);
        }
        let decision = together.push_to(0, &LOW).unwrap().expect("four bits");
        assert_eq!((decision.class(), decision.samples()), (Some(0), 6));
        assert_eq!(
            decision.touch(),
            10 + round,
            "of the stream whose block it was"
        );
        assert!((decision.posterior().to_f64() - 16.0 / 17.0).abs() < 1e-6);
    }
}

#[test]
fn floors_are_held_against_all_that_had_a_part_and_no_other() {
    // A class's mean entry must be that of half of its own samples at least.
    let floor = Floors {
        samples: entry(-1.0).midpoint(entry(-2.0)),
        roughness: 0,
    };
    let fresh = || {
        let model = coin(Some(&[floor; 2]), None);
        together(model, FOUR_BITS, 2)
    };
    let decide = |together: &mut Owned, sent: &[(usize, [i32; 2], u32)]| {
        let mut last = None;
        for (n, codes, times) in sent {
            for _ in 0..*times {
                assert_eq!(last, None);
                last = together.push_to(*n, codes).unwrap();
            }
        }
        last.expect("four bits").class()
    };
    assert_eq!(decide(&mut fresh(), &[(0, LOW, 2), (1, LOW, 2)]), Some(0));
    // Stream 1 brings more against than for, and both together still more for.
    let mixed = [(0, LOW, 3), (1, HIGH, 3), (0, LOW, 3), (1, LOW, 1)];
    assert_eq!(decide(&mut fresh(), &mixed), Some(0));

    // Two touches of stream 1 before: what was held against them is not what is used.
    let mut together = fresh();
    assert_eq!(decide(&mut together, &[(1, HIGH, 4)]), Some(1));
    assert_eq!(decide(&mut together, &[(1, HIGH, 4)]), Some(1));
    assert_eq!(decide(&mut together, &[(0, LOW, 4)]), Some(0));
}

#[test]
fn a_stream_that_is_not_there_says_nothing() {
    let window = RuleSettings::Window(3);
    for (deciding, last) in [(Deciding::Each, 1), (Deciding::First, 0)] {
        let mut some = StreamClassifier::new(coin(None, None), window, deciding, 2).unwrap();
        for _ in 0..9 {
            assert_eq!(some.push_to(last + 1, &LOW).unwrap(), None);
            some.pass_to(last + 1, &LOW).unwrap();
            some.begin_touch(last + 1, 1);
            some.interrupt_stream(last + 1);
        }
        assert_eq!(some.touch_of(last + 1), 0);
        assert!(some.push_to(0, &[1]).is_err());
        let mut decided = (0..3).filter_map(|_| some.push_to(last, &HIGH).unwrap());
        assert_eq!(decided.next().and_then(|d| d.class()), Some(1));
    }
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let made = |rule, deciding, whiskers| {
        let made = StreamClassifier::new(coin(None, None), rule, deciding, whiskers);
        made.map(|made| made.streams())
    };
    let (window, sequential) = (
        RuleSettings::Window(3),
        RuleSettings::Sequential(threshold(0.9)),
    );
    let (each, all) = (Deciding::Each, Deciding::Together);
    assert_eq!(made(window, all, 2), Err(SetupError::WindowTogether));
    assert_eq!(made(sequential, each, 0), Err(SetupError::Whiskers(0)));
    let more = MAX_STREAMS + 1;
    assert_eq!(made(window, each, more), Err(SetupError::Whiskers(more)));
    assert_eq!(made(window, each, MAX_STREAMS), Ok(MAX_STREAMS));
    assert_eq!(made(window, Deciding::First, more), Ok(1));
}

#[test]
fn evidence_is_the_rules_own() {
    let mut each = sequential(coin(None, None), 0.999, Deciding::Each, 2);
    let fresh = each.posteriors(0);
    let strict = RuleSettings::Sequential(threshold(0.9999));
    each.push_to(0, &LOW).unwrap();
    let one = each.posteriors(0);
    assert_ne!(one, fresh);
    // Another threshold leaves it; the other rule has none of it.
    each.set_rule(strict).unwrap();
    assert_eq!(each.posteriors(0), one);
    each.set_rule(RuleSettings::Window(3)).unwrap();
    assert_eq!(each.posteriors(0), fresh);
    let mut decided = (0..3).filter_map(|_| each.push_to(0, &LOW).unwrap());
    assert_eq!(decided.next().map(|d| d.samples()), Some(3));
    let mut together = together(coin(None, None), FOUR_BITS, 2);
    let refused = together.set_rule(RuleSettings::Window(3));
    assert_eq!(refused, Err(SetupError::WindowTogether));
    let decided = (0..4).find_map(|_| together.push_to(0, &LOW).unwrap());
    assert_eq!(decided.map(|d| d.samples()), Some(4), "as before");
}

/// Two whiskers with tables of their own, whose shafts feel the same surfaces otherwise: 0 feels
/// class 0 at 100 and class 1 at 900, 1 the other way round.
fn own_tables() -> ModelBuf {
    let options = Options {
        bins: 10,
        smooth: 0.5,
        block: 4,
    };
    let mut trainer = Trainer::new(4, options).unwrap();
    for n in 0..50 {
        for (class, name) in ["a", "b"].into_iter().enumerate() {
            for whisker in 0..2 {
                let x = if class == whisker { 100.0 } else { 900.0 };
                // Three samples of ten are as of the other class.
                let x = if n % 10 < 3 { 1000.0 - x } else { x };
                trainer.add_from(name, 2 * whisker, &[x, 500.0]).unwrap();
            }
        }
    }
    trainer.train().unwrap()
}

#[test]
fn whiskers_decide_by_tables_of_their_own() {
    let model = own_tables();
    let rule = RuleSettings::Sequential(threshold(0.9));
    let deciding = |deciding| StreamClassifier::new(model.view(), rule, deciding, 2).unwrap();
    let mut each = deciding(Deciding::Each);
    for (stream, code, class) in [(0, 100, 0), (1, 100, 1), (1, 900, 0), (0, 900, 1)] {
        let decision = (0..40).find_map(|_| each.push_to(stream, &[code, 500]).unwrap());
        assert_eq!(decision.unwrap().class(), Some(class), "{stream} {code}");
    }
    // Evidence of both adds up (BIOTACT eq. 15): half the samples of one, to the block.
    let samples = |whiskers: usize, deciding| {
        let mut c = StreamClassifier::new(model.view(), rule, deciding, 2).unwrap();
        let decision = (0..80).find_map(|n| {
            let stream = n % whiskers;
            c.push_to(stream, &[[100, 900][stream], 500]).unwrap()
        });
        decision.unwrap().samples()
    };
    assert_eq!(samples(2, Deciding::Together), samples(1, Deciding::First));
    // There is no third whisker in the model, and no whisker has one channel.
    assert!(each.push_to(0, &[100]).is_err());
    let mut three = StreamClassifier::new(model.view(), rule, Deciding::Each, 3).unwrap();
    assert!(three.push_to(2, &[100, 500]).is_err());
    // By the same samples of all whiskers in one row, as the papers train.
    let mut alone = NaiveBayes::<AnyRule, _>::new(model.view(), rule).unwrap();
    assert!(alone.push(&[100, 500]).is_err());
    assert_eq!(alone.push(&[100, 500, 900, 500]), Ok(None));
}

#[test]
fn a_class_that_a_whisker_never_felt_cannot_be_trained() {
    let mut trainer = Trainer::new(4, Options::default()).unwrap();
    trainer.add("a", &[1.0, 2.0, 3.0, 4.0]).unwrap();
    trainer.add_from("b", 0, &[5.0, 6.0]).unwrap();
    let (channel, class) = (2, 1);
    let unfelt = TrainError::Unfelt { channel, class };
    assert_eq!(trainer.train().unwrap_err(), unfelt);
    let outside = trainer.add_from("b", 4, &[5.0, 6.0]);
    assert!(matches!(outside, Err(TrainError::Channels { .. })));
}
