//! The loop closed through simulated motors, whiskers and sensors: touch is
//! gentle with RCP, motors follow θ' and keep to their range, and chance has
//! one source.

use crate::played::{TICK_HZ, scene, textured, undisturbed};
use host_sim::trace::Row;
use scene::{Driver, Scene};

const DRIVERS: [Driver; 2] = [Driver::HBridge, Driver::SixStep];

/// Deflection along the direction of whisking, as a share of the range.
fn deflection(row: &Row, side: usize) -> f64 {
    (row.x[side] - 8192.0) / 8191.0
}

fn highest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

fn with_driver(mut scene: Scene, driver: Driver) -> Scene {
    scene.motor.as_mut().unwrap().driver = driver;
    scene
}

#[test]
fn with_rcp_the_touch_is_gentle() {
    // Soft enough that the shaft is not at the end of its bend.
    let plant = textured(90.0).replace("stiffness = 0.1", "stiffness = 0.04");
    let rcp = "[rcp]\ngain = 2.0\ntau_s = 0.0625\n";
    let touch = |more: &str, driver| {
        let scene = with_driver(scene(1, &plant, more), driver);
        let played = undisturbed(&scene, 4 * TICK_HZ);
        assert_eq!(played.events, []);
        [0, 1].map(|side| {
            // The first whisk is not yet on the limit cycle.
            let rows = &played.rows[TICK_HZ as usize / 2..];
            let push = highest(rows.iter().map(|row| row.angle_deg[side] - 90.0));
            let peak = highest(rows.iter().map(|row| deflection(row, side)));
            let bent = rows.iter().map(|row| deflection(row, side).abs());
            [push, peak, bent.sum::<f64>() / rows.len() as f64]
        })
    };
    for driver in DRIVERS {
        let (free, gated) = (touch("", driver), touch(rcp, driver));
        for (free, gated) in free.iter().zip(gated) {
            println!("{driver:?}: push, peak and mean of x: {free:.3?}, with RCP {gated:.3?}");
            assert!((30.0..33.0).contains(&free[0]), "{free:?}");
            assert!((15.0..18.0).contains(&gated[0]), "{gated:?}");
            let share: Vec<f64> = gated.iter().zip(free).map(|(g, f)| g / f).collect();
            assert!((0.7..0.85).contains(&share[1]), "peak {share:?}");
            assert!((0.2..0.35).contains(&share[2]), "mean {share:?}");
        }
    }
}

#[test]
fn free_whiskers_follow_within_a_few_degrees() {
    // Proportional control trails by about 12 ms, so the error grows with speed.
    for (frequency_hz, least, most) in [(2.0, 2.4, 3.1), (4.0, 4.1, 5.1), (8.0, 7.7, 9.5)] {
        for driver in DRIVERS {
            let mut scene = with_driver(scene(1, &textured(300.0), ""), driver);
            scene.whisking.as_mut().unwrap().frequency_hz = frequency_hz;
            let played = undisturbed(&scene, 4 * TICK_HZ);
            assert_eq!(played.events, []);
            let rows = &played.rows[TICK_HZ as usize / 2..];
            for side in 0..2 {
                let error = |row: &Row| (row.angle_deg[side] - row.theta_deg[side]).powi(2);
                let rms = (rows.iter().map(error).sum::<f64>() / rows.len() as f64).sqrt();
                println!("{frequency_hz} Hz, {driver:?}: RMS error {rms:.2} degrees");
                assert!((least..most).contains(&rms), "{rms}");
                let top = highest(rows.iter().map(|row| row.angle_deg[side]));
                assert!(top > 118.0, "{top}");
            }
        }
    }
}

#[test]
fn a_whisker_without_drive_stands_still() {
    for driver in DRIVERS {
        let mut scene = with_driver(scene(1, &textured(300.0), ""), driver);
        scene.whisking.as_mut().unwrap().gain = vec![0.0; 2];
        let played = undisturbed(&scene, TICK_HZ);
        let counts = 360.0 / (512.0 * 11.0);
        let mut angles = played.rows.iter().flat_map(|row| row.angle_deg);
        assert!(angles.all(|angle| (angle - 50.0).abs() <= counts));
    }
}

#[test]
fn motors_keep_to_their_range() {
    let play = |gain: f64, range: [f64; 2], driver| {
        let mut scene = with_driver(scene(1, &textured(300.0), ""), driver);
        scene.whisking.as_mut().unwrap().gain = vec![gain; 2];
        let motor = scene.motor.as_mut().unwrap();
        [motor.min_deg, motor.max_deg] = range;
        let played = undisturbed(&scene, 4 * TICK_HZ);
        assert_eq!(played.events, []);
        played.rows
    };
    let extent = |rows: &[Row]| {
        let angles = || rows.iter().flat_map(|row| row.angle_deg);
        [-highest(angles().map(|angle| -angle)), highest(angles())]
    };
    let asked = |rows: &[Row]| highest(rows.iter().map(|row| row.theta_deg[0]));
    let whisk = TICK_HZ as usize / 4;
    for driver in DRIVERS {
        // The default range holds all that θ' can be.
        let rows = play(2.0, [30.0, 160.0], driver);
        let [low, high] = extent(&rows);
        assert!(low > 49.0 && high > 145.0 && high < asked(&rows));

        for gain in [1.0, 2.0] {
            let rows = play(gain, [90.0, 100.0], driver);
            let (first, [low, high]) = (extent(&rows)[1], extent(&rows[whisk..]));
            println!("{driver:?}: first up to {first:.2}, then {low:.2} to {high:.2}");
            assert!(asked(&rows) > 120.0);
            assert!((90.0..91.0).contains(&low) && (99.5..=100.0).contains(&high));
            // Cut short at full speed, the rotor's momentum carries it on a little.
            assert!(first < 102.0, "{first}");
        }
    }
}
