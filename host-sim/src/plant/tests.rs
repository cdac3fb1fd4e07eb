//! The ideal plant against BIOTACT eq. 11, and the list of whiskers.

use super::{BadSetting, Head, Ideal, Plant};

fn head() -> Head {
    Head {
        whiskers_per_side: 2,
        obstacle_deg: vec![100.0, 125.0],
        stiffness: 0.1,
    }
}

#[test]
fn contact_is_equation_11_on_each_side() {
    let mut plant = Ideal::new(head()).unwrap();
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
            let [x, y] = plant.deflection(0, whisker);
            assert!((x - left).abs() < 1e-12 && y == 0.0, "{angle}: {x}");
            let [x, y] = plant.deflection(1, whisker);
            assert!((x - right).abs() < 1e-12 && y == 0.0, "{angle}: {x}");
        }
    }
}

#[test]
fn whiskers_are_listed_left_side_first() {
    let mut plant = Ideal::new(head()).unwrap();
    plant.advance(&[101.0, 102.0, 128.0, 129.0], 5e-4);
    let x = |side, whisker| (10.0 * plant.deflection(side, whisker)[0]).round();
    assert_eq!([x(0, 0), x(0, 1), x(1, 0), x(1, 1)], [1.0, 2.0, 3.0, 4.0]);
    assert_eq!([x(0, 2), x(2, 0), x(9, 9)], [0.0; 3]);
}

#[test]
fn what_is_missing_keeps_its_angle() {
    let mut plant = Ideal::new(head()).unwrap();
    plant.advance(&[101.0, 102.0, 128.0, 129.0], 5e-4);
    let before = plant.clone();
    plant.advance(&[f64::NAN, f64::INFINITY], 5e-4);
    plant.advance(&[50.0; 4], 0.0);
    plant.advance(&[50.0; 4], f64::NAN);
    assert_eq!(plant, before);
    plant.advance(&[50.0; 4], 5e-4);
    assert_eq!(plant.deflection(0, 0), [0.0; 2]);
}

#[test]
fn a_free_head_feels_nothing() {
    let mut plant = Ideal::new(Head::free(2, 3)).unwrap();
    plant.advance(&[1e5; 6], 5e-4);
    assert!((0..6).all(|i| plant.deflection(i / 3, i % 3) == [0.0; 2]));
}

#[test]
fn bad_settings_are_named() {
    let with = |change: fn(&mut Head)| {
        let mut head = head();
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
