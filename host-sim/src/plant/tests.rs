//! What tests of plants share; the ideal plant against BIOTACT eq. 11, and the list of whiskers.

use core::f64::consts::TAU;

use proptest::prelude::*;

use super::{BadSetting, Head, Ideal, Plant};

pub(in crate::plant) const TICK_S: f64 = 5e-4;

/// So many whiskers a side before an obstacle at 100 degrees.
pub(in crate::plant) fn head(whiskers_per_side: usize) -> Head {
    Head {
        whiskers_per_side,
        obstacle_deg: vec![100.0],
        stiffness: 0.1,
    }
}

/// What each of these whiskers says in two whisks of half a second, tick by tick.
pub(in crate::plant) fn readings(plant: &mut impl Plant, whiskers: usize) -> Vec<Vec<[f64; 2]>> {
    let mut all = vec![Vec::new(); whiskers];
    for n in 0..2000 {
        let angle = 95.0 - 12.0 * (f64::from(n) * TICK_S * TAU * 2.0).cos();
        plant.advance(&vec![angle; whiskers], TICK_S);
        for (w, one) in all.iter_mut().enumerate() {
            one.push(plant.deflection(w));
        }
    }
    all
}

/// The readings of so many whiskers with a seed are its own, and no whisker depends on others.
pub(in crate::plant) fn seed_decides(of: impl Fn(usize, u64) -> Vec<Vec<[f64; 2]>>) {
    let all = of(3, 5);
    assert_eq!(all, of(3, 5));
    assert_ne!(all, of(3, 6));
    assert_eq!(all[0], of(1, 5)[0], "a whisker does not depend on others");
    assert_ne!(all[0], all[1]);
}

/// Angles and a tick, s, that may be anything.
pub(in crate::plant) fn any_motion() -> impl Strategy<Value = (Vec<f64>, f64)> {
    let angle = prop_oneof![50.0..150.0, -1e7..1e7, Just(f64::NAN), Just(f64::MAX)];
    let tick_s = prop_oneof![Just(5e-3), Just(5e-5), 1e-12..1e3];
    (prop::collection::vec(angle, 1..60), tick_s)
}

/// The readings of two whiskers, of which the first moves so, stay in range.
pub(in crate::plant) fn stays_in_range(
    plant: &mut impl Plant,
    (angles, tick_s): (Vec<f64>, f64),
) -> Result<(), TestCaseError> {
    for angle in angles {
        plant.advance(&[angle], tick_s);
        let [x, y] = plant.deflection(0);
        prop_assert!(
            (-1.0..=1.0).contains(&x) && (-1.0..=1.0).contains(&y),
            "{x} {y}"
        );
        prop_assert_eq!(plant.deflection(1), [0.0; 2], "it was never moved");
    }
    Ok(())
}

fn both() -> Head {
    Head {
        whiskers_per_side: 2,
        obstacle_deg: vec![100.0, 125.0],
        stiffness: 0.1,
    }
}

#[test]
fn contact_is_equation_11_on_each_side() {
    let mut plant = Ideal::new(both()).unwrap();
    // (θ′, x on the left, x on the right)
    for (angle, left, right) in [
        (50.0, 0.0, 0.0),
        (100.0, 0.0, 0.0),
        (103.0, 0.3, 0.0),
        (110.0, 1.0, 0.0),
        (126.5, 1.0, 0.15),
        (149.7, 1.0, 1.0),
        (99.0, 0.0, 0.0),
    ] {
        plant.advance(&[angle; 4], 5e-4);
        for whisker in 0..2 {
            let [x, y] = plant.deflection(whisker);
            assert!((x - left).abs() < 1e-12 && y == 0.0, "{angle}: {x}");
            let [x, y] = plant.deflection(2 + whisker);
            assert!((x - right).abs() < 1e-12 && y == 0.0, "{angle}: {x}");
        }
    }
}

#[test]
fn whiskers_are_listed_left_side_first_and_what_is_missing_keeps_its_angle() {
    let mut plant = Ideal::new(both()).unwrap();
    plant.advance(&[101.0, 102.0, 128.0, 129.0], 5e-4);
    let x = [0, 1, 2, 3, 4].map(|n| (10.0 * plant.deflection(n)[0]).round());
    assert_eq!(x, [1.0, 2.0, 3.0, 4.0, 0.0]);
    let before = plant.clone();
    plant.advance(&[f64::NAN, f64::INFINITY], 5e-4);
    plant.advance(&[50.0; 4], 0.0);
    plant.advance(&[50.0; 4], f64::NAN);
    assert_eq!(plant, before);
    plant.advance(&[50.0; 4], 5e-4);
    assert_eq!(plant.deflection(0), [0.0; 2]);
}

#[test]
fn bad_settings_are_named() {
    let with = |change: fn(&mut Head)| {
        let mut head = both();
        change(&mut head);
        Ideal::new(head).map(|_| ())
    };
    let stiffness = Err(BadSetting("stiffness"));
    assert_eq!(with(|h| h.stiffness = -0.1), stiffness);
    assert_eq!(with(|h| h.stiffness = f64::NAN), stiffness);
    let obstacle = Err(BadSetting("obstacle_deg"));
    assert_eq!(with(|h| h.obstacle_deg[1] = f64::NAN), obstacle);
    assert_eq!(with(|_| ()), Ok(()));
}
