//! The stationary rule against closed forms and at its limits.

use crate::common::{ln_ratio, model, two_normals};
use classifiers::Stationary;
use proptest::prelude::*;

#[test]
fn stationary_sums_whole_whisks() {
    let buf = two_normals(20);
    let model = buf.view();
    let mut c = Stationary::new(model, ()).unwrap();
    assert_eq!(c.finish(), None);
    // Every sample in full, whatever the block.
    let codes = [430, 560, 610, 480, 390, 520, 515];
    let ratio: f64 = codes.map(ln_ratio).iter().sum();
    for code in codes {
        assert_eq!(c.push(&[code]).unwrap(), None);
    }
    let decision = c.finish().unwrap();
    assert_eq!(decision.leader(), usize::from(ratio > 0.0));
    assert_eq!(decision.samples(), 7);
    let p = 1.0 / (1.0 + (-ratio.abs()).exp());
    assert!((decision.posterior().to_f64() - p).abs() < 2e-3);
    // And it starts again from nothing.
    assert_eq!(c.finish(), None);
    c.push(&[700]).unwrap();
    let decision = c.finish().unwrap();
    assert_eq!((decision.leader(), decision.samples()), (1, 1));
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
    let model = buf.view();
    let mut c = Stationary::new(model, ()).unwrap();
    let samples = 20_000;
    for _ in 0..samples {
        c.push(&[3; 12]).unwrap();
    }
    let decision = c.finish().unwrap();
    assert_eq!((decision.leader(), decision.samples()), (1, samples));
    assert!(decision.posterior().odds_against() < 1e-15);
    for _ in 0..10 {
        c.push(&[3; 12]).unwrap();
    }
    let odds = c.finish().unwrap().posterior().odds_against();
    assert!((odds / (-120.0 * unit).exp2() - 1.0).abs() < 1e-5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A channel that says nothing changes nothing. Odd and even numbers of
    /// classes.
    #[test]
    fn any_number_of_channels_gives_the_same_bits(
        classes in 2_usize..=32,
        table in prop::collection::vec(0.0_f64..19.9, 8 * 2 * 32),
        codes in prop::collection::vec((-100_i32..1100, any::<i32>()), 200),
    ) {
        let entry = |bin: usize, channel: usize, class: usize| -table[(bin * 2 + channel) * 32 + class];
        let two = model(classes, 2, 8, 10, entry);
        let three = model(classes, 3, 8, 10, |bin, channel, class| {
            if channel < 2 { entry(bin, channel, class) } else { -7.0 }
        });
        let mut two = Stationary::new(two, ()).unwrap();
        let mut three = Stationary::new(three, ()).unwrap();
        for &(x, y) in &codes {
            two.push(&[x, y]).unwrap();
            three.push(&[x, y, x ^ y]).unwrap();
        }
        prop_assert_eq!(two.posteriors(), three.posteriors());
        prop_assert_eq!(two.finish().unwrap(), three.finish().unwrap());
    }
}
