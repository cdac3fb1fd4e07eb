//! The three rules against closed forms, at their limits and on ties.

mod common;

use common::{code, model};
use tactile::dynamic::{self, Classifier};
use tactile::{
    Decision, ModelBuf, Sequential, SequentialEvidence, SetupError, State, Stationary, Threshold,
    Totals, Window,
};

/// Two classes of normal codes, means 400 and 600, sd 150, in 100 bins. The
/// likelihood ratio of code x in sd units is closed: (x − 500) · 200 / 150².
fn two_normals(block: u32) -> ModelBuf {
    model(2, 1, 100, block, |bin, _, class| {
        let x = 10.0 * bin as f64 + 5.0;
        let mean = [400.0, 600.0][class];
        let z = (x - mean) / 150.0;
        // Bin width over sd times the density.
        (10.0 / 150.0 / (2.0 * std::f64::consts::PI).sqrt()).log2()
            - 0.5 * z * z * std::f64::consts::LOG2_E
    })
}

fn ln_ratio(code: i32) -> f64 {
    let middle = 10.0 * f64::from(code / 10) + 5.0;
    (middle - 500.0) * 200.0 / (150.0 * 150.0)
}

#[test]
fn sequential_follows_the_closed_form() {
    let buf = two_normals(4);
    let model = buf.model().unwrap();
    for theta in [0.75, 0.95, 0.999, 1.0 - 1e-8] {
        let rule = Sequential::<1, 2>::new(&model, Threshold::new(theta).unwrap()).unwrap();
        let mut state = rule.state();
        let (mut evidence, mut block, mut samples, mut decisions) = (0.0, 0.0, 0, 0);
        for i in 0..20_000 {
            // Wanders between the classes.
            let x = 500 + ((f64::from(i) * 0.002).sin() * 90.0) as i32 + (i * 37) % 101 - 50;
            let decision = rule.push(&mut state, &[x]);
            samples += 1;
            block += ln_ratio(x);
            if samples % 4 != 0 {
                assert_eq!(decision, None);
                continue;
            }
            evidence += block / 4.0;
            block = 0.0;
            let p = 1.0 / (1.0 + (-f64::abs(evidence)).exp());
            if let Some(d) = decision {
                assert!(p > theta - 2e-4 * (1.0 - theta), "{p} {theta}");
                assert_eq!(d.class(), usize::from(evidence > 0.0));
                assert_eq!(d.samples(), samples);
                let (odds, exact) = (d.posterior().odds_against(), (1.0 - p) / p);
                // A table entry is off by up to 2⁻¹¹ bit, a ratio by two of
                // them, and a block mean is no worse; n blocks add up.
                let bound = f64::from(samples / 4) * 2.0_f64.powi(-10);
                assert!((odds / exact).log2().abs() < bound, "{odds} {exact}");
                (evidence, samples, decisions) = (0.0, 0, decisions + 1);
            } else {
                assert!(p < theta + 2e-2 * (1.0 - theta), "{p} {theta}");
            }
        }
        assert!(decisions > 10, "{theta}: {decisions}");
    }
}

#[test]
fn posterior_can_be_watched() {
    let buf = two_normals(1);
    let model = buf.model().unwrap();
    let rule = Sequential::<1, 2>::new(&model, Threshold::new(0.9999).unwrap()).unwrap();
    let mut state = rule.state();
    assert_eq!(rule.posteriors(&state), [1 << 31; 2]);
    rule.push(&mut state, &[600]);
    let p = 1.0 / (1.0 + (-ln_ratio(600)).exp());
    let found = rule
        .posteriors(&state)
        .map(|q| f64::from(q) / 2.0_f64.powi(32));
    assert!((found[1] - p).abs() < 2e-4 && (found[0] + found[1] - 1.0).abs() < 1e-7);
    rule.reset(&mut state);
    assert_eq!(rule.posteriors(&state), [1 << 31; 2]);
}

#[test]
fn a_perfect_tie_goes_to_the_first_class() {
    // Classes 1 and 3 are equal, 0 and 2 worse.
    let buf = model(4, 2, 2, 2, |_, _, class| [-4.0, -1.0, -3.0, -1.0][class]);
    let model = buf.model().unwrap();
    let decide = |mut c: Box<dyn Classifier + '_>| (0..8).find_map(|_| c.push(&[1, 2]).unwrap());
    let window = decide(dynamic::window(&model, 8).unwrap()).unwrap();
    assert_eq!((window.class(), window.samples()), (1, 8));
    // Two equal leaders: no posterior exceeds one half, and 0.49 is exceeded
    // once the others are far enough behind.
    let sequential =
        |theta| decide(dynamic::sequential(&model, Threshold::new(theta).unwrap()).unwrap());
    assert_eq!(sequential(0.5), None);
    let decision = sequential(0.49).unwrap();
    assert_eq!(decision.class(), 1);
}

#[test]
fn the_threshold_must_be_exceeded_not_met() {
    // One block gives exactly p = 2 / (2 + 1 + 1) = 1/2.
    let buf = model(3, 1, 2, 1, |_, _, class| [-1.0, -2.0, -2.0][class]);
    let model = buf.model().unwrap();
    let first = |theta| {
        let rule = Sequential::<1, 3>::new(&model, Threshold::new(theta).unwrap()).unwrap();
        let mut state = rule.state();
        rule.push(&mut state, &[0])
    };
    assert_eq!(first(0.5), None);
    let decision = first(0.499_999).unwrap();
    assert!((decision.posterior().to_f64() - 0.5).abs() < 1e-12);
    assert_eq!(decision.samples(), 1);
}

#[test]
fn ten_million_blocks_without_a_decision_change_nothing() {
    // Each block moves class 2 by the whole range of the table, and the tie of
    // 0 and 1 keeps a decision off.
    let buf = model(
        3,
        2,
        2,
        1,
        |bin, _, class| if class == 2 || bin == 1 { -19.9 } else { 0.0 },
    );
    let model = buf.model().unwrap();
    let rule = Sequential::<2, 3>::new(&model, Threshold::new(0.6).unwrap()).unwrap();
    let mut state = rule.state();
    for _ in 0..10_000_000 {
        assert!(rule.push(&mut state, &[0, 0]).is_none());
    }
    assert_eq!(rule.posteriors(&state), [1 << 31, 1 << 31, 0]);
}

#[test]
fn evidence_holds_at_the_largest_sums() {
    // 10000 samples of six channels, all at the extremes of the table: the
    // longest step a block can make.
    let buf = model(
        2,
        6,
        2,
        10_000,
        |bin, _, class| if bin == class { 0.0 } else { -20.0 },
    );
    let model = buf.model().unwrap();
    let rule = Sequential::<6, 2>::new(&model, Threshold::new(1.0 - 1e-12).unwrap()).unwrap();
    let mut state = rule.state();
    for block in 0..6 {
        let bin = block % 2;
        let decision = (0..10_000).find_map(|_| rule.push(&mut state, &[code(bin, 2); 6]));
        let decision = decision.unwrap();
        assert_eq!((decision.class(), decision.samples()), (bin, 10_000));
        assert!(decision.posterior().odds_against() < 1e-12);
    }
}

#[test]
fn window_lengths_are_checked() {
    let buf = two_normals(20);
    let model = buf.model().unwrap();
    for window in [0, 1, 19, 21, 30] {
        assert_eq!(
            Window::<1, 2>::new(&model, window).unwrap_err(),
            SetupError::Window { window, block: 20 }
        );
    }
    let rule = Window::<1, 2>::new(&model, 40).unwrap();
    let mut state = rule.state();
    let found: Vec<Option<Decision>> = (0..80).map(|_| rule.push(&mut state, &[700])).collect();
    let at: Vec<usize> = (0..80).filter(|&i| found[i].is_some()).collect();
    assert_eq!(at, [39, 79]);
    let decision = found[39].unwrap();
    assert_eq!((decision.class(), decision.samples()), (1, 40));
    // Two block means of the same ratio.
    let p = 1.0 / (1.0 + (-2.0 * ln_ratio(700)).exp());
    assert!((decision.posterior().to_f64() - p).abs() < 1e-3);
}

#[test]
fn other_shapes_are_refused() {
    let buf = two_normals(20);
    let model = buf.model().unwrap();
    assert_eq!(
        Window::<2, 2>::new(&model, 20).unwrap_err(),
        SetupError::Channels {
            model: 1,
            classifier: 2
        }
    );
    assert_eq!(
        Stationary::<1, 3>::new(&model).unwrap_err(),
        SetupError::Classes {
            model: 2,
            classifier: 3
        }
    );
}

#[test]
fn stationary_sums_whole_whisks() {
    let buf = two_normals(20);
    let model = buf.model().unwrap();
    let rule = Stationary::<1, 2>::new(&model).unwrap();
    let mut state = rule.state();
    assert_eq!(rule.finish(&mut state), None);
    // Every sample in full, whatever the block.
    let codes = [430, 560, 610, 480, 390, 520, 515];
    let ratio: f64 = codes.map(ln_ratio).iter().sum();
    for code in codes {
        assert_eq!(rule.push(&mut state, &[code]), None);
    }
    let decision = rule.finish(&mut state).unwrap();
    assert_eq!(decision.class(), usize::from(ratio > 0.0));
    assert_eq!(decision.samples(), 7);
    let p = 1.0 / (1.0 + (-ratio.abs()).exp());
    assert!((decision.posterior().to_f64() - p).abs() < 2e-3);
    // And it starts again from nothing.
    assert_eq!(rule.finish(&mut state), None);
    rule.push(&mut state, &[700]);
    let decision = rule.finish(&mut state).unwrap();
    assert_eq!((decision.class(), decision.samples()), (1, 1));
}

#[test]
fn stationary_outlasts_a_word() {
    // Class 1 leads by one table unit a sample and channel; past 2³² in sum.
    let unit = 1.0 / 1024.0;
    let buf = model(
        2,
        12,
        2,
        20,
        |_, _, class| if class == 1 { 0.0 } else { -unit },
    );
    let model = buf.model().unwrap();
    let rule = Stationary::<12, 2>::new(&model).unwrap();
    let mut state = rule.state();
    let samples = 20_000;
    for _ in 0..samples {
        rule.push(&mut state, &[3; 12]);
    }
    let decision = rule.finish(&mut state).unwrap();
    assert_eq!((decision.class(), decision.samples()), (1, samples));
    assert!(decision.posterior().odds_against() < 1e-15);
    for _ in 0..10 {
        rule.push(&mut state, &[3; 12]);
    }
    let odds = rule.finish(&mut state).unwrap().posterior().odds_against();
    assert!((odds / (-120.0 * unit).exp2() - 1.0).abs() < 1e-5);
}

#[test]
fn state_is_a_few_words_a_class() {
    const fn words<T>() -> usize {
        size_of::<T>() / 4
    }
    assert_eq!(words::<State<SequentialEvidence<4>, 4>>(), 2 * 4 + 2);
    assert_eq!(words::<State<SequentialEvidence<9>, 9>>(), 2 * 9 + 2);
    // Double words, so padded to an even number.
    assert_eq!(words::<State<Totals<4>, 4>>(), 3 * 4 + 4);
    assert_eq!(words::<State<Totals<9>, 9>>(), 3 * 9 + 3);
}
