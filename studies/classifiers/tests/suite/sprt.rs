//! The sequential probability ratio test against Wald's bounds and against the product's rule.

use classifiers::recogniser::{Bayes, Recogniser, outcomes};
use classifiers::sprt::Sprt;
use tactile::train::{Options, Trainer};
use tactile::{ModelBuf, SequentialRule, Threshold};

/// A generator of evenly spread numbers in 0..1.
fn uniform(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// A normal number times 100, plus a mean: the sum of twelve uniform ones.
fn normal(state: &mut u64, mean: f64) -> f64 {
    let sum: f64 = (0..12).map(|_| uniform(state)).sum();
    100.0 * (sum - 6.0) + mean
}

/// Two classes of normal numbers, a quarter of a standard deviation apart, by samples of 1.
fn model() -> ModelBuf {
    let options = Options {
        bins: 60,
        smooth: 0.5,
        block: 1,
    };
    let mut trainer = Trainer::new(1, options).unwrap();
    let mut state = 7;
    for (name, mean) in [("a", 0.0), ("b", 25.0)] {
        // So many that what tables have by chance is nothing beside what classes differ by.
        for _ in 0..400_000 {
            trainer.add(name, &[normal(&mut state, mean)]).unwrap();
        }
    }
    trainer.train().unwrap()
}

/// Share of decisions for the wrong class where `class` is true, and the mean samples of one.
fn errors(sprt: &mut Sprt, class: usize, seed: u64) -> (f64, f64) {
    let mut state = seed;
    let mean = 25.0 * class as f64;
    let stream: Vec<f64> = (0..1_000_000).map(|_| normal(&mut state, mean)).collect();
    let found = outcomes(sprt, &stream, 1);
    let wrong = found.iter().filter(|one| one.class != class).count() as f64;
    let samples: u32 = found.iter().map(|one| one.samples).sum();
    let count = found.len() as f64;
    (wrong / count, f64::from(samples) / count)
}

#[test]
fn errors_are_within_walds_bounds_and_times_are_his() {
    let model = model();
    let mut sprt = Sprt::new(model.view(), 0.95, 1.0).unwrap();
    for class in [0, 1] {
        let (wrong, samples) = errors(&mut sprt, class, 11 + class as u64);
        // 1 − θ at most; overshoot makes it less, by about exp(−0.583 d), d = 0.25.
        assert!((0.038..0.05).contains(&wrong), "{wrong}");
        // ((1 − α) log((1 − α)/α) + α log(α/(1 − α))) over the divergence d²/2, and overshoot.
        let walds = 0.9 * 19.0_f64.ln() / 0.03125;
        assert!(
            (0.97..1.12).contains(&(samples / walds)),
            "{samples} {walds}"
        );
    }
}

/// With HR = 4, H₁ starts nearer to its threshold: wrong decisions for H₂ become rarer by that.
#[test]
fn a_prior_ratio_moves_errors_from_the_likely_class_to_the_other() {
    let model = model();
    let mut sprt = Sprt::new(model.view(), 0.95, 4.0).unwrap();
    let (likely, quick) = errors(&mut sprt, 0, 21);
    let (other, slow) = errors(&mut sprt, 1, 22);
    // From log 4 the way to log 19 is log 4.75, to −log 19 log 76: Wald's α and β.
    let (up, down) = (4.75_f64, 1.0 / 76.0);
    let walds = [(up - 1.0) * down / (up - down), (1.0 - down) / (up - down)];
    assert!(
        (0.75..1.1).contains(&(likely / walds[0])),
        "{likely} {walds:?}"
    );
    assert!(
        (0.8..1.0).contains(&(other / walds[1])),
        "{other} {walds:?}"
    );
    assert!(quick < slow);
}

/// LEP12, below eq. 8: for two choices, eq. 8 is eq. 2.
#[test]
fn for_two_classes_it_is_the_products_rule() {
    let model = model();
    let threshold = Threshold::new(0.95).unwrap();
    let mut rule = Bayes::<SequentialRule>::new(model.view(), threshold).unwrap();
    let mut sprt = Sprt::new(model.view(), 0.95, 1.0).unwrap();
    let mut state = 5;
    let (mut alike, mut all) = (0, 0);
    for n in 0..100_000 {
        let x = [normal(&mut state, 12.5 + f64::from(n % 2))];
        let (ours, theirs) = (sprt.push(&x), rule.push(&x));
        all += usize::from(ours.is_some() || theirs.is_some());
        alike += usize::from(ours.is_some() && ours == theirs);
        if ours != theirs {
            sprt.reset();
            rule.reset();
        }
    }
    // Tables in fixed point, and thresholds to 2⁻²⁴.
    assert!(all > 500 && alike * 1000 >= all * 998, "{alike} of {all}");
}

#[test]
fn what_is_no_threshold_or_prior_is_refused() {
    let model = model();
    for (theta, prior) in [
        (0.5, 1.0),
        (1.0, 1.0),
        (f64::NAN, 1.0),
        (0.9, 0.0),
        (0.9, -1.0),
    ] {
        assert!(
            Sprt::new(model.view(), theta, prior).is_err(),
            "{theta} {prior}"
        );
    }
}
