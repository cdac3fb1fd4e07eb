//! Textured surfaces against closed forms: static bend, ring-down, forced and random vibration.

use core::f64::consts::{PI, TAU};

use proptest::prelude::*;
use scene::Texture;

use super::Textured;
use crate::plant::surface::SurfaceSettings;
use crate::plant::tests::{TICK_S, any_motion, head, readings, seed_decides, stays_in_range};
use crate::plant::{BadSetting, Plant};

fn usual(whiskers: usize, seed: u64) -> Textured {
    Textured::new(head(whiskers), None, Textured::NOISE_CODES, seed).unwrap()
}

const FLAT: SurfaceSettings = SurfaceSettings {
    height_m: 0.0,
    grain_m: 1e-3,
    grip: 0.0,
    softness: 0.0,
    friction: 0.0,
};

/// Without noise, inertia and patches.
fn quiet(surface: SurfaceSettings) -> Textured {
    let mut plant = Textured::new(head(1), None, 0.0, 7).unwrap();
    plant.world.surface = surface;
    [plant.world.inertia, plant.world.patch] = [0.0; 2];
    plant
}

fn sweep(plant: &mut Textured, from: f64, to: f64, seconds: f64) -> [f64; 2] {
    let ticks = (seconds / TICK_S).round();
    for n in 1..=ticks as u32 {
        plant.advance(&[from + (to - from) * f64::from(n) / ticks], TICK_S);
    }
    plant.deflection(0)
}

#[test]
fn a_resting_whisker_is_bent_as_the_formula_says() {
    for (overlap, softness) in [(1.0, 0.0), (4.0, 0.0), (30.0, 0.0), (4.0, 3.0)] {
        let mut plant = quiet(SurfaceSettings { softness, ..FLAT });
        let [x, y] = sweep(&mut plant, 100.0 + overlap, 100.0 + overlap, 1.0);
        let expected = 0.8 * (0.1 * overlap / (1.0 + softness) / 0.8).tanh();
        assert!((x - expected).abs() < 1e-9 && y == 0.0, "{overlap}: {x}");
    }
}

#[test]
fn friction_adds_in_protraction_and_takes_in_retraction() {
    // 30 degrees a second against a creep of 10: s = ±0.75. Slow enough for the
    // mode's lag, 2 ζ/ω = 0.6 ms or 0.002 in x, to be small.
    let friction = 0.5;
    let surface = SurfaceSettings { friction, ..FLAT };
    let bend = 0.8 * (0.5_f64 / 0.8).tanh();
    for (from, sign) in [(80.0, 1.0), (130.0, -1.0)] {
        let mut plant = quiet(surface);
        let [x, y] = sweep(&mut plant, from, 105.0, (105.0_f64 - from).abs() / 30.0);
        let share = sign * 0.75 * friction;
        assert!((x - bend * (1.0 + 0.4 * share)).abs() < 4e-3, "{x}");
        assert!((y - bend * 0.4 * share).abs() < 1e-3, "{y}");
    }
}

#[test]
fn a_released_whisker_rings_at_its_frequency() {
    let mut plant = quiet(FLAT);
    let step_s = 1e-5;
    for _ in 0..200_000 {
        plant.advance(&[105.0], step_s);
    }
    let (mut crossings, mut last) = (Vec::new(), 1.0);
    for n in 0..100_000 {
        plant.advance(&[90.0], step_s);
        let [x, _] = plant.deflection(0);
        // Falling through zero: once a period.
        if last > 0.0 && x <= 0.0 {
            crossings.push(f64::from(n) * step_s);
        }
        last = x;
    }
    let found = 4.0 / (crossings[4] - crossings[0]);
    // BIOTACT section II-C gives 50 Hz; damping 0.1 lowers it by 0.5 %.
    let ratio = found / (50.0 * 0.99_f64.sqrt());
    assert!((ratio - 1.0).abs() < 1e-3, "{found}");
}

#[test]
fn a_free_whisker_only_sways_with_its_base() {
    let mut plant = Textured::new(head(1), None, 0.0, 3).unwrap();
    plant.present(Texture::P240);
    // θ′ = 70 − 20 cos ωt at 2 Hz bends it by −σ_x θ″/ω₀², nearly in phase with θ′.
    let expected = 0.1 * 20.0 * (2.0_f64 / 50.0).powi(2) / (1.0 - (2.0_f64 / 50.0).powi(2));
    let mut product = 0.0;
    for n in 1..=4000 {
        let wave = -(TAU * 2.0 * f64::from(n) * TICK_S).cos();
        plant.advance(&[70.0 + 20.0 * wave], TICK_S);
        let [x, y] = plant.deflection(0);
        assert!(x.abs() < 0.01 && y == 0.0, "{x} {y}");
        if n > 2000 {
            product += x * wave / 1000.0;
        }
    }
    let ratio = product / expected;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

#[test]
fn the_sensor_s_noise_is_as_set() {
    let mut plant = usual(1, 3);
    let mut squares = [0.0; 2];
    for _ in 0..20_000 {
        plant.advance(&[60.0], TICK_S);
        for (square, v) in squares.iter_mut().zip(plant.deflection(0)) {
            *square += (v * 8191.0).powi(2) / 20_000.0;
        }
    }
    let is_near = |square: &f64| (square.sqrt() - 4.0).abs() < 0.1;
    assert!(squares.iter().all(is_near), "{squares:?}");
}

/// Variance of y in a steady slide of `speed` degrees a second, to and fro.
fn vibration(mut surface: SurfaceSettings, speed: f64, tick_s: f64, seconds: f64) -> f64 {
    // Which turns some of the bend to y.
    surface.friction = 0.0;
    let mut plant = quiet(surface);
    let (mut angle, mut forth) = (120.0, true);
    let ticks = (seconds / tick_s) as u32;
    let mut variance = 0.0;
    for _ in 0..ticks {
        angle += if forth { speed } else { -speed } * tick_s;
        forth = if forth { angle < 160.0 } else { angle < 110.0 };
        plant.advance(&[angle], tick_s);
        variance += plant.deflection(0)[1].powi(2) / f64::from(ticks);
    }
    variance
}

/// The same for a resonator behind a process with correlation exp(−a |t|) and
/// variance s²: s² ω (a + 2 ζ ω)/(2 ζ (ω² + a² + 2 ζ ω a)).
fn vibration_in_theory(surface: SurfaceSettings, speed: f64) -> f64 {
    let metres_per_degree = 0.112 * PI / 180.0;
    let (omega, damping) = (TAU * 50.0, 0.1);
    let a = speed * metres_per_degree / surface.grain_m;
    let s = 0.1 * 0.5 * surface.grip * surface.height_m / metres_per_degree;
    s * s * omega * (a + 2.0 * damping * omega)
        / (2.0 * damping * (omega * omega + a * a + 2.0 * damping * omega * a))
}

#[test]
fn vibration_is_that_of_a_resonator_over_a_random_profile() {
    for texture in [Texture::P600, Texture::P240, Texture::Carpet] {
        let surface = SurfaceSettings::of(texture);
        for (speed, tick_s) in [(300.0, TICK_S), (300.0, 5e-5), (20.0, TICK_S)] {
            let found = vibration(surface, speed, tick_s, 200.0);
            let error = found / vibration_in_theory(surface, speed) - 1.0;
            assert!(error.abs() < 0.08, "{texture} {speed} {tick_s}: {error}");
        }
    }
}

#[test]
fn the_seed_decides_everything_for_each_whisker() {
    seed_decides(|whiskers, seed| {
        let mut plant = usual(whiskers, seed);
        plant.present(Texture::P240);
        readings(&mut plant, whiskers)
    });
}

#[test]
fn bad_settings_are_named() {
    let with = |friction, noise_codes| {
        let made = Textured::new(head(1), Some(friction), noise_codes, 1);
        made.err().map(|BadSetting(name)| name)
    };
    assert_eq!(with(10.0, 1000.0), None);
    assert_eq!(with(10.1, 4.0), Some("friction"));
    assert_eq!(with(0.0, f64::NAN), Some("noise_codes"));
}

proptest! {
    /// Whatever the angles and ticks are, readings stay in range.
    #[test]
    fn nothing_leaves_the_range(motion in any_motion()) {
        let mut plant = usual(2, 1);
        plant.present(Texture::Carpet);
        stays_in_range(&mut plant, motion)?;
    }
}
