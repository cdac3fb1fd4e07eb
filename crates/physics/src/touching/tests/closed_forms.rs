//! Statics, ring-down, inertia and friction against formulas, within 1 %.

use core::f64::consts::{FRAC_PI_4, TAU};

use super::{DT, QUIET, flat, floor, level, nosed, robot};
use crate::{Plate, Pose, Shaft, TouchingWhisker};

/// E I, k_θ, mass and length of the floor robot's whisker.
fn robot_numbers() -> (f64, f64, f64, f64) {
    let shaft = Shaft::floor_robot();
    let area = FRAC_PI_4 * shaft.hub_diameter_m.powi(2);
    let rigidity = shaft.youngs_pa * area * shaft.hub_diameter_m.powi(2) / 16.0;
    let mass = shaft.density_kg_m3 * area * shaft.length_m;
    let hinge = shaft.follicle.rotation_n_m_rad;
    (rigidity, hinge, mass, shaft.length_m)
}

fn near(found: f64, truth: f64) {
    assert!((found / truth - 1.0).abs() < 0.01, "{found} {truth}");
}

#[test]
fn rings_down_at_its_frequency_with_its_damping() {
    let shaft = Shaft::floor_robot();
    let omega = shaft.modes(1).unwrap().modes[0].omega_rad_s;
    let mut whisker = robot();
    whisker.bend([0.01, 0.0]);
    let mut crossings: Vec<f64> = Vec::new();
    let mut peaks: Vec<f64> = Vec::new();
    let (mut last, mut top) = (whisker.tip_m()[0], 0.0_f64);
    for n in 1..4000 {
        whisker.step(&level([0.0; 3]), None, DT);
        let now = whisker.tip_m()[0];
        top = top.max(now);
        if last < 0.0 && now >= 0.0 {
            crossings.push((f64::from(n) - now / (now - last)) * DT);
            peaks.push(core::mem::take(&mut top));
        }
        last = now;
    }
    // From the second on: the higher modes are gone.
    let period = (crossings[6] - crossings[2]) / 4.0;
    let ringing = omega * (1.0 - shaft.damping * shaft.damping).sqrt();
    near(period, TAU / ringing);
    let decay = (peaks[2] / peaks[6]).ln() / 4.0 / period;
    near(decay, shaft.damping * omega);
}

#[test]
fn a_pressed_tip_has_the_static_force_and_turns_the_base() {
    let (rigidity, k, _, length) = robot_numbers();
    let give = length.powi(3) / (3.0 * rigidity) + length * length / k;
    for stiffness in [1.0, 1e3, 1e7] {
        let plate = floor(flat(stiffness, 1.0, 0.0, 0.0));
        let mut whisker = robot();
        for _ in 0..6000 {
            whisker.step(&nosed([0.0, 0.0, -5e-3]), Some(&plate), DT);
        }
        let force = 5e-3 / (give + 1.0 / stiffness);
        near(whisker.force_n()[0], force);
        near(whisker.tip_m()[0], force * give);
        let [x, y] = whisker.rotation_rad();
        near(x, force * length / k);
        assert_eq!(y, 0.0);
        near(whisker.reading()[0], force * length / k / 0.5);
    }
}

/// Of the tip, and of the angle of the base, under a load of ρ A a on a cantilever with a hinge:
/// q L⁴/8 E I + q L³/2 k and q L²/2 k; of ρ A z α, 11 q L⁴/120 E I + q L³/3 k and q L²/3 k for q at
/// the tip.
#[test]
fn a_base_that_is_accelerated_or_turned_leaves_the_shaft_behind() {
    let (rigidity, k, mass, length) = robot_numbers();
    let after = |pose: fn(f64) -> Pose| {
        let mut whisker = robot();
        for n in 0..6000 {
            whisker.step(&pose(f64::from(n) * DT), None, DT);
        }
        (whisker.tip_m()[0], whisker.rotation_rad()[0])
    };
    let (tip, base) = after(|t| level([0.0, 0.0, 0.25 * t * t]));
    let load = mass / length * 0.5;
    let hinge = load * length * length / (2.0 * k);
    near(
        -tip,
        load * length.powi(4) / (8.0 * rigidity) + hinge * length,
    );
    near(-base, hinge);
    let (tip, base) = after(|t| {
        let (sine, cosine) = (0.2 * t * t).sin_cos();
        Pose {
            x: [-sine, 0.0, cosine],
            ..level([0.0; 3])
        }
    });
    let load = mass * 0.4;
    let hinge = load * length * length / (3.0 * k);
    near(
        -tip,
        11.0 * load * length.powi(4) / (120.0 * rigidity) + hinge * length,
    );
    near(-base, hinge);
}

/// A whisker that is drawn aside: way of the base, tip, forces, held or not.
type Drawn = (f64, [f64; 2], [f64; 2], bool);

/// Presses by 5 mm without friction, which would hold the tip back as it comes
/// back along the shaft; then draws the base aside at a speed.
fn drawn(hold: f64, friction: f64, speed: f64, seconds: f64) -> Vec<Drawn> {
    let plate = floor(flat(1e5, 1.0, hold, friction));
    let smooth = floor(flat(1e5, 1.0, 0.0, 0.0));
    let mut whisker = robot();
    for _ in 0..4000 {
        whisker.step(&nosed([0.0, 0.0, -5e-3]), Some(&smooth), DT);
    }
    let steps = (seconds / DT) as usize;
    let mut step = |n: usize| {
        let way = speed * DT * n as f64;
        whisker.step(&nosed([0.0, way, -5e-3]), Some(&plate), DT);
        let forces = whisker.force_n();
        (way, whisker.tip_m(), forces, whisker.sticking())
    };
    (0..steps).map(&mut step).collect()
}

#[test]
fn a_tip_sticks_up_to_the_cone_and_then_slides_on_it() {
    let (rigidity, k, _, length) = robot_numbers();
    let give = length.powi(3) / (3.0 * rigidity) + length * length / k;
    let normal = 5e-3 / give;
    let mu = 0.5;
    let run = drawn(mu, mu, 1e-3, 6.0);
    // Held: the tip stays where it is; y is against the way of the pose's y.
    let limit = mu * normal * give;
    for at in run.iter().filter(|at| (0.1..0.8).contains(&(at.0 / limit))) {
        near(at.1[1], at.0);
    }
    let most = run.iter().map(|at| at.1[1]).fold(0.0, f64::max);
    near(most, limit);
    // At the end it slides.
    let (_, tip, [n, t], stuck) = *run.last().unwrap();
    assert!(!stuck);
    near(n, normal);
    near(t, mu * n);
    near(tip[1], mu * normal * give);
}

#[test]
fn resting_friction_above_sliding_friction_makes_stick_and_slip() {
    let run = drawn(0.6, 0.4, 5e-3, 6.0);
    let late = &run[2000..];
    // The pull of the shaft in y, over the normal force at 5 mm.
    let pulls = || late.iter().map(|at| at.1[1] / 5e-3);
    let most = pulls().fold(0.0, f64::max);
    let least = pulls().fold(f64::INFINITY, f64::min);
    // Each pull ends near the angle of rest (creep along the shaft takes some of
    // it); each slip passes that of sliding.
    assert!((0.5..0.61).contains(&most), "{most}");
    assert!(least < 0.37, "{least}");
    // Slow pulls and fast slips: the tip leaves the base's way for few steps.
    let pairs = late.windows(2);
    let back = pairs.filter(|pair| pair[1].1[1] < pair[0].1[1]).count();
    assert!((10..late.len() / 4).contains(&back), "{back}");
}

#[test]
fn friction_opposes_the_way_whichever_it_is() {
    let there = drawn(0.5, 0.5, 5e-2, 1.0).last().unwrap().1;
    let back = drawn(0.5, 0.5, -5e-2, 1.0).last().unwrap().1;
    assert!(there[1] > 1e-3);
    assert!((there[1] + back[1]).abs() < 1e-9);
    assert!((there[0] - back[0]).abs() < 1e-9);
}

#[test]
fn a_plate_out_of_reach_changes_nothing() {
    let plate = floor(flat(1e5, 0.3, 0.5, 0.4));
    let (mut with, mut without) = (robot(), robot());
    for n in 0..2000 {
        let height = 0.05 + 0.01 * (0.05 * f64::from(n)).sin();
        with.step(&nosed([0.0, 0.0, height]), Some(&plate), DT);
        without.step(&nosed([0.0, 0.0, height]), None, DT);
        assert_eq!(with.tip_m(), without.tip_m());
    }
    assert!(with.energy_j() > 0.0 && !with.contact());
}

#[test]
fn a_space_that_is_turned_changes_nothing() {
    // The same drag with the axes of space renamed: first to second to third.
    let plate = floor(flat(1e5, 0.3, 0.5, 0.4));
    let turn = |[a, b, c]: [f64; 3]| [c, a, b];
    let turned_plate = Plate {
        normal: turn(plate.normal),
        along: turn(plate.along),
        ..plate
    };
    let (mut here, mut there) = (robot(), robot());
    for n in 0..1000 {
        let pose = nosed([0.0, 1e-4 * f64::from(n), -4e-3]);
        let turned = Pose {
            base_m: turn(pose.base_m),
            x: turn(pose.x),
            y: turn(pose.y),
        };
        here.step(&pose, Some(&plate), DT);
        there.step(&turned, Some(&turned_plate), DT);
    }
    for (a, b) in here.tip_m().into_iter().zip(there.tip_m()) {
        assert!((a - b).abs() < 1e-9 && a.abs() > 1e-4, "{a} {b}");
    }
}

#[test]
fn the_first_velocity_is_no_kick() {
    let mut whisker = TouchingWhisker::new(&Shaft::xy_table(), &QUIET, 1).unwrap();
    whisker.step(&level([0.0, 0.0, 0.0]), None, DT);
    whisker.step(&level([0.0, 0.0, 1e-3]), None, DT);
    assert_eq!(whisker.tip_m(), [0.0; 2]);
    whisker.step(&level([0.0, 0.0, 1e-3]), None, DT);
    assert!(whisker.tip_m()[0] > 1e-5);
}
