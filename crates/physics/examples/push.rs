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
use std::str::FromStr;
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
    let words: Vec<String> = args().skip(1).collect();
    let [push_deg, push_s, tick_hz, finer, contact, repeats] = words.as_slice() else {
        refuse();
    };
    let push_rad = number::<f64>(push_deg).to_radians();
    let [push_s, tick_hz] = [push_s, tick_hz].map(|word| number::<f64>(word));
    let (finer, repeats) = (number(finer), number::<usize>(repeats));
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
    let plate = (contact == "plate").then_some(plate);

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

fn number<T: FromStr>(word: &str) -> T {
    word.parse().unwrap_or_else(|_| refuse())
}

fn refuse() -> ! {
    eprintln!("push PUSH_DEG PUSH_S TICK_HZ FINER plate|free REPEATS");
    std::process::exit(2)
}
