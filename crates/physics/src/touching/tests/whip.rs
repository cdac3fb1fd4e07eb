//! Shafts that whip onto a plate: against MuJoCo's chains of hinges (`tests/truth/whip.py`), and
//! how far what does not touch goes behind the surface.

use core::f64::consts::TAU;

use super::elastica::{Row, table};
use super::{DT, QUIET, flat, slanted};
use crate::pose::PlateFrame;
use crate::{Biotact, Facing, Outline, Plate, Pose, Shaft, TouchingWhisker};

/// Where the motor is at first touch, and how far before it the whisker starts, rad.
const TOUCH: f64 = 1.0;
const BEFORE: f64 = TAU / 180.0;

/// Swung once from before first touch to `push_deg` beyond it and back, as a cosine; looked at
/// after each tick.
fn swung(
    shaft: &Shaft,
    plate: &Plate,
    (push_deg, swing_s): (f64, f64),
    mut look: impl FnMut(&TouchingWhisker, &Pose),
) {
    let ticks = (swing_s / DT).round() as u32;
    let pose = |tick: u32| {
        let rise = 0.5 - 0.5 * (TAU * f64::from(tick) / f64::from(ticks)).cos();
        Pose::swung(TOUCH - BEFORE + (BEFORE + push_deg.to_radians()) * rise)
    };
    let mut whisker = TouchingWhisker::new(shaft, &QUIET, 1).unwrap();
    // The first ones say where the base is, and that it does not move.
    for _ in 0..2 {
        whisker.step(&pose(0), Some(plate), DT);
    }
    for tick in 1..=ticks {
        whisker.step(&pose(tick), Some(plate), DT);
        look(&whisker, &pose(tick));
    }
}

fn of_motion(a: &Row, b: &Row) -> bool {
    ["slant_deg", "push_deg", "push_s"]
        .iter()
        .all(|name| a.get(name) == b.get(name))
}

#[test]
fn moments_are_those_of_a_chain_of_hinges_where_one_place_touches_and_where_two_do() {
    let shaft = Shaft::biotact(Biotact::Middle);
    let rows = table(include_str!("../../../../../tests/truth/whip.csv"));
    let mut twice = 0;
    for motion in rows.chunk_by(of_motion) {
        let get = |name: &str| motion[0].get(name);
        let ground = flat(1e6, 0.5, 0.0, 0.0);
        let facing = slanted(get("slant_deg"));
        let plate = Plate::in_the_way(TOUCH, shaft.length_m, &facing, ground);
        let mut moments = Vec::new();
        let mut both = false;
        swung(
            &shaft,
            &plate,
            (get("push_deg"), get("push_s")),
            |whisker, _| {
                moments.push(whisker.rotation_rad()[0] * shaft.follicle.rotation_n_m_rad);
                both |= whisker.contacts_at()[1].is_some();
            },
        );
        assert_eq!(moments.len(), motion.len());
        let square = |of: &dyn Fn(usize) -> f64| -> f64 {
            (0..moments.len()).map(|n| of(n) * of(n)).sum::<f64>() / moments.len() as f64
        };
        let true_at = |n: usize| motion[n].get("moment_nm");
        let peak = (0..moments.len()).map(true_at).fold(0.0, f64::max);
        let error = square(&|n| moments[n] - true_at(n)).sqrt() / peak;
        // Of a plate along the shaft the place is at the base, which shapes do not resolve.
        let most = if get("slant_deg") == 0.0 { 0.16 } else { 0.025 };
        assert!(error < most, "{error} at {} degrees", get("slant_deg"));
        twice += u32::from(both);
    }
    // The two flattest: there one place of contact is 42 and 54 % off.
    assert_eq!(twice, 2);
}

/// How far the shaft is behind the body beyond its first tenth, a share of the length.
fn behind(whisker: &TouchingWhisker, seen: &crate::pose::PlatePose) -> f64 {
    let body = &whisker.body;
    let curve = body.state.curve(&body.shaft);
    let length_m = body.shaft.length_m;
    (20..=200).map(f64::from).fold(0.0, |worst: f64, n| {
        let at = seen.place(curve.at(&body.shaft.grid.anywhere(n / 200.0 * length_m)));
        let above_m = if body.outline.is_plane() {
            at[2]
        } else {
            body.outline.tangent(at).above_m
        };
        worst.max(-above_m / length_m)
    })
}

#[test]
fn nothing_of_the_shaft_is_far_behind_the_surface() {
    let slow = [(20.0, 0.5), (20.0, 0.125), (45.0, 0.5)];
    let fast = [(30.0, 1.0 / 16.0), (30.0, 0.04)];
    for (facing, reach, outline, pushes, most) in [
        (slanted(30.0), 1.0, Outline::PLANE, slow.as_slice(), 0.005),
        (Facing::USUAL, 1.0, Outline::PLANE, &slow, 0.005),
        (slanted(0.0), 0.6, Outline::bar(5e-3), &slow, 0.005),
        (slanted(0.0), 0.6, Outline::bar(1e-3), &slow, 0.005),
        (slanted(0.0), 0.4, Outline::bar(20e-3), &fast, 0.005),
        (slanted(30.0), 1.0, Outline::PLANE, &fast, 0.03),
        (Facing::USUAL, 1.0, Outline::PLANE, &fast, 0.03),
        // Along the shaft.
        (slanted(0.0), 1.0, Outline::PLANE, &slow, 0.03),
        (slanted(0.0), 1.0, Outline::PLANE, &fast, 0.03),
    ] {
        for shaft in [Biotact::Front, Biotact::Middle, Biotact::Rear].map(Shaft::biotact) {
            let ground = flat(1e5, 0.5, 0.3, 0.3);
            let plate = Plate {
                outline,
                ..Plate::in_the_way(TOUCH, reach * shaft.length_m, &facing, ground)
            };
            let frame = PlateFrame::new(&plate);
            for push in pushes {
                let mut worst: f64 = 0.0;
                swung(&shaft, &plate, *push, |whisker, pose| {
                    worst = worst.max(behind(whisker, &frame.see(pose)));
                });
                assert!(worst < most, "{worst} {facing:?} {outline:?} {push:?}");
            }
        }
    }
}
