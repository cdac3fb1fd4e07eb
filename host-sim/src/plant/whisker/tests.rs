//! Elastic whiskers on motors: slope at first touch, textures, seeds, bad input.

use core::f64::consts::TAU;

use proptest::prelude::*;
use scene::Texture;

use super::{Elastic, ElasticSettings};
use crate::plant::tests::{TICK_S, any_motion, head, readings, seed_decides, stays_in_range};
use crate::plant::{BadSetting, Head, Plant, SurfacePose};
use physics::{Biotact, Facing, Grit, Material, Outline, Shaft, Surface};

fn quiet(shaft: Shaft) -> ElasticSettings {
    let (noise_codes, of) = (0.0, ElasticSettings::of(shaft));
    ElasticSettings { noise_codes, ..of }
}

fn frictionless() -> Surface {
    Surface {
        hold: 0.0,
        friction: 0.0,
        ..Surface::of(Material::Flat)
    }
}

/// What a whisker at rest at this overlap says, in the mean over its ringing.
fn settled(shaft: Shaft, surface: Surface, overlap: f64) -> [f64; 2] {
    let (stiffness, one) = (1.0, head(1));
    let steep = Head { stiffness, ..one };
    let mut plant = Elastic::new(steep, quiet(shaft), 7).unwrap();
    plant.present_surface(surface);
    let ticks = 8000;
    let mut mean = [0.0; 2];
    for n in 0..ticks {
        let share = (f64::from(n) / 4000.0).min(1.0);
        plant.advance(&[99.0 + share * (1.0 + overlap)], TICK_S);
        if n >= 6000 {
            for (mean, now) in mean.iter_mut().zip(plant.deflection(0)) {
                *mean += now / 2000.0;
            }
        }
    }
    mean
}

#[test]
fn a_bar_is_touched_where_an_elastica_is() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let facing = Facing {
        slant_deg: 0.0,
        tilt_deg: 0.0,
        elevation_deg: 0.0,
    };
    let settings = ElasticSettings {
        facing,
        touches_at: 0.6,
        outline: Outline::bar(5e-4),
        ..quiet(shaft)
    };
    let mut plant = Elastic::new(head(1), settings, 7).unwrap();
    plant.present_surface(frictionless());
    for n in 0..8000 {
        let share = (f64::from(n) / 4000.0).min(1.0);
        plant.advance(&[99.0 + 11.0 * share], TICK_S);
    }
    let at = plant.contact_at(0).unwrap();
    // tests/truth/bar.csv, 10 degrees.
    assert!((at.arc_m - 0.067_428_8).abs() < 2e-4, "{at:?}");
    assert!(at.plate_m[0].abs() < 5e-4, "{at:?}");
}

/// Squares of the cosines between a plate's normal and the sensor's x and y.
fn cosines() -> [f64; 2] {
    let (slant, tilt) = (30.0_f64.to_radians(), 20.0_f64.to_radians());
    [(slant.cos() * tilt.cos()).powi(2), tilt.sin().powi(2)]
}

#[test]
fn at_first_touch_a_hard_plate_reads_as_in_equation_11() {
    for shaft in [
        Shaft::biotact(Biotact::Front),
        Shaft::biotact(Biotact::Rear),
        Shaft::floor_robot(),
    ] {
        // The plate is tilted: without friction the tip gives way along y too,
        // as much as its stiffness there, which is the same, makes it.
        let [x, y] = settled(shaft, frictionless(), 0.1);
        let [along, across] = cosines();
        let expected = 0.1 * along / (along + across);
        assert!((x / expected - 1.0).abs() < 0.03, "{shaft:?} {x}");
        assert!((y / x + (across / along).sqrt()).abs() < 0.02, "{y} {x}");
        // Friction that holds the tip aside leaves x alone: eq. 11. More of it would hold the tip
        // along the shaft too, whose tension then stiffens it.
        let held = Surface {
            hold: 1.0,
            friction: 1.0,
            ..frictionless()
        };
        let [x, _] = settled(shaft, held, 0.1);
        assert!((x / 0.1 - 1.0).abs() < 0.03, "{shaft:?} {x}");
    }
}

#[test]
fn a_soft_plate_shares_the_overlap_with_the_shaft() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let modes = shaft.modes(8).unwrap();
    let surface = Surface {
        stiffness_n_m: 2.0,
        ..frictionless()
    };
    let [hard, _] = settled(shaft, frictionless(), 0.1);
    let [soft, _] = settled(shaft, surface, 0.1);
    // In series along the normal.
    let give = modes.tip_m_n * cosines().iter().sum::<f64>();
    let expected = give / (give + 0.5);
    assert!((soft / hard / expected - 1.0).abs() < 0.03, "{soft} {hard}");
}

fn pose(tilt_deg: f64, obstacle_deg: f64) -> SurfacePose {
    SurfacePose {
        tilt_deg,
        obstacle_deg,
        ..SurfacePose::OF_SCENE
    }
}

/// Whisks of 2 Hz, 2 s of them, standing in another pose from `at` on.
fn whisked(head: Head, settings: &ElasticSettings, at: usize, pose: SurfacePose) -> Vec<[f64; 2]> {
    let mut plant = Elastic::new(head, *settings, 3).unwrap();
    plant.present(Texture::P240);
    let tick = |n: usize| {
        if n == at {
            plant.stand(pose);
        }
        let angle = 70.0 - 36.0 * (TAU * 2.0 * n as f64 * TICK_S).cos();
        plant.advance(&[angle], TICK_S);
        plant.deflection(0)
    };
    (0..4000).map(tick).collect()
}

#[test]
fn a_plate_in_another_pose_is_as_one_of_a_scene_that_has_it() {
    let settings = ElasticSettings::of(Shaft::biotact(Biotact::Middle));
    let pose = pose(-7.5, 2.25);
    let moved = whisked(head(1), &settings, 0, pose);
    let mut other = settings;
    other.facing.tilt_deg = 12.5;
    let beyond = Head {
        obstacle_deg: vec![102.25],
        ..head(1)
    };
    assert_eq!(moved, whisked(beyond, &other, usize::MAX, pose));
    assert_ne!(moved, whisked(head(1), &settings, usize::MAX, pose));
}

#[test]
fn a_plate_that_is_turned_in_the_air_does_not_move_the_shaft() {
    let settings = quiet(Shaft::biotact(Biotact::Middle));
    let pose = pose(40.0, -5.0);
    // The second whisk begins at 1000 and is near at 1300.
    let [still, turned] = [usize::MAX, 1000].map(|at| whisked(head(1), &settings, at, pose));
    let code = 1.0 / 8191.0;
    for n in 0..1300 {
        for (still, turned) in still[n].into_iter().zip(turned[n]) {
            let moved = (still - turned).abs();
            assert!(moved <= 1.5 * code, "{n}: {still} {turned}");
        }
    }
    let mut pairs = still.iter().zip(&turned);
    assert!(pairs.any(|(a, b)| (a[1] - b[1]).abs() > 0.1));
}

#[test]
fn there_is_room_for_a_plate_that_is_5_mm_beyond_the_tip() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let plant = |angle: f64| {
        let mut plant = Elastic::new(head(1), quiet(shaft), 3).unwrap();
        let nothing_is_known = plant.has_room(SurfacePose::OF_SCENE);
        assert!(nothing_is_known);
        plant.advance(&[angle], TICK_S);
        plant
    };
    // Over a plate that is less than 20° further the height is L times these cosines and the
    // sine of the angle, more or less what the slant makes of it.
    for tilt_deg in [-20.0_f64, 0.0, 40.0] {
        let cosine = (20.0 + tilt_deg).to_radians().cos();
        let height = |ahead_deg: f64| {
            let [ahead, slant] = [ahead_deg, 30.0].map(f64::to_radians);
            shaft.length_m
                * cosine
                * (slant.cos() * ahead.sin() + slant.sin() * (1.0 - ahead.cos()))
        };
        let mut ahead = 0.0;
        while height(ahead) < 5e-3 {
            ahead += 0.01;
        }
        let plant = plant(90.0);
        assert!(plant.has_room(pose(tilt_deg, ahead - 9.99)), "{ahead}");
        assert!(!plant.has_room(pose(tilt_deg, ahead - 10.02)), "{ahead}");
    }
    assert!(!plant(100.0).has_room(SurfacePose::OF_SCENE));
    assert!(plant(100.0).in_the_air().has_room(SurfacePose::OF_SCENE));
}

#[test]
fn a_restart_brings_the_scene_s_pose_back_and_the_air_has_none() {
    let settings = ElasticSettings::of(Shaft::biotact(Biotact::Middle));
    let pose = pose(0.0, -40.0);
    let mut plant = Elastic::new(head(1), settings, 3).unwrap();
    let mut free = plant.in_the_air();
    for plant in [&mut plant, &mut free] {
        plant.stand(pose);
        plant.advance(&[70.0], TICK_S);
    }
    assert!(plant.touches() && !free.touches());
    plant.restart(3);
    plant.advance(&[70.0], TICK_S);
    assert!(!plant.touches());
}

fn shown(
    settings: &ElasticSettings,
    texture: Texture,
    whiskers: usize,
    seed: u64,
) -> Vec<Vec<[f64; 2]>> {
    let mut plant = Elastic::new(head(whiskers), *settings, seed).unwrap();
    plant.present(texture);
    readings(&mut plant, whiskers)
}

#[test]
fn an_own_surface_is_felt_as_what_it_is() {
    let mut settings = ElasticSettings::of(Shaft::biotact(Biotact::Middle));
    let of = |settings: &ElasticSettings, texture| shown(settings, texture, 1, 5);
    let smooth = of(&settings, Texture::Smooth);
    assert_eq!(of(&settings, Texture::Own3), smooth);
    settings.own[2] = Surface::of(Material::Sandpaper(Grit::P240));
    assert_eq!(of(&settings, Texture::Own3), of(&settings, Texture::P240));
    assert_eq!(of(&settings, Texture::Own1), smooth);
    settings.own[2].friction = 11.0;
    assert!(Elastic::new(head(1), settings, 1).is_err());
}

#[test]
fn the_seed_decides_everything_for_each_whisker() {
    let settings = ElasticSettings::of(Shaft::biotact(Biotact::Middle));
    seed_decides(|whiskers, seed| shown(&settings, Texture::P240, whiskers, seed));
}

#[test]
fn bad_settings_are_named() {
    let shaft = Shaft::floor_robot();
    let with = |head: Head, change: fn(&mut ElasticSettings)| {
        let mut settings = ElasticSettings::of(shaft);
        change(&mut settings);
        Elastic::new(head, settings, 1).map(|_| ()).err()
    };
    let bad = |name| Some(BadSetting(name));
    let one = |change| with(head(1), change);
    assert_eq!(one(|_| ()), None);
    assert_eq!(one(|s| s.shaft.length_m = 2.0), bad("length_m"));
    assert_eq!(one(|s| s.facing.slant_deg = 90.0), bad("slant_deg"));
    assert_eq!(one(|s| s.noise_codes = f64::NAN), bad("noise_codes"));
    let stiffness = |stiffness| Head {
        stiffness,
        ..head(1)
    };
    assert_eq!(with(stiffness(0.0), |_| ()), bad("stiffness"));
    assert_eq!(with(stiffness(-0.1), |_| ()), bad("stiffness"));
}

proptest! {
    /// Whatever the angles and ticks are, readings stay in range.
    #[test]
    fn nothing_leaves_the_range(
        motion in any_motion(),
        height_m in prop_oneof![0.0..1e-3, Just(f64::INFINITY), Just(f64::NAN)],
    ) {
        let settings = ElasticSettings::of(Shaft::biotact(Biotact::Middle));
        let mut plant = Elastic::new(head(2), settings, 1).unwrap();
        plant.present_surface(Surface { height_m, ..Surface::of(Material::Tarmac) });
        stays_in_range(&mut plant, motion)?;
    }
}
