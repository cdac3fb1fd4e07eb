//! BIOTACT's middle whisker, swung once against a hard plate without friction.
//!
//! `push PUSH_DEG PUSH_S TICK_HZ FINER plate|free REPEATS` writes the moment at the base at the end of
//! every tick as CSV, and below it the seconds that a simulated second of the loop takes, the
//! least of so many repeats.
//!
//! The motor goes from 2° before first touch to PUSH_DEG beyond it and back in PUSH_S seconds, as
//! a cosine. `tests/truth/against_mujoco.py` uses it.

use std::env::args;
use std::f64::consts::TAU;
use std::time::Instant;

use physics::{
    Biotact, Facing, Material, Plate, Pose, SensorSettings, Shaft, Surface, TouchingWhisker,
};

/// Angle of the motor before first touch at which a push starts, rad.
const BEFORE: f64 = 2.0 * TAU / 360.0;

/// Angle of first touch, rad.
const TOUCH: f64 = 1.0;

/// Ticks at rest before a push: the first ones say where the base is and that it does not move.
const STILL: usize = 2;

fn main() {
    let Some((push_rad, push_s, tick_hz, finer, contact, repeats)) = arguments() else {
        eprintln!("push PUSH_DEG PUSH_S TICK_HZ FINER plate|free REPEATS");
        std::process::exit(2);
    };
    let shaft = Shaft::biotact(Biotact::Middle);
    let facing = Facing {
        tilt_deg: 0.0,
        ..Facing::USUAL
    };
    let smooth = Surface {
        hold: 0.0,
        friction: 0.0,
        ..Surface::of(Material::Flat)
    };
    let plate = Plate::in_the_way(TOUCH, shaft.length_m, &facing, smooth);
    let plate = contact.then_some(plate);

    let ticks = (push_s * tick_hz).round() as usize;
    let dt_s = 1.0 / tick_hz;
    let angle = |tick: usize| {
        let rise = 0.5 - 0.5 * (TAU * tick as f64 / ticks as f64).cos();
        TOUCH - BEFORE + (BEFORE + push_rad) * rise
    };
    let poses: Vec<Pose> = (1..=ticks).map(|tick| Pose::swung(angle(tick))).collect();
    let straight = TouchingWhisker::new(&shaft, &SensorSettings::default(), 1);
    let mut straight = straight.expect("a whisker of the papers");
    for _ in 0..STILL {
        straight.step(&Pose::swung(angle(0)), plate.as_ref(), dt_s);
    }
    let straight = straight.finer(finer);

    let mut moments = vec![0.0; ticks];
    let mut least_s = f64::INFINITY;
    for _ in 0..repeats.max(1) {
        let mut whisker = straight.clone();
        let start = Instant::now();
        for (pose, moment) in poses.iter().zip(&mut moments) {
            whisker.step(pose, plate.as_ref(), dt_s);
            *moment = whisker.rotation_rad()[0] * shaft.follicle.rotation_n_m_rad;
        }
        least_s = least_s.min(start.elapsed().as_secs_f64());
    }

    println!("time_s,moment_nm");
    for (tick, moment) in moments.iter().enumerate() {
        println!("{},{moment}", (tick + 1) as f64 * dt_s);
    }
    println!("seconds,{}", least_s / push_s);
}

fn arguments() -> Option<(f64, f64, f64, u32, bool, usize)> {
    let mut words = args().skip(1);
    let push_deg: f64 = words.next()?.parse().ok()?;
    let push_s = words.next()?.parse().ok()?;
    let tick_hz = words.next()?.parse().ok()?;
    let finer = words.next()?.parse().ok()?;
    let contact = words.next()? == "plate";
    let repeats = words.next()?.parse().ok()?;
    Some((
        push_deg.to_radians(),
        push_s,
        tick_hz,
        finer,
        contact,
        repeats,
    ))
}
