//! Disturbances of a head's bus and boards: nothing steps, and all whisk together again.

use host_sim::run::Run;
use host_sim::trace::WhiskerRow;

use super::{largest_step, whole};

/// The corners of the gains of RCP and CIA.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [100.0, 0.0], [0.0, 100.0], [100.0, 100.0]];

fn keys([rcp, cia]: [f64; 2]) -> [String; 2] {
    [format!("rcp.gain={rcp:?}"), format!("cia.gain={cia:?}")]
}

/// θ' of all whiskers, before the last tick and after it, and by how much one has moved at most in
/// a tick in which it counts.
#[derive(Default)]
struct Watched {
    rows: Vec<WhiskerRow>,
    before: Vec<f64>,
    theta: Vec<f64>,
    worst: f64,
}

impl Watched {
    fn tick(&mut self, run: &mut Run) {
        run.tick();
        run.look_at_whiskers(&mut self.rows);
        let theta = self.rows.iter().map(|row| row.theta_deg).collect();
        self.before = std::mem::replace(&mut self.theta, theta);
    }

    fn note(&mut self, counts: impl Fn(usize) -> bool) {
        let moved = self.theta.iter().zip(&self.before).enumerate();
        let moved = moved.filter(|(n, _)| counts(*n));
        let moved = moved.map(|(_, (theta, before))| (theta - before).abs());
        self.worst = moved.fold(self.worst, f64::max);
    }

    /// A tick of a dozen boards of two whiskers, of which those count that are armed before it and
    /// after it.
    fn tick_armed(&mut self, run: &mut Run) {
        let were_armed = armed(run);
        self.tick(run);
        let are_armed = armed(run);
        self.note(|n| were_armed[n / 2] && are_armed[n / 2]);
    }

    #[track_caller]
    fn has_not_stepped(&self, what: &str, calm: f64) {
        let worst = self.worst;
        println!("{what}: θ' moves {worst:.3} degrees a tick at most (one board {calm:.3})");
        assert!(worst < 1.25 * calm, "{what}: {worst} {calm}");
    }
}

fn armed(run: &mut Run) -> [bool; 12] {
    let bus = run.bus().unwrap();
    std::array::from_fn(|node| bus.is_armed(node))
}

fn widened([least, most]: [f64; 2], value: f64) -> [f64; 2] {
    [least.min(value), most.max(value)]
}

const NONE: [f64; 2] = [f64::MAX, f64::MIN];

/// At every corner of the gains: all boards restart at once, are armed, and then every other one
/// is cut off for good. Setpoints never step, and those that are left whisk as one.
#[test]
fn a_head_bears_a_restart_of_all_and_the_loss_of_half_at_every_gain() {
    for corner in CORNERS {
        let gains = keys(corner);
        let gains = gains.each_ref().map(String::as_str);
        let calm = largest_step(&whole(1, 4.0, &gains));
        let mut run = Run::new(&whole(24, 4.0, &gains), None).unwrap();
        let mut watched = Watched::default();
        // Of the last two whisks of a board of each side.
        let mut ends = [NONE; 2];
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
            watched.tick(&mut run);
            // What is computed while motors are off moves nothing.
            watched.note(|_| !(3_000..3_500).contains(&tick));
            if tick >= 9_000 {
                let theta = [watched.theta[1], watched.theta[13]];
                ends = [0, 1].map(|side: usize| widened(ends[side], theta[side]));
            }
        }
        let bus = run.bus().unwrap();
        assert!((0..24).all(|node| bus.is_armed(node)));
        for (side, [low, high]) in ends.into_iter().enumerate() {
            // A whisker a board: those of the boards that were not cut off.
            let joined = watched.theta[12 * side..12 * (side + 1)].iter();
            let joined = joined.skip(1).step_by(2).copied();
            let [least, most] = joined.fold(NONE, widened);
            println!("side {side}: {:.3} degrees apart", most - least);
            assert!(most - least < 0.5, "{:?}", watched.theta);
            assert!(high - low > 10.0, "{low} {high}");
        }
        watched.has_not_stepped(&format!("rcp, cia {corner:?}"), calm);
    }
}

/// Ten thousand disturbances: boards that are reset, cut off and joined again, frames missed,
/// destroyed and heard twice. Setpoints never step, and in the end all whisk together again.
#[test]
fn nothing_on_the_bus_makes_a_setpoint_step() {
    let calm = largest_step(&whole(1, 4.0, &[]));
    let mut run = Run::new(&whole(12, 4.0, &["duration_s=120.0"]), None).unwrap();
    let mut random = physics::Noise::new(7);
    let mut watched = Watched::default();
    for tick in 0..80_000_u32 {
        let bus = run.bus().unwrap();
        if tick % 8 == 0 {
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
        watched.tick_armed(&mut run);
    }
    let bus = run.bus().unwrap();
    for node in 0..12 {
        bus.cut(node, false);
    }
    bus.disturb(0.0, 0.0, 0);
    bus.repeat(0.0);
    (0..4_000).for_each(|_| run.pass());
    let bus = run.bus().unwrap();
    let joined = (0..12).all(|node| bus.is_joined(node));
    assert!(joined, "{:?}", bus.happened().last());
    bus.arm(3, true);
    (0..4_000).for_each(|_| watched.tick(&mut run));
    assert_eq!(armed(&mut run), [true; 12]);
    let left = &watched.theta[..12];
    let [least, most] = left.iter().copied().fold(NONE, widened);
    println!("in the end {:.3} degrees apart", most - least);
    assert!(most - left[0] < 0.5 && left[0] - least < 0.5, "{left:?}");
    watched.has_not_stepped("ten thousand disturbances", calm);
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
    let (mut watched, mut apart) = (Watched::default(), [0.0_f64; 2]);
    for tick in 0..11_000 {
        let bus = run.bus().unwrap();
        match tick {
            4_000 => bus.flood(Some(5)),
            5_100 => bus.reset(RESET),
            8_000 => bus.flood(None),
            8_500 => bus.arm(0, true),
            _ => {}
        }
        watched.tick_armed(&mut run);
        let left = &watched.theta[..12];
        let of_left = left.iter().map(|of| (of - left[0]).abs());
        match tick {
            6_000..8_000 => apart[0] = of_left.fold(apart[0], f64::max),
            9_000.. => apart[1] = of_left.fold(apart[1], f64::max),
            _ => {}
        }
        let armed = armed(&mut run);
        let others = (0..12).all(|node| node == RESET || armed[node]);
        assert!(others || tick < 10, "{tick}");
        match tick {
            5_100..8_500 => assert!(!armed[RESET], "{tick}"),
            8_520.. => assert!(armed[RESET], "{tick}"),
            _ => {}
        }
    }
    println!(
        "up to {:.2} degrees apart, from 0.5 s after it up to {:.3}",
        apart[0], apart[1]
    );
    watched.has_not_stepped("flooded for 2 s", calm);
    assert!(apart[0] > 20.0 && apart[1] < 0.5, "{apart:?}");
}

/// Every frame comes late by a part of a whisk, up to a whole one, at every corner of the gains: a
/// message that is too old counts as lost, so that no setpoint steps, and every board whisks on. So
/// does contact of 127 or 128.5 ms ago, whose stamp is as if it were new.
#[test]
fn a_head_bears_delays_of_up_to_a_whisk_at_every_gain() {
    const WHISK_S: f64 = 0.25;
    for corner in CORNERS {
        let gains = keys(corner);
        let gains = gains.each_ref().map(String::as_str);
        let calm = largest_step(&whole(1, 1.0 / WHISK_S, &gains));
        for delay_s in [0.001, 0.003, 0.01, 0.0625, 0.125, 0.127, 0.1285, WHISK_S] {
            let mut run = Run::new(&whole(12, 1.0 / WHISK_S, &gains), None).unwrap();
            run.bus().unwrap().delay(delay_s);
            let mut watched = Watched::default();
            let (mut ends, mut whisks) = ([NONE; 24], [0; 24]);
            for tick in 0..16_000 {
                watched.tick(&mut run);
                watched.note(|_| true);
                let moved = watched.before.iter().zip(&watched.theta);
                for (n, (before, theta)) in moved.enumerate() {
                    if tick >= 8_000 {
                        ends[n] = widened(ends[n], *theta);
                    }
                    if tick >= 12_000 {
                        let middle = f64::midpoint(ends[n][0], ends[n][1]);
                        whisks[n] += u32::from(*before < middle && *theta >= middle);
                    }
                }
            }
            let least = ends.iter().map(|[least, most]| most - least);
            let least = least.fold(f64::MAX, f64::min);
            let joined = (0..12).filter(|node| run.bus().unwrap().is_joined(*node));
            println!(
                "{} of 12 joined, a whisk {least:.0} degrees at least, {whisks:?} of them in 2 s",
                joined.count()
            );
            let what = format!("rcp, cia {corner:?}, {:.1} ms late", 1e3 * delay_s);
            watched.has_not_stepped(&what, calm);
            assert!(least > 10.0, "{least}");
            let count = |count| (7..=9).contains(count);
            assert!(whisks.iter().all(count), "{whisks:?}");
        }
    }
}
