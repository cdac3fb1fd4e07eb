//! Features against closed forms, polynomials against exact ones and NumPy,
//! and the board against the PC.

use std::f64::consts::TAU;

use classifiers::Error;
use classifiers::feature_train::{Extractor, FeatureSettings};
use classifiers::features::{Feature, FeatureRule};
use classifiers::regression::Regression;
use proptest::prelude::*;

const RATE: f64 = 4000.0;
const BLOCK: usize = 2000;

fn settings() -> FeatureSettings {
    FeatureSettings::pose(2.0, 0.1, RATE, BLOCK).unwrap()
}

/// Rest, a ramp from sample 500 to a peak at sample 699, rest; and a vibration
/// of 80 Hz, which is bin 40, over the whole block.
fn contact(peak: f64, vibration: f64) -> Vec<f64> {
    (0..BLOCK)
        .map(|n| {
            let ramp = if (500..700).contains(&n) {
                peak * (n - 499) as f64 / 200.0
            } else {
                0.0
            };
            2.0 + ramp + vibration * (TAU * 80.0 * n as f64 / RATE).sin()
        })
        .collect()
}

#[test]
fn features_of_a_ramp_and_a_sine() {
    let mut extractor = Extractor::new(settings()).unwrap();
    let [f1, f2, ..] = extractor.features(&contact(3.0, 0.0)).unwrap();
    assert!((f1 - 3.0).abs() < 1e-12);
    // 0.1 is reached by the seventh sample of the ramp, 194 before the end:
    // 3 · 7 / 200 = 0.105.
    assert!((f2 - 3.0 * RATE / 194.0).abs() < 1e-9, "{f2}");

    let [f1, _, f3, f4, f5] = extractor.features(&contact(0.0, 0.05)).unwrap();
    // 80 Hz at 4 kHz: 50 samples a turn, and none falls on its top.
    assert!(
        (f1 - 0.05 * (TAU * 12.0 / 50.0).sin()).abs() < 1e-12,
        "{f1}"
    );
    assert!((f3 - 80.0).abs() < 1e-9);
    assert!((f4 - 0.05 * 1000.0).abs() < 1e-9);
    assert!((f5 - f4).abs() < 1e-7, "nothing in the other bins: {f5}");
    let bins = settings().bins;
    assert_eq!((bins.first, bins.count), (3, 498));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn the_board_takes_the_same_features(peak in 0.5_f64..4.0, vibration in 0.01_f64..0.5, at in 0_usize..BLOCK) {
        let mut signal = contact(peak, vibration);
        signal[at] += 0.3;
        let exact = Extractor::new(settings()).unwrap().features(&signal).unwrap();
        let features = settings().features::<498>().unwrap();
        let mut state = features.state();
        let found: Vec<_> = signal.iter().filter_map(|&x| features.push(&mut state, x as f32)).collect();
        prop_assert_eq!(found.len(), 1);
        prop_assert_eq!(state, features.state());
        let all: f64 = signal.iter().map(|x| (x - 2.0).abs()).sum();
        // Where single precision tells the peak and the contact from the next.
        let near_peak = signal.iter().filter(|&x| x - 2.0 > exact[0] - 1e-6).count();
        let near_onset = signal.iter().filter(|&x| (x - 2.1).abs() < 1e-6).count();
        prop_assume!(near_peak == 1 && near_onset == 0);
        let bounds = [1e-6, 1e-6 * exact[1].abs(), 1e-3, 3e-6 * all, 3e-6 * all * 498.0];
        for (n, ((found, exact), bound)) in found[0].iter().zip(exact).zip(bounds).enumerate() {
            let off = (f64::from(*found) - exact).abs();
            prop_assert!(off <= bound, "f{}: {} for {}, {}", n + 1, found, exact, bound);
        }
    }

    /// All products up to degree two of two features, any coefficients: found
    /// again to rounding, however different the features' sizes.
    #[test]
    fn a_polynomial_is_recovered(c in prop::array::uniform6(-3.0_f64..3.0), size in -6_i32..6) {
        let unit = 10_f64.powi(size);
        let exact = |x: f64, y: f64| c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
        let examples: Vec<(Vec<f64>, f64)> = (0..30)
            .map(|n| {
                let (x, y) = (f64::from(n % 6) - 1.0, f64::from(n / 6) * 0.5);
                (vec![x * unit, y], exact(x, y))
            })
            .collect();
        let fitted = Regression::fit(2, &examples).unwrap();
        prop_assert_eq!(fitted.terms().len(), 6);
        let terms = fitted.single_terms::<2>().unwrap();
        let single = fitted.polynomial(&terms).unwrap();
        for (x, y) in [(0.3, 0.7), (4.0, 1.9), (-1.0, 0.0), (7.5, 3.0)] {
            let found = fitted.value(&[x * unit, y]);
            prop_assert!((found - exact(x, y)).abs() < 1e-10, "{found} {}", exact(x, y));
            let found = f64::from(single.value(&[(x * unit) as f32, y as f32]));
            prop_assert!((found - exact(x, y)).abs() < 1e-3, "{found} {}", exact(x, y));
        }
        prop_assert!(fitted.polynomial::<3>(&[]).is_none());
    }
}

/// Noisy examples, whose best fit NumPy knows: fit/regression.py.
#[test]
fn numpy_fits_the_same() {
    for (degree, file) in [
        (2, include_str!("../reference/regression_2.csv")),
        (4, include_str!("../reference/regression_4.csv")),
    ] {
        let rows: Vec<Vec<f64>> = file
            .lines()
            .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
            .collect();
        let examples: Vec<_> = rows.iter().map(|r| (r[..3].to_vec(), r[3])).collect();
        let fitted = Regression::fit(degree, &examples).unwrap();
        assert_eq!(fitted.terms().len(), if degree == 2 { 10 } else { 35 });
        for row in &rows {
            let found = fitted.value(&row[..3]);
            assert!((found - row[4]).abs() < 1e-8, "{found} {}", row[4]);
            assert!((row[3] - row[4]).abs() > 1e-6, "noise is in the examples");
        }
    }
}

#[test]
fn what_the_examples_do_not_say_is_not_made_up() {
    // The second feature never changes; the third is the first again.
    let examples: Vec<_> = (0..9)
        .map(|n| (vec![f64::from(n), 5.0, f64::from(n)], f64::from(n)))
        .collect();
    let fitted = Regression::fit(2, &examples).unwrap();
    for x in [2.5, 7.0] {
        assert!((fitted.value(&[x, 5.0, x]) - x).abs() < 1e-9);
        assert!((fitted.value(&[x, 99.0, x]) - x).abs() < 1e-9);
    }
}

/// Speed by peak deflection, as in POSE.
#[test]
fn classes_are_trained_and_the_board_names_the_same() {
    let mut extractor = Extractor::new(settings()).unwrap();
    let mut peak_of = |signal: &[f64]| vec![Feature::Peak.of(&extractor.features(signal).unwrap())];
    // Peaks that grow with the root of the class: a second-degree relation.
    let peak = |class: usize| (1.0 + class as f64).sqrt();
    let mut examples = Vec::new();
    for class in 0..5 {
        for vibration in [0.01, 0.02] {
            let features = peak_of(&contact(peak(class), vibration));
            examples.push((features, class as f64));
        }
    }
    let trained = Regression::fit(2, &examples).unwrap();
    let features = settings().features::<498>().unwrap();
    let terms = trained.single_terms::<1>().unwrap();
    let rule = FeatureRule {
        chosen: [Feature::Peak],
        polynomial: trained.polynomial(&terms).unwrap(),
        classes: 5,
    };
    let named = |signal: &[f64]| {
        let mut state = features.state();
        let found = signal
            .iter()
            .find_map(|&x| features.push(&mut state, x as f32));
        rule.estimate(&found.unwrap())
    };
    for class in 0..5 {
        let signal = contact(peak(class) + 0.02, 0.012);
        let value = trained.value(&peak_of(&signal));
        assert!((value - class as f64).abs() < 0.2, "{value}");
        let estimate = named(&signal);
        assert_eq!(estimate.class, class);
        assert!((f64::from(estimate.value) - value).abs() < 1e-4);
    }
    assert_eq!(named(&contact(9.0, 0.01)).class, 4, "beyond the last");
}

#[test]
fn every_feature_is_its_own() {
    let five = [1, 2, 3, 4, 5];
    assert_eq!(Feature::ALL.map(|f| f.of(&five)), five);
}

#[test]
fn what_is_wrong_is_named() {
    let wrong = FeatureSettings {
        rate_hz: 0.0,
        ..settings()
    };
    assert_eq!(Extractor::new(wrong).err(), Some(Error::Setting));
    let wrong = FeatureSettings {
        rest: f64::NAN,
        ..settings()
    };
    assert_eq!(Extractor::new(wrong).err(), Some(Error::Setting));
    assert!(FeatureSettings::pose(0.0, 0.1, 1500.0, BLOCK).is_err());
    assert!(settings().features::<497>().is_err());
    assert_eq!(Regression::fit(2, &[]).err(), Some(Error::NoSamples));
    let short = Error::Short {
        found: 1,
        needed: BLOCK,
    };
    let mut extractor = Extractor::new(settings()).unwrap();
    assert_eq!(extractor.features(&[0.0]), Err(short));
    let none = Regression::fit(2, &[(Vec::new(), 0.0)]);
    assert_eq!(none.err(), Some(Error::Feature(0)));
    let one = [(vec![1.0], 1.0)];
    assert_eq!(Regression::fit(0, &one).err(), Some(Error::Degree(0)));
    assert_eq!(Regression::fit(9, &one).err(), Some(Error::Degree(9)));
    let wide = [(vec![1.0; 64], 1.0)];
    assert_eq!(Regression::fit(8, &wide).err(), Some(Error::Degree(8)));
    let unlike = [(vec![1.0], 1.0), (vec![1.0, 2.0], 1.0)];
    assert_eq!(Regression::fit(2, &unlike).err(), Some(Error::Feature(2)));
    let bad = Error::NotFinite {
        sample: 0,
        channel: 1,
    };
    assert_eq!(
        Regression::fit(2, &[(vec![1.0], f64::NAN)]).err(),
        Some(bad)
    );
    let far = [(vec![f64::MAX], 1.0), (vec![-f64::MAX], 2.0)];
    assert!(Regression::fit(2, &far).is_err_and(|e| matches!(e, Error::Range)));
}
