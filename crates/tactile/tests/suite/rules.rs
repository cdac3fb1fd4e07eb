//! The rules against closed forms, at their limits and on ties.

use crate::common::{code, ln_ratio, model, threshold, two_normals};
use tactile::{
    AnyRule, Decision, DecisionRule, Model, ModelBuf, NaiveBayes, RuleSettings, Sequential,
    SequentialRule, SetupError, Window, WindowRule,
};

#[test]
fn sequential_follows_the_closed_form() {
    let buf = two_normals(4);
    let model = buf.view();
    for theta in [0.75, 0.95, 0.999, 1.0 - 1e-8] {
        let mut c = Sequential::new(model, threshold(theta)).unwrap();
        let (mut evidence, mut block, mut samples, mut decisions) = (0.0, 0.0, 0, 0);
        for i in 0..20_000 {
            // Wanders between the classes.
            let x = 500 + ((f64::from(i) * 0.002).sin() * 90.0) as i32 + (i * 37) % 101 - 50;
            let decision = c.push(&[x]).unwrap();
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
                assert_eq!(d.class(), Some(usize::from(evidence > 0.0)));
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
fn a_perfect_tie_goes_to_the_first_class() {
    // Classes 1 and 3 are equal, 0 and 2 worse.
    let buf = model(4, 2, 2, 2, |_, _, class| [-4.0, -1.0, -3.0, -1.0][class]);
    let model = buf.view();
    let decide = |settings| {
        let mut c = NaiveBayes::<AnyRule, _>::new(model, settings).unwrap();
        (0..8).find_map(|_| c.push(&[1, 2]).unwrap())
    };
    let window = decide(RuleSettings::Window(8)).unwrap();
    assert_eq!((window.class(), window.samples()), (Some(1), 8));
    // Two equal leaders: no posterior exceeds one half, and 0.49 is exceeded
    // once the others are far enough behind.
    let sequential = |theta| decide(RuleSettings::Sequential(threshold(theta)));
    assert_eq!(sequential(0.5), None);
    let decision = sequential(0.49).unwrap();
    assert_eq!(decision.class(), Some(1));
}

#[test]
fn the_threshold_must_be_exceeded_not_met() {
    // One block gives exactly p = 2 / (2 + 1 + 1) = 1/2.
    let buf = model(3, 1, 2, 1, |_, _, class| [-1.0, -2.0, -2.0][class]);
    let model = buf.view();
    let first = |theta| {
        let mut c = Sequential::new(model, threshold(theta)).unwrap();
        c.push(&[0]).unwrap()
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
    let log2_p = |bin, _, class| if class == 2 || bin == 1 { -19.9 } else { 0.0 };
    let mut c = Sequential::new(model(3, 2, 2, 1, log2_p), threshold(0.6)).unwrap();
    for _ in 0..10_000_000 {
        assert!(c.push(&[0, 0]).unwrap().is_none());
    }
    assert_eq!(c.posteriors().as_q32(), [1 << 31, 1 << 31, 0]);
}

#[test]
fn evidence_holds_at_the_largest_sums() {
    // 10000 samples of six channels, all at the extremes of the table: the
    // longest step a block can make.
    let log2_p = |bin, _, class| if bin == class { 0.0 } else { -20.0 };
    let mut c = Sequential::new(model(2, 6, 2, 10_000, log2_p), threshold(1.0 - 1e-12)).unwrap();
    for block in 0..6 {
        let bin = block % 2;
        let decision = (0..10_000).find_map(|_| c.push(&[code(bin, 2); 6]).unwrap());
        let decision = decision.unwrap();
        assert_eq!((decision.leader(), decision.samples()), (bin, 10_000));
        assert!(decision.posterior().odds_against() < 1e-12);
    }
}

#[test]
fn window_lengths_are_checked() {
    let buf = two_normals(20);
    let model = buf.view();
    for window in [0, 1, 19, 21, 30] {
        assert_eq!(
            Window::new(model, window).unwrap_err(),
            SetupError::Window { window, block: 20 }
        );
    }
    let mut c = Window::new(model, 40).unwrap();
    let found: Vec<Option<Decision>> = (0..80).map(|_| c.push(&[700]).unwrap()).collect();
    let at: Vec<usize> = (0..80).filter(|&i| found[i].is_some()).collect();
    assert_eq!(at, [39, 79]);
    let decision = found[39].unwrap();
    assert_eq!((decision.class(), decision.samples()), (Some(1), 40));
    // Two block means of the same ratio.
    let p = 1.0 / (1.0 + (-2.0 * ln_ratio(700)).exp());
    assert!((decision.posterior().to_f64() - p).abs() < 1e-3);
}

/// A rule chosen at run time does what its own type does.
#[test]
fn any_rule_is_the_rule_itself() {
    fn same<R: DecisionRule>(buf: &ModelBuf, settings: R::Settings, any: RuleSettings) {
        let mut typed = NaiveBayes::<R, _>::new(buf.view(), settings).unwrap();
        let mut any = NaiveBayes::<AnyRule, _>::new(buf.view(), any).unwrap();
        let mut decisions = 0;
        for i in 0..2000 {
            let codes = [400 + (i * 37) % 211];
            let decision = typed.push(&codes);
            assert_eq!(any.push(&codes), decision);
            assert_eq!(any.posteriors(), typed.posteriors());
            decisions += usize::from(decision.unwrap().is_some());
        }
        assert!(decisions > 10, "{decisions}");
        (0..4).for_each(|_| _ = typed.push(&[500]));
        let even = [1 << 31; 2];
        assert_ne!(typed.posteriors().as_q32(), even);
        typed.reset();
        assert_eq!(typed.posteriors().as_q32(), even, "all is forgotten");
    }
    let buf = two_normals(4);
    let threshold = threshold(0.75);
    same::<SequentialRule>(&buf, threshold, RuleSettings::Sequential(threshold));
    same::<WindowRule>(&buf, 40, RuleSettings::Window(40));
    let wrong = NaiveBayes::<AnyRule, _>::new(buf, RuleSettings::Window(41));
    let (window, block) = (41, 4);
    assert_eq!(wrong.unwrap_err(), SetupError::Window { window, block });
}

/// A board's classifier lies in its RAM: counted in words, of which a pointer and a count are
/// one each. The second opinion takes 1.2 kB of it: 64 samples, and what was felt of a touch.
#[test]
fn a_classifier_takes_about_two_kilobytes() {
    const PC: usize = size_of::<Model>() + 2 * size_of::<u64>();
    assert!(size_of::<Sequential>() - PC <= 2_432);
    assert!(size_of::<Window>() - PC <= 2_560);
}
