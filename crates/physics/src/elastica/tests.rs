use super::path::STEPS;
use super::{MOST_TAPER, Press, PressError, Pressed};
use crate::error::BadSetting;
use crate::vector::{V3, dot, length, sub};
use crate::{Biotact, Shaft};

/// BIOTACT's middle whisker before a plate of this slant, tilt and friction.
fn middle([slant_deg, tilt_deg, friction]: [f64; 3]) -> Press {
    Press {
        shaft: Shaft::biotact(Biotact::Middle),
        slant_deg,
        tilt_deg,
        friction,
    }
}

fn one(press: &Press, push_deg: f64) -> Pressed {
    press.at(&[push_deg]).unwrap().remove(0)
}

/// Largest relative difference of two in moment, normal force, contact and place.
fn apart(a: &Pressed, b: &Pressed) -> f64 {
    let all = |p: &Pressed| {
        let [x, y] = p.moment_n_m;
        [(x * x + y * y).sqrt(), p.normal_n, p.contact_m]
    };
    let pairs = all(a).into_iter().zip(all(b));
    pairs.fold(0.0, |most: f64, (a, b)| most.max((a / b - 1.0).abs()))
}

#[test]
fn a_small_push_is_linear() {
    // The tip compliance of a cone is L³/(3 E I) · hub/tip, that of the follicle L²/k.
    let shaft = Shaft::biotact(Biotact::Middle);
    let square = shaft.hub_diameter_m * shaft.hub_diameter_m;
    let rigidity = shaft.youngs_pa * core::f64::consts::PI * square * square / 64.0;
    let l = shaft.length_m;
    let give = 8.0 * l * l * l / (3.0 * rigidity) + l * l / shaft.follicle.rotation_n_m_rad;
    for slant in [1.0_f64, 30.0, 70.0] {
        let found = one(&middle([slant, 0.0, 0.0]), 1e-4);
        let expected = l * 1e-4_f64.to_radians() / give / slant.to_radians().cos();
        assert!((found.normal_n / expected - 1.0).abs() < 1e-4, "{slant}");
    }
}

#[test]
fn more_steps_change_nothing() {
    for (taper, bound) in [(1.0, 1e-8), (8.0, 5e-8), (30.0, 2e-7), (MOST_TAPER, 2e-6)] {
        for (slant, friction) in [(30.0, 0.0), (60.0, 0.0), (45.0, 0.5)] {
            let mut press = middle([slant, 0.0, friction]);
            press.shaft.tip_diameter_m = press.shaft.hub_diameter_m / taper;
            let pushes = [1.0, 10.0, 40.0];
            let coarse = press.at(&pushes).unwrap();
            let fine = press.solve(&pushes, 8 * STEPS).unwrap();
            for (coarse, fine) in coarse.iter().zip(&fine) {
                let apart = apart(coarse, fine);
                assert!(apart < bound, "taper {taper}, slant {slant}: {apart}");
            }
        }
    }
}

/// Without friction only the angle between shaft and normal counts: a tilted plate bends the
/// shaft as one of a smaller slant does at some other push.
#[test]
fn a_tilt_is_another_slant() {
    let (slant, tilt) = (30.0_f64.to_radians(), 25.0_f64.to_radians());
    let same = |angle: f64| (tilt.cos() * angle.sin()).asin();
    for push in [5.0_f64, 20.0, 40.0] {
        let tilted = one(&middle([30.0, 25.0, 0.0]), push);
        let other = same(slant + push.to_radians()) - same(slant);
        let level = middle([same(slant).to_degrees(), 0.0, 0.0]);
        let apart = apart(&tilted, &one(&level, other.to_degrees()));
        assert!(apart < 1e-8, "{push}: {apart}");
        let mirrored = one(&middle([30.0, -25.0, 0.0]), push);
        assert_eq!(tilted.moment_n_m, mirrored.moment_n_m);
        assert!(tilted.moment_n_m[1] > 0.0);
    }
}

#[test]
fn friction_holds_a_small_tilt_and_goes_over_into_sliding() {
    let pushes = [5.0, 25.0];
    let at = |tilt: f64| middle([30.0, tilt, 0.3]).at(&pushes).unwrap();
    let (level, small) = (at(0.0), at(1e-3));
    let more = middle([30.0, 0.0, 0.0]).at(&pushes).unwrap();
    // tan q √(cos² q cos² b + sin² q) = μ cos b at the end of holding.
    let end = |q: f64| {
        let (level, up) = (q.cos() * 30.0_f64.to_radians().cos(), q.sin());
        q.tan() * (level * level + up * up).sqrt() - 0.3 * 30.0_f64.to_radians().cos()
    };
    let (mut low, mut high) = (0.0, 0.5);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if end(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (held, slides) = (at(low.to_degrees() - 1e-7), at(low.to_degrees() + 1e-7));
    for n in 0..2 {
        assert!(apart(&level[n], &small[n]) < 1e-7);
        assert!(apart(&held[n], &slides[n]) < 1e-6);
        assert_eq!(held[n].moment_n_m[1], 0.0);
        assert!(slides[n].moment_n_m[1] >= 0.0);
        // Away from the base it turns the force across the shaft.
        assert!(level[n].moment_n_m[0] > 1.02 * more[n].moment_n_m[0]);
        assert_eq!(level[n].friction_n, 0.3 * level[n].normal_n);
    }
}

#[test]
fn points_are_a_curve_of_the_shafts_length_before_the_plate() {
    let tip: V3 = [0.112, 0.0, 0.0];
    for setting in [[30.0, 0.0, 0.0], [30.0, 20.0, 0.2], [60.0, -10.0, 0.5]] {
        let press = middle(setting);
        let (normal, _) = press.directions();
        for found in press.at(&[0.0, 3.0, 20.0, 40.0]).unwrap() {
            let points = &found.points_m;
            assert_eq!(points[0], [0.0; 4]);
            assert!((points[points.len() - 1][0] - 0.112).abs() < 1e-15);
            let mut way = 0.0;
            for pair in points.windows(2) {
                let at = |[_, x, y, z]: [f64; 4]| [x, y, z];
                let (a, b) = (at(pair[0]), at(pair[1]));
                way += length(sub(b, a));
                assert!(dot(sub(b, tip), normal) > -1e-9 * 0.112);
                if (pair[1][0] - found.contact_m).abs() < 1e-15 {
                    assert!(dot(sub(b, tip), normal).abs() < 1e-10);
                }
            }
            assert!((way - 0.112).abs() < 1e-4 * 0.112, "{way}");
        }
    }
}

#[test]
fn pushes_come_back_in_their_order() {
    let press = middle([30.0, 0.0, 0.1]);
    let found = press.at(&[20.0, 0.0, 5.0, 20.0]).unwrap();
    assert_eq!(found[0], found[3]);
    assert!(found[2].normal_n < found[0].normal_n);
    let straight = &found[1];
    assert_eq!((straight.moment_n_m, straight.normal_n), ([0.0; 2], 0.0));
    assert_eq!((straight.contact_m, straight.place_m), (0.112, 0.0));
    assert_eq!(press.at(&[]), Ok(Vec::new()));
}

#[test]
fn what_does_not_hold_is_refused_with_the_push_that_does() {
    let end = |setting: [f64; 3]| match middle(setting).at(&[5.0, 85.0]) {
        Err(PressError::Ends { up_to_deg }) => up_to_deg,
        other => panic!("{setting:?}: {other:?}"),
    };
    // Flat on the plate the shaft has nowhere to bend to.
    assert!(end([0.0, 0.0, 0.0]) < 1e-3);
    // The fold of an independent solution.
    assert!((end([60.0, 0.0, 0.0]) - 50.3).abs() < 0.05);
    // With a tilt it goes around the normal, and lets go on the other side.
    assert!((end([60.0, 10.0, 0.0]) - 60.0).abs() < 1e-3);
    let last = end([60.0, 0.0, 0.0]);
    assert!(middle([60.0, 0.0, 0.0]).at(&[last]).is_ok());

    let bad = |name| Err(PressError::Setting(BadSetting(name)));
    assert_eq!(middle([-1.0, 0.0, 0.0]).at(&[1.0]), bad("slant_deg"));
    assert_eq!(middle([30.0, 81.0, 0.0]).at(&[1.0]), bad("tilt_deg"));
    assert_eq!(middle([30.0, 0.0, f64::NAN]).at(&[1.0]), bad("friction"));
    assert_eq!(middle([30.0, 0.0, 0.0]).at(&[90.5]), bad("push_deg"));
    let mut sharp = middle([30.0, 0.0, 0.0]);
    sharp.shaft.tip_diameter_m = 2.2e-5;
    assert_eq!(sharp.at(&[1.0]), bad("tip_diameter_m"));
}

#[test]
fn clamps_hinges_and_extreme_settings_give_numbers_or_a_reason() {
    let mut clamped = middle([30.0, 0.0, 0.0]);
    clamped.shaft.follicle.rotation_n_m_rad = f64::INFINITY;
    let mut stiff = clamped;
    stiff.shaft.follicle.rotation_n_m_rad = 1e9;
    assert!(apart(&one(&clamped, 20.0), &one(&stiff, 20.0)) < 1e-8);
    for slant in [0.1, 20.0, 50.0, 80.0] {
        for tilt in [-60.0, 0.0, 1.0] {
            for friction in [0.0, 0.5, 8.0] {
                for taper in [1.0, 1.0 + 1e-12, 3.0, 100.0] {
                    for k in [1e-9, 1e-3, f64::INFINITY] {
                        let mut press = middle([slant, tilt, friction]);
                        press.shaft.tip_diameter_m /= taper / 8.0;
                        press.shaft.follicle.rotation_n_m_rad = k;
                        let found = press.at(&[0.01, 10.0]);
                        for found in found.iter().flatten() {
                            assert!(found.normal_n > 0.0 && found.normal_n.is_finite());
                            assert!(found.contact_m <= 0.112 && found.contact_m > 0.0);
                        }
                    }
                }
            }
        }
    }
}
