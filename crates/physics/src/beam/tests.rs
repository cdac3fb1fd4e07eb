//! Modes against closed forms.

use core::f64::consts::FRAC_PI_4;

use crate::BadSetting;
use crate::{Follicle, Shaft};

const CLAMPED: Shaft = Shaft {
    length_m: 0.2,
    hub_diameter_m: 2e-3,
    tip_diameter_m: 2e-3,
    youngs_pa: 2.3e9,
    density_kg_m3: 1050.0,
    damping: 0.05,
    follicle: Follicle {
        rotation_n_m_rad: f64::INFINITY,
        axial_n_m: 1e4,
    },
};

fn tapered(ratio: f64) -> Shaft {
    Shaft {
        tip_diameter_m: CLAMPED.hub_diameter_m / ratio,
        ..CLAMPED
    }
}

fn hinged(rotation_n_m_rad: f64) -> Shaft {
    let mut shaft = CLAMPED;
    shaft.follicle.rotation_n_m_rad = rotation_n_m_rad;
    shaft
}

/// E I at the hub, and √(E I/(ρ A)) there.
fn hub(shaft: &Shaft) -> (f64, f64) {
    let d = shaft.hub_diameter_m;
    let area = FRAC_PI_4 * d * d;
    let rigidity = shaft.youngs_pa * area * d * d / 16.0;
    (rigidity, (rigidity / (shaft.density_kg_m3 * area)).sqrt())
}

/// ω L²/√(E I/(ρ A)) of the first three modes.
fn numbers(shaft: &Shaft) -> [f64; 3] {
    let modes = shaft.modes(3).unwrap().modes;
    let unit = hub(shaft).1 / (shaft.length_m * shaft.length_m);
    [0, 1, 2].map(|k| modes[k].omega_rad_s / unit)
}

fn near(found: f64, truth: f64, relative: f64) {
    assert!((found / truth - 1.0).abs() < relative, "{found} {truth}");
}

#[test]
fn uniform_cantilever_has_its_first_three_frequencies() {
    // Roots of cos β cosh β = −1.
    let betas: [f64; 3] = [1.875_104_07, 4.694_091_13, 7.854_757_44];
    for (found, beta) in numbers(&CLAMPED).into_iter().zip(betas) {
        near(found, beta * beta, 1e-5);
    }
}

#[test]
fn a_cone_has_the_frequencies_of_kirchhoff() {
    let found = numbers(&tapered(1e3));
    for (found, truth) in found.into_iter().zip([8.719, 21.146, 38.454]) {
        near(found, truth, 3e-3);
    }
}

#[test]
fn shape_at_the_tip_of_a_uniform_cantilever_is_two() {
    // φ(L)² = 4/mass for every mode; ∫ρAφ dz = √mass 2σ/β with σ of the mode.
    let mass = CLAMPED.density_kg_m3 * FRAC_PI_4 * 4e-6 * 0.2;
    let modes = CLAMPED.modes(3).unwrap().modes;
    for (mode, (sigma, beta)) in modes.iter().zip([
        (0.734_095_514, 1.875_104_07),
        (1.018_467_319, 4.694_091_13),
        (0.999_224_497, 7.854_757_44),
    ]) {
        near(mode.tip, 2.0 / mass.sqrt(), 1e-5);
        let translation = 2.0 * sigma / beta * mass.sqrt();
        near(mode.translation.abs(), translation, 1e-5);
        // ∫ρA z φ dz = 2 √mass L/β².
        let rotation = 2.0 * mass.sqrt() * 0.2 / (beta * beta);
        near(mode.rotation.abs(), rotation, 1e-5);
    }
    // A base that moves with the tip of the first mode leaves the tip behind.
    assert!(modes[0].translation > 0.0 && modes[0].rotation > 0.0);
}

#[test]
fn static_response_is_that_of_the_textbooks() {
    let (rigidity, _) = hub(&CLAMPED);
    let cantilever = 0.2_f64.powi(3) / (3.0 * rigidity);
    let modes = CLAMPED.modes(4).unwrap();
    near(modes.tip_m_n, cantilever, 1e-7);
    assert_eq!(modes.base_rad_n, 0.0);
    // A mode has the share 12/β⁴; those after the fourth, 6.2e-4 together.
    assert!((5.8e-4..6.6e-4).contains(&(modes.residual_tip_m_n / cantilever)));
    // A tip of diameter d1 and a hub of d0: L³/(3 E I0) · d0/d1.
    for ratio in [2.0, 8.0, 20.0] {
        let modes = tapered(ratio).modes(1).unwrap();
        near(modes.tip_m_n, cantilever * ratio, 2e-3);
    }
    // A hinge adds L²/k and turns by L/k.
    let modes = hinged(0.02).modes(1).unwrap();
    near(modes.tip_m_n, cantilever + 0.04 / 0.02, 1e-7);
    near(modes.base_rad_n, 0.2 / 0.02, 1e-7);
}

#[test]
fn a_hinge_goes_from_pendulum_to_clamp() {
    let (rigidity, _) = hub(&CLAMPED);
    near(numbers(&hinged(1e6))[0], numbers(&CLAMPED)[0], 1e-5);
    // Soft: a rigid rod, ω² = 3 k/(m L²); the second is the hinged-free beam's,
    // a root of tan β = tanh β.
    let k = 1e-3 * rigidity / 0.2;
    let mass = CLAMPED.density_kg_m3 * FRAC_PI_4 * 4e-6 * 0.2;
    let modes = hinged(k).modes(2).unwrap().modes;
    near(modes[0].omega_rad_s, (3.0 * k / (mass * 0.04)).sqrt(), 5e-4);
    near(numbers(&hinged(k))[1], 3.926_602_31_f64.powi(2), 5e-4);
    // Between, for k L = E I: 1 + cos β cosh β = β (sin β cosh β − cos β sinh β).
    let beta = numbers(&hinged(rigidity / 0.2))[0].sqrt();
    let residue = (1.0 + beta.cos() * beta.cosh())
        - beta * (beta.sin() * beta.cosh() - beta.cos() * beta.sinh());
    assert!(residue.abs() < 1e-4, "{beta} {residue}");
}

#[test]
fn bad_settings_are_named() {
    type Change = fn(&mut Shaft);
    let mut shaft = CLAMPED;
    assert_eq!(shaft.modes(3).map(|_| ()), Ok(()));
    let changes: [(&str, Change); 8] = [
        ("length_m", |s| s.length_m = 0.0),
        ("tip_diameter_m", |s| s.tip_diameter_m = f64::NAN),
        ("hub_diameter_m", |s| s.hub_diameter_m = 0.05),
        ("youngs_pa", |s| s.youngs_pa = 1.0),
        ("density_kg_m3", |s| s.density_kg_m3 = 0.0),
        ("damping", |s| s.damping = 1.0),
        ("rotation_n_m_rad", |s| s.follicle.rotation_n_m_rad = 0.0),
        ("axial_n_m", |s| s.follicle.axial_n_m = f64::NAN),
    ];
    for (name, change) in changes {
        shaft = CLAMPED;
        change(&mut shaft);
        assert_eq!(shaft.modes(3), Err(BadSetting(name)));
    }
    assert_eq!(CLAMPED.modes(13), Err(BadSetting("count")));
}
