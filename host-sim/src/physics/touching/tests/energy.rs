//! Contact takes energy or keeps it, and stays finite whatever happens.

use proptest::prelude::*;

use super::{QUIET, flat, floor};
use crate::physics::{Biotact, Pose, Shaft, Surface, TouchingWhisker};

/// Pointing down at an angle, the tip of the straight shaft `above` the floor.
fn slanted(angle: f64, length_m: f64, above: f64) -> Pose {
    let (sine, cosine) = angle.sin_cos();
    Pose {
        base_m: [0.0, 0.0, length_m * sine + above],
        x: [sine, 0.0, cosine],
        y: [0.0, -1.0, 0.0],
    }
}

fn any_shaft() -> impl Strategy<Value = Shaft> {
    prop_oneof![
        Just(Shaft::floor_robot()),
        Just(Shaft::biotact(Biotact::Front)),
        Just(Shaft::psikharpax(1)),
        Just(Shaft::psikharpax(8)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Released bent, over, on or under a smooth plate, with the base at rest.
    #[test]
    fn energy_never_rises(
        shaft in any_shaft(),
        stiffness in 0.0..9.0_f64,
        damping in prop_oneof![Just(0.0), 0.0..2.0_f64],
        friction in prop_oneof![Just(0.0), 0.0..2.0_f64],
        extra in 1.0..2.0_f64,
        angle in 0.0..0.7_f64,
        above in -0.05..0.05_f64,
        bend in [-0.2..0.2_f64, -0.2..0.2],
        dt in -4.5..-2.5_f64,
    ) {
        let plate = floor(flat(10.0_f64.powf(stiffness), damping, extra * friction, friction));
        let length = shaft.length_m;
        let pose = slanted(angle, length, above * length);
        let mut whisker = TouchingWhisker::new(&shaft, &QUIET, 1).unwrap();
        whisker.bend(bend.map(|b| b * length));
        let dt_s = 10.0_f64.powf(dt);
        let mut most = whisker.energy_j();
        let mut last = f64::INFINITY;
        for n in 0..400 {
            whisker.step(&pose, Some(&plate), dt_s);
            let energy = whisker.energy_j();
            prop_assert!(energy.is_finite());
            // The first step may find the tip below the ground.
            if n > 0 {
                prop_assert!(energy <= last + 1e-6 * most, "{n}: {energy:e} after {last:e}");
            }
            most = most.max(energy);
            last = energy;
        }
    }

    /// Any surface, shaft, speed and step: finite, and the sensor in its range.
    #[test]
    fn nothing_breaks_it(
        length in -3.0..0.0_f64,
        slender in 10.0..1000.0_f64,
        youngs in 6.0..12.0_f64,
        stiffness in 0.0..9.0_f64,
        friction in 0.0..10.0_f64,
        height in 0.0..0.01_f64,
        grain in -6.0..-1.0_f64,
        speed in -100.0..100.0_f64,
        angle in -1.57..1.57_f64,
        dt in -6.0..0.0_f64,
        seed: u64,
    ) {
        let length_m = 10.0_f64.powf(length);
        let shaft = Shaft {
            length_m,
            hub_diameter_m: (length_m / slender).max(1e-5),
            tip_diameter_m: (length_m / slender / 8.0).max(1e-6),
            youngs_pa: 10.0_f64.powf(youngs),
            ..Shaft::floor_robot()
        };
        let surface = Surface {
            height_m: height,
            grain_m: 10.0_f64.powf(grain),
            seed,
            ..flat(10.0_f64.powf(stiffness), 0.3, friction, friction)
        };
        let dt_s = 10.0_f64.powf(dt);
        let mut whisker = TouchingWhisker::new(&shaft, &QUIET, seed).unwrap();
        for n in 0..60 {
            let mut pose = slanted(angle, length_m, -0.3 * length_m);
            let way = speed * dt_s * f64::from(n);
            pose.base_m[0] += way;
            pose.base_m[2] += 0.2 * length_m * way.sin();
            whisker.step(&pose, Some(&floor(surface)), dt_s);
            let energy = whisker.energy_j();
            prop_assert!(energy.is_finite() && energy < 1e12, "{energy}");
            prop_assert!(whisker.reading().iter().all(|r| r.abs() <= 1.0));
            prop_assert!(whisker.force_n().iter().all(|f| f.is_finite() && *f >= 0.0), "{n} {whisker:?}");
        }
    }
}

#[test]
fn what_is_not_finite_is_not_believed() {
    let plate = floor(flat(1e5, 0.3, 0.5, 0.4));
    let mut whisker = super::robot();
    let good = slanted(0.2, 0.2, -5e-3);
    for _ in 0..100 {
        whisker.step(&good, Some(&plate), 5e-4);
    }
    let before = whisker.tip_m();
    let mut bad = good;
    bad.base_m[1] = f64::NAN;
    let mut bad_plate = plate;
    bad_plate.point_m[2] = f64::NAN;
    bad_plate.surface.friction = f64::NAN;
    whisker.step(&bad, Some(&plate), 0.0);
    whisker.step(&bad, Some(&plate), f64::NAN);
    assert_eq!(whisker.tip_m(), before);
    whisker.step(&bad, Some(&plate), 5e-4);
    whisker.step(&good, Some(&bad_plate), 5e-4);
    assert!(whisker.tip_m().iter().all(|u| u.is_finite()));
    whisker.rest();
    assert_eq!(whisker.tip_m(), [0.0; 2]);
    assert_eq!((whisker.energy_j(), whisker.contact()), (0.0, false));
}
