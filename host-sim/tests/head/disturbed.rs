//! Disturbances of a head's bus and boards: nothing steps, and all whisk together again.

use host_sim::bench::Bus;
use host_sim::run::Run;

use super::{largest_step, whole};

/// At every corner of the gains: all boards restart at once, are armed, and then every other one
/// is cut off for good. Setpoints never step, and those that are left whisk as one.
#[test]
fn a_head_bears_a_restart_of_all_and_the_loss_of_half_at_every_gain() {
    for (rcp, cia) in [(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (100.0, 100.0)] {
        let gains = [format!("rcp.gain={rcp:?}"), format!("cia.gain={cia:?}")];
        let gains = gains.each_ref().map(String::as_str);
        let calm = largest_step(&whole(1, 4.0, &gains));
        let mut run = Run::new(&whole(24, 4.0, &gains), None).unwrap();
        let (mut rows, mut last) = (Vec::new(), Vec::<f64>::new());
        let mut worst = 0.0_f64;
        // Of the last two whisks of a board of each side.
        let mut ends = [[f64::MAX, f64::MIN]; 2];
        for tick in 0..10_000 {
            let bus = run.bus().unwrap();
            for node in 0..24 {
                match tick {
                    3_000 => bus.reset(node),
                    6_000 => bus.cut(node, node % 2 == 0),
                    _ => {}
                }
            }
            if tick == 3_400 {
                assert!((0..24).all(|node| bus.is_joined(node) && !bus.is_armed(node)));
                bus.arm(7, true);
            }
            run.tick();
            run.look_at_whiskers(&mut rows);
            // What is computed while motors are off moves nothing.
            if !(3_000..3_500).contains(&tick) {
                for (row, before) in rows.iter().zip(&last) {
                    worst = worst.max((row.theta_deg - before).abs());
                }
            }
            last = rows.iter().map(|row| row.theta_deg).collect();
            if tick >= 9_000 {
                for ([least, most], theta) in ends.iter_mut().zip([last[1], last[13]]) {
                    (*least, *most) = (least.min(theta), most.max(theta));
                }
            }
        }
        let bus = run.bus().unwrap();
        assert!((0..24).all(|node| bus.is_armed(node)));
        for side in 0..2 {
            // A whisker a board: those of the boards that were not cut off.
            let joined = last[12 * side..12 * (side + 1)].iter().skip(1).step_by(2);
            let [least, most] = joined.fold([f64::MAX, f64::MIN], |[least, most], theta| {
                [least.min(*theta), most.max(*theta)]
            });
            println!(
                "rcp {rcp}, cia {cia}, side {side}: {:.3} degrees apart",
                most - least
            );
            assert!(most - least < 0.5, "{last:?}");
            let whisk = ends[side][1] - ends[side][0];
            assert!(whisk > 10.0, "{whisk}");
        }
        println!("θ' moves {worst:.3} degrees a tick at most (one board {calm:.3})");
        assert!(worst < 1.25 * calm, "{worst} {calm}");
    }
}

/// Ten thousand disturbances: boards that are reset, cut off and joined again, frames missed,
/// destroyed and heard twice. Setpoints never step, and in the end all whisk together again.
#[test]
fn nothing_on_the_bus_makes_a_setpoint_step() {
    let calm = largest_step(&whole(1, 4.0, &[]));
    let mut run = Run::new(&whole(12, 4.0, &["duration_s=120.0"]), None).unwrap();
    let mut random = physics::Noise::new(7);
    let mut rows = Vec::new();
    let mut last: Vec<f64> = Vec::new();
    let (mut done, mut worst) = (0, 0.0_f64);
    for tick in 0..80_000_u32 {
        let bus = run.bus().unwrap();
        if tick % 8 == 0 {
            done += 1;
            let node = (random.uniform() * 11.99) as usize;
            match (random.uniform() * 20.0) as u32 {
                0 => bus.reset(node),
                1..5 => bus.cut(node, true),
                5..11 => bus.cut(node, false),
                11 => bus.arm(node, true),
                12 => bus.arm(node, random.uniform() < 0.9),
                _ => {
                    let missed = random.uniform() * 0.3;
                    bus.disturb(missed, random.uniform() * 0.2, tick.into());
                    bus.repeat(random.uniform() * 0.1);
                }
            }
        }
        let armed = |bus: &Bus| -> Vec<bool> { (0..12).map(|node| bus.is_armed(node)).collect() };
        let were_armed = armed(bus);
        run.tick();
        run.look_at_whiskers(&mut rows);
        let are_armed = armed(run.bus().unwrap());
        for (n, row) in rows.iter().enumerate() {
            let is_armed = were_armed[n / 2] && are_armed[n / 2];
            if let Some(before) = last.get(n).filter(|_| is_armed) {
                worst = worst.max((row.theta_deg - before).abs());
            }
        }
        last = rows.iter().map(|row| row.theta_deg).collect();
    }
    let bus = run.bus().unwrap();
    for node in 0..12 {
        bus.cut(node, false);
    }
    bus.disturb(0.0, 0.0, 0);
    bus.repeat(0.0);
    for _ in 0..4_000 {
        run.tick();
    }
    let bus = run.bus().unwrap();
    assert!(
        (0..12).all(|node| bus.is_joined(node)),
        "{:?}",
        bus.happened().last()
    );
    bus.arm(3, true);
    for _ in 0..4_000 {
        run.tick();
    }
    let bus = run.bus().unwrap();
    assert!((0..12).all(|node| bus.is_armed(node)));
    run.look_at_whiskers(&mut rows);
    let left: Vec<f64> = rows[..12].iter().map(|row| row.theta_deg).collect();
    let spread = left
        .iter()
        .fold(0.0_f64, |most, theta| most.max((theta - left[0]).abs()));
    println!(
        "{done} disturbances: θ' moves {worst:.3} degrees a tick at most (one board {calm:.3}); in the end {spread:.3} apart"
    );
    assert!(spread < 0.5, "{left:?}");
    assert!(worst < 1.25 * calm, "{worst} {calm}");
}

/// A board floods the bus for eight whisks, and no one hears another: all whisk on, and one that is
/// reset meanwhile is beside the others. Two whisks after the flood they whisk as one, and no
/// setpoint of a motor steps.
#[test]
fn a_flooded_head_whisks_on_and_is_one_again_after_it() {
    const RESET: usize = 3;
    let free = ["plant.obstacle_deg=[300.0, 300.0]"];
    let calm = largest_step(&whole(1, 4.0, &free));
    let mut run = Run::new(&whole(12, 4.0, &free), None).unwrap();
    let (mut rows, mut last) = (Vec::new(), Vec::<f64>::new());
    let (mut worst, mut apart) = (0.0_f64, [0.0_f64; 2]);
    for tick in 0..11_000 {
        let bus = run.bus().unwrap();
        match tick {
            4_000 => bus.flood(Some(5)),
            5_100 => bus.reset(RESET),
            8_000 => bus.flood(None),
            8_500 => bus.arm(0, true),
            _ => {}
        }
        let is_armed: Vec<bool> = (0..12).map(|node| bus.is_armed(node)).collect();
        run.tick();
        run.look_at_whiskers(&mut rows);
        let theta: Vec<f64> = rows.iter().map(|row| row.theta_deg).collect();
        let bus = run.bus().unwrap();
        for (n, before) in last.iter().enumerate() {
            if is_armed[n / 2] && bus.is_armed(n / 2) {
                worst = worst.max((theta[n] - before).abs());
            }
        }
        let of_left = theta[..12].iter().map(|of| (of - theta[0]).abs());
        match tick {
            6_000..8_000 => apart[0] = of_left.fold(apart[0], f64::max),
            9_000.. => apart[1] = of_left.fold(apart[1], f64::max),
            _ => {}
        }
        last = theta;
        let are_armed = (0..12).all(|node| node == RESET || bus.is_armed(node));
        assert!(are_armed || tick < 10, "{tick}");
        match tick {
            5_100..8_500 => assert!(!bus.is_armed(RESET), "{tick}"),
            8_520.. => assert!(bus.is_armed(RESET), "{tick}"),
            _ => {}
        }
    }
    println!(
        "flooded for 2 s: θ' moves {worst:.3} degrees a tick at most (one board {calm:.3}); up to \
         {:.2} degrees apart, from 0.5 s after it up to {:.3}",
        apart[0], apart[1]
    );
    assert!(worst < 1.25 * calm, "{worst} {calm}");
    assert!(apart[0] > 20.0 && apart[1] < 0.5, "{apart:?}");
}

/// Every frame comes late by a part of a whisk, up to a whole one, at every corner of the gains: a
/// message that is too old counts as lost, so that no setpoint steps, and every board whisks on. So
/// does contact of 127 or 128.5 ms ago, whose stamp is as if it were new.
#[test]
fn a_head_bears_delays_of_up_to_a_whisk_at_every_gain() {
    const WHISK_S: f64 = 0.25;
    for (rcp, cia) in [(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (100.0, 100.0)] {
        let gains = [format!("rcp.gain={rcp:?}"), format!("cia.gain={cia:?}")];
        let gains = gains.each_ref().map(String::as_str);
        let calm = largest_step(&whole(1, 1.0 / WHISK_S, &gains));
        for delay_s in [0.001, 0.003, 0.01, 0.0625, 0.125, 0.127, 0.1285, WHISK_S] {
            let mut run = Run::new(&whole(12, 1.0 / WHISK_S, &gains), None).unwrap();
            run.bus().unwrap().delay(delay_s);
            let (mut rows, mut last) = (Vec::new(), Vec::<f64>::new());
            let mut worst = 0.0_f64;
            let mut ends = [[f64::MAX, f64::MIN]; 24];
            let mut whisks = [0; 24];
            for tick in 0..16_000 {
                run.tick();
                run.look_at_whiskers(&mut rows);
                for (n, before) in last.iter().enumerate() {
                    let theta = rows[n].theta_deg;
                    worst = worst.max((theta - before).abs());
                    if tick >= 8_000 {
                        let [least, most] = &mut ends[n];
                        (*least, *most) = (least.min(theta), most.max(theta));
                    }
                    if tick >= 12_000 {
                        let middle = f64::midpoint(ends[n][0], ends[n][1]);
                        whisks[n] += u32::from(*before < middle && theta >= middle);
                    }
                }
                last = rows.iter().map(|row| row.theta_deg).collect();
            }
            let least = ends.iter().map(|[least, most]| most - least);
            let least = least.fold(f64::MAX, f64::min);
            let joined = (0..12).filter(|node| run.bus().unwrap().is_joined(*node));
            println!(
                "rcp {rcp}, cia {cia}, {:.1} ms late: {} of 12 joined, θ' moves {worst:.3} degrees \
                 a tick at most (one board {calm:.3}), a whisk {least:.0} degrees at least, \
                 {:?} of them in 2 s",
                1e3 * delay_s,
                joined.count(),
                [whisks.iter().min().unwrap(), whisks.iter().max().unwrap()],
            );
            assert!(worst < 1.25 * calm, "{worst} {calm}");
            assert!(least > 10.0, "{least}");
            assert!(
                whisks.iter().all(|count| (7..=9).contains(count)),
                "{whisks:?}"
            );
        }
    }
}
