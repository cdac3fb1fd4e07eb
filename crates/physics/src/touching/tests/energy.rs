//! Contact takes energy or keeps it, and stays finite whatever happens.

use proptest::prelude::*;

use super::{QUIET, flat, floor};
use crate::{
    Biotact, Facing, Grit, Material, Outline, Plate, Pose, Shaft, Surface, TouchingWhisker,
};

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

/// Angle below the level, and in lengths: height of the straight tip above the
/// floor, and bend.
type Release = (f64, f64, [f64; 2]);

fn any_release() -> impl Strategy<Value = Release> {
    (0.0..0.7_f64, -0.05..0.05_f64, [-0.2..0.2_f64, -0.2..0.2])
}

pub(super) fn materials() -> Vec<Material> {
    use Grit::*;
    let mut all = vec![
        Material::Flat,
        Material::SmoothPlastic,
        Material::Aluminium,
        Material::RoughCarpet,
        Material::SmoothCarpet,
        Material::Tarmac,
        Material::Vinyl,
    ];
    let grits = [
        P40, P50, P60, P80, P100, P120, P150, P180, P220, P240, P280, P320, P360, P400, P500, P600,
    ];
    all.extend(grits.map(Material::Sandpaper));
    all.extend([5, 20, 100].map(Material::Relief));
    all
}

/// An endless floor, its end about under the tip, and a bar there.
fn any_outline() -> impl Strategy<Value = Outline> {
    prop_oneof![
        Just(Outline::PLANE),
        (0.01..0.3_f64, 1e-4..0.02_f64).prop_map(|(end_m, r)| Outline::edge(end_m, r)),
        (0.01..0.3_f64, 1e-4..0.02_f64).prop_map(|(at_m, r)| Outline {
            flat_m: [at_m; 2],
            radius_m: r,
        }),
    ]
}

/// Let go with the base at rest, a whisker's energy does not rise.
fn released(
    shaft: &Shaft,
    plate: Plate,
    (angle, above, bend): Release,
    dt_s: f64,
) -> Result<(), TestCaseError> {
    let length = shaft.length_m;
    let pose = slanted(angle, length, above * length);
    let mut whisker = TouchingWhisker::new(shaft, &QUIET, 1).unwrap();
    whisker.bend(bend.map(|b| b * length));
    let mut most = whisker.energy_j();
    let mut last = f64::INFINITY;
    for n in 0..400 {
        whisker.step(&pose, Some(&plate), dt_s);
        let energy = whisker.energy_j();
        prop_assert!(energy.is_finite());
        // The first step may find the tip below the ground.
        if n > 0 {
            let room = 1e-12 * most;
            prop_assert!(energy <= last + room, "{n}: {energy:e} after {last:e}");
        }
        most = most.max(energy);
        last = energy;
    }
    Ok(())
}

#[test]
fn what_once_gave_energy_gives_none() {
    let ground = |stiffness: f64, friction: f64| Surface {
        grain_m: 0.1,
        ..flat(10.0_f64.powf(stiffness), 0.0, friction, friction)
    };
    // A base below the floor: a place that did not reach it had the stretch of another.
    let bend = [-0.034_615_674_455_788_12, -0.151_421_870_099_535_1];
    let below = (0.042_483_781_144_719, -0.045_717_268_309_824_47, bend);
    let slippery = ground(4.823_948_455_042_236_5, 0.0);
    // A bounce: static shapes that were still bent as it touched again.
    let bounce = (
        0.038_989_875_503_091_166,
        -0.030_764_116_095_430_952,
        [0.0; 2],
    );
    let rubbing = ground(5.585_192_711_423_789, 0.393_237_069_956_088);
    for (shaft, ground, release, dt) in [
        (
            Shaft::biotact(Biotact::Front),
            slippery,
            below,
            -4.414_960_386_869_022,
        ),
        (
            Shaft::psikharpax(1),
            rubbing,
            bounce,
            -3.600_001_869_551_938_7,
        ),
    ] {
        released(&shaft, floor(ground), release, 10.0_f64.powf(dt)).unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Released bent, over, on or under a plate of every material, with the base at rest.
    #[test]
    fn energy_never_rises_on_any_material(
        shaft in any_shaft(),
        material in prop::sample::select(materials()),
        outline in any_outline(),
        seed: u64,
        release in any_release(),
        dt_s in 1e-4..2e-3_f64,
    ) {
        let surface = Surface::of(material).piece(seed);
        released(&shaft, Plate { outline, ..floor(surface) }, release, dt_s)?;
    }

    /// The same on surfaces that no material has, smooth, slippery and undamped too.
    #[test]
    fn energy_never_rises_on_any_surface(
        shaft in any_shaft(),
        height in prop_oneof![Just(f64::NEG_INFINITY), -7.0..-2.0_f64],
        grain in -6.0..-1.0_f64,
        stiffness in 0.0..9.0_f64,
        damping in prop_oneof![Just(0.0), 0.0..2.0_f64],
        friction in prop_oneof![Just(0.0), 0.0..2.0_f64],
        extra in 1.0..2.0_f64,
        outline in any_outline(),
        seed: u64,
        release in any_release(),
        dt in -4.5..-2.5_f64,
    ) {
        let surface = Surface {
            height_m: 10.0_f64.powf(height),
            grain_m: 10.0_f64.powf(grain),
            seed,
            ..flat(10.0_f64.powf(stiffness), damping, extra * friction, friction)
        };
        let plate = Plate { outline, ..floor(surface) };
        released(&shaft, plate, release, 10.0_f64.powf(dt))?;
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
        outline in any_outline(),
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
            whisker.step(&pose, Some(&Plate { outline, ..floor(surface) }), dt_s);
            let energy = whisker.energy_j();
            prop_assert!(energy.is_finite() && energy < 1e12, "{energy}");
            prop_assert!(whisker.reading().iter().all(|r| r.abs() <= 1.0));
            prop_assert!(whisker.force_n().iter().all(|f| f.is_finite() && *f >= 0.0), "{n} {whisker:?}");
        }
    }
}

/// What holds a shaft of a length and a taper, and how it is swung.
type Swing = (f64, f64, f64);

fn any_swing() -> impl Strategy<Value = Swing> {
    let push_deg = prop_oneof![Just(0.05), 1.0..60.0_f64];
    let tick_hz = prop::sample::select(vec![500.0, 2000.0, 8000.0]);
    (push_deg, 0.5..25.0_f64, tick_hz)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Swung against a plate by up to 60° at up to 25 Hz, grazing it and parallel to it too,
    /// any shaft stores no more than holding its tip and then its follicle would, and the motion
    /// of the base gives it.
    #[test]
    fn a_swung_whisker_stays_bounded(
        length_m in 0.02..0.3_f64,
        taper in 1.0..30.0_f64,
        slant_deg in prop_oneof![Just(0.0), 0.0..80.0_f64],
        tilt_deg in -60.0..60.0_f64,
        stiffness in 2.0..9.0_f64,
        friction in 0.0..1.5_f64,
        outline in prop_oneof![
            Just(Outline::PLANE),
            (-0.01..0.01_f64, 1e-4..0.01_f64).prop_map(|(end_m, r)| Outline::edge(end_m, r)),
            (1e-4..0.02_f64).prop_map(Outline::bar),
        ],
        (push_deg, hz, tick_hz) in any_swing(),
    ) {
        let shaft = Shaft {
            length_m,
            hub_diameter_m: length_m / 50.0,
            tip_diameter_m: length_m / 50.0 / taper,
            ..Shaft::biotact(Biotact::Middle)
        };
        let facing = Facing { slant_deg, tilt_deg, elevation_deg: 0.0 };
        let ground = flat(10.0_f64.powf(stiffness), 0.3, friction, friction);
        let plate = Plate {
            outline,
            ..Plate::in_the_way(1.0, length_m, &facing, ground)
        };
        let mut whisker = TouchingWhisker::new(&shaft, &QUIET, 1).unwrap();
        let modes = shaft.modes(1).unwrap();
        let (swing, omega) = ((push_deg + 5.0).to_radians(), core::f64::consts::TAU * hz);
        // Ten times over, and a shaft that whirls ten times as fast.
        let tip_j = 0.5 * (length_m * swing).powi(2) / modes.tip_m_n;
        let held_j = 10.0 * tip_j + 0.5 * shaft.follicle.rotation_n_m_rad * swing * swing;
        let whirl_j = 0.5 * (modes.modes[0].rotation * swing * omega).powi(2);
        for n in 0..(tick_hz / hz) as u32 * 2 {
            let phase = omega * f64::from(n) / tick_hz;
            let angle = 1.0 + swing * 0.5 * (1.0 - phase.cos()) - 5.0_f64.to_radians();
            whisker.step(&Pose::swung(angle), Some(&plate), 1.0 / tick_hz);
            let energy = whisker.energy_j();
            prop_assert!(energy < held_j + 100.0 * whirl_j, "{n} {energy} {held_j} {whirl_j}");
            prop_assert!(whisker.tip_m().iter().all(|tip| tip.abs() <= length_m));
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
