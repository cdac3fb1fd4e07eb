//! Scores against tables worked by hand.

use tactile::score::{Calibration, Confusion, Interval, ScoreError, Statistics};

fn matrix(rows: &[&[u64]]) -> Confusion {
    let mut confusion = Confusion::new(rows.len());
    for (truth, row) in rows.iter().enumerate() {
        for (named, &times) in row.iter().enumerate() {
            for _ in 0..times {
                confusion.add(truth, Some(named)).unwrap();
            }
        }
    }
    confusion
}

/// Tables worked by hand. P_O = 35/50, P_E = 0.5·0.6 + 0.5·0.4 = 0.5; P_O = 0.79, P_E =
/// (30·34 + 50·48 + 20·18)/10⁴ = 0.378; and of two choices κ of 0.5 is a hit rate of 75 % (POSE).
#[test]
fn kappa_is_that_of_worked_tables() {
    let three = (0.79 - 0.378) / (1.0 - 0.378);
    for (rows, kappa) in [
        (&[&[20, 5][..], &[10, 15]][..], Some(0.4)),
        (&[&[26, 3, 1], &[6, 40, 4], &[2, 5, 13]], Some(three)),
        (&[&[3, 1], &[1, 3]], Some(0.5)),
        (&[&[1, 1], &[1, 1]], Some(0.0)),
        (&[&[0, 1], &[1, 0]], Some(-1.0)),
        (&[&[5, 0], &[0, 0]], None),
        (&[&[0, 0], &[0, 0]], None),
    ] {
        let found = matrix(rows).kappa();
        assert_eq!(found.is_some(), kappa.is_some(), "{rows:?}");
        let off = found.unwrap_or_default() - kappa.unwrap_or_default();
        assert!(off.abs() < 1e-15, "{rows:?}");
    }
    let confusion = matrix(&[&[20, 5], &[10, 15]]);
    assert_eq!(confusion.hit_rate(), Some(0.7));
    assert_eq!(confusion.hit_rate_of(1), Some(0.6));
    // A swap of columns and rows shows.
    assert_eq!(confusion.count(1, 0), 10);
    assert_eq!(Confusion::new(0).hit_rate(), None);
}

#[test]
fn missed_trials_are_no_hits_and_not_in_kappa() {
    let mut confusion = matrix(&[&[3, 1], &[1, 3]]);
    confusion.add(0, None).unwrap();
    confusion.add(0, None).unwrap();
    assert_eq!(confusion.hit_rate(), Some(0.6));
    assert_eq!(confusion.hit_rate_of(0), Some(0.5));
    assert_eq!(confusion.kappa(), Some(0.5));
    assert_eq!((confusion.trials(), confusion.named()), (10, 8));
    let whole = confusion.clone();
    confusion.merge(&whole).unwrap();
    assert_eq!((confusion.trials(), confusion.missed(0)), (20, 4));
}

#[test]
fn errors_are_named_minus_true() {
    // Twice right, once 10° too much, once 20° too little.
    let confusion = matrix(&[&[1, 1, 0], &[0, 1, 0], &[1, 0, 0]]);
    let s = confusion.errors(&[10.0, 20.0, 30.0]).unwrap();
    assert_eq!((s.count, s.mean), (4, -2.5));
    // Squares about the mean: 6.25 + 156.25 + 6.25 + 306.25 = 475.
    assert!((s.sd - (475.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    assert!((s.rms - 125.0_f64.sqrt()).abs() < 1e-12);
    assert_eq!(confusion.errors(&[1.0, 2.0]), None);
}

#[test]
fn far_from_zero_the_spread_keeps_its_precision() {
    let s = Statistics::of([1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0]).unwrap();
    assert_eq!((s.mean, s.sd), (1e9 + 2.0, 1.0));
    assert_eq!(
        Statistics::of([4.0]).map(|s| (s.sd, s.rms)),
        Some((0.0, 4.0))
    );
    assert_eq!(Statistics::of([]), None);
}

#[test]
fn classes_that_are_not_there_are_refused() {
    let mut confusion = Confusion::new(2);
    let wrong = |class| Err(ScoreError::Class { class, classes: 2 });
    assert_eq!(confusion.add(2, Some(0)), wrong(2));
    assert_eq!(confusion.add(0, Some(7)), wrong(7));
    assert_eq!(confusion.add(3, None), wrong(3));
    assert_eq!(confusion.trials(), 0);
    let (ours, theirs) = (2, 3);
    let merged = confusion.merge(&Confusion::new(3));
    assert_eq!(merged, Err(ScoreError::Classes { ours, theirs }));
    assert_eq!((confusion.count(5, 0), confusion.count(0, 5)), (0, 0));
    assert_eq!(confusion.missed(9), 0);
}

/// Wilson's intervals of tables: 8 of 10 and 0 of 10.
#[test]
fn intervals_are_those_of_wilson() {
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 5e-5, "{found}");
    let interval = Interval::of(8, 10);
    near(interval.low, 0.4902);
    near(interval.high, 0.9433);
    let none = Interval::of(0, 10);
    near(none.low, 0.0);
    near(none.high, 0.2775);
    let nothing = Interval::of(0, 0);
    assert!(nothing.share.is_nan());
    assert_eq!((nothing.low, nothing.high), (0.0, 1.0));
}

/// Four decisions of 0.96, two of 0.992: stated (4 · 0.96 + 2 · 0.992)/6, found 5/6, and
/// apart by 0.21 in the one bin and by 0.008 in the other.
#[test]
fn calibration_of_a_worked_table() {
    let four = [true, true, true, false].map(|right| (0.96, right));
    let two = [(0.992, true); 2];
    let calibration = Calibration::of(four.into_iter().chain(two));
    assert!((calibration.stated - (4.0 * 0.96 + 2.0 * 0.992) / 6.0).abs() < 1e-12);
    assert_eq!(calibration.found, Interval::of(5, 6));
    let bins: Vec<_> = calibration
        .bins
        .iter()
        .map(|bin| (bin.low, bin.high, bin.found.count))
        .collect();
    assert_eq!(bins, [(0.95, 0.98, 4), (0.99, 0.995, 2)]);
    assert!((calibration.error() - (4.0 * 0.21 + 2.0 * 0.008) / 6.0).abs() < 1e-12);
    let certain = Calibration::of([(1.0, true)].into_iter());
    assert_eq!(certain.error(), 0.0);
    assert!(Calibration::of([].into_iter()).error().is_nan());
}
