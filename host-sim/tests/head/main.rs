//! A head of boards on a bus, beside the one board that has all its whiskers.

mod deciding;
mod disturbed;
mod looking;

use std::path::Path;

use host_sim::run::Run;
use scene::{Override, Scene};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes");

fn scene(name: &str, set: &[&str]) -> Scene {
    let loaded = Scene::load_with(Path::new(ROOT).join(name), &overrides(set));
    loaded.unwrap().0
}

fn overrides(set: &[&str]) -> Vec<Override> {
    set.iter().map(|one| one.parse().unwrap()).collect()
}

const TWO: &str = "head.nodes=2";

/// The largest θ′ of each side over the scene, and all θ′ of the left.
fn largest(scene: &Scene) -> ([f64; 2], Vec<[f64; 2]>) {
    let mut run = Run::new(scene, None).unwrap();
    let mut most = [f64::MIN; 2];
    let mut all = Vec::new();
    for tick in 0..run.ticks() {
        let row = run.tick();
        all.push(row.theta_deg);
        if tick > run.ticks() / 3 {
            for (most, theta) in most.iter_mut().zip(row.theta_deg) {
                *most = most.max(theta);
            }
        }
    }
    (most, all)
}

/// What one board's whiskers move a tick at most, degrees.
fn largest_step(scene: &Scene) -> f64 {
    let (_, all) = largest(scene);
    let steps = all
        .windows(2)
        .flat_map(|two| [0, 1].map(|side| (two[1][side] - two[0][side]).abs()));
    steps.fold(0.0, f64::max)
}

/// BIOTACT Fig. 9: by contact of the left the right finds its obstacle at 125 degrees. EQUATIONS
/// has 130.4 for one module with forward Euler.
#[test]
fn the_right_finds_its_obstacle_by_contact_of_another_board() {
    let one = scene("cia.toml", &[]);
    let two = scene("cia.toml", &[TWO]);
    let (alone, _) = largest(&one);
    let (joined, _) = largest(&two);
    assert!((alone[1] - 130.4).abs() < 0.1);
    assert!((joined[1] - 130.4).abs() < 0.5);
    let without = scene("rcp.toml", &[TWO]);
    let (never, _) = largest(&without);
    assert!(never[1] < 125.0);
}

#[test]
fn a_head_in_the_air_whisks_as_one_board() {
    for integrator in ["euler", "exact"] {
        let integrator = format!("whisking.integrator={integrator:?}");
        let (_, one) = largest(&scene("free.toml", &[&integrator]));
        let (_, four) = largest(&scene("free.toml", &[&integrator, "head.nodes=4"]));
        let differ = one.iter().zip(&four).position(|(a, b)| a != b);
        assert_eq!(differ, None, "{integrator}");
    }
}

/// A head of so many boards, or one, whisking at `hz` with an obstacle before the left side, its sides begun
/// apart.
fn whole(nodes: u8, hz: f64, more: &[&str]) -> Scene {
    let nodes = if nodes > 1 {
        format!("nodes = {nodes}")
    } else {
        String::new()
    };
    let text = format!(
        "name = \"whole\"\ntick_hz = 2000\nduration_s = 8.0\nseed = 3\n\
         [head]\nwhiskers_per_side = 12\n{nodes}\n\
         [whisking]\nfrequency_hz = {hz:?}\nintegrator = \"exact\"\ncoupling = true\n\
         noise = 0.005\ngain = 1.0\nstart = [[1.0, 0.0], [0.6, 0.5]]\n\
         [rcp]\ngain = 0.7\ntau_s = 0.125\n[cia]\ngain = 0.5\ntau_s = 0.125\n\
         [plant]\nkind = \"ideal\"\nobstacle_deg = [100.0, 125.0]\nstiffness = 0.1\n"
    );
    let made = Scene::from_str_with("test", &text, &overrides(more));
    made.unwrap().0
}

/// From contact of one board's whiskers to more drive of another's there are 4 ms, for which the
/// bus has time: 5 ms are allowed.
#[test]
fn contact_excites_the_farthest_board_in_time() {
    let mut run = Run::new(&whole(24, 2.0, &[]), None).unwrap();
    let mut latencies = Vec::new();
    let mut since = None;
    let mut before = run.tick();
    for _ in 1..run.ticks() {
        let row = run.tick();
        if before.contact[0] < 0.05 && row.contact[0] >= 0.05 {
            since = Some(run.t_s());
        }
        // Of the first whisker of the right.
        if let Some(felt_s) = since.filter(|_| row.g[1] > before.g[1] + 1e-3) {
            latencies.push(run.t_s() - felt_s);
            since = None;
        }
        before = row;
    }
    let worst = latencies.iter().copied().fold(0.0, f64::max);
    let mean = latencies.iter().sum::<f64>() / latencies.len() as f64;
    let load = run.bus().unwrap().load();
    println!(
        "24 boards: {} contacts, {:.2} ms to excitation in the mean, {:.2} at most; bus busy \
         {:.1} %, a frame at most {:.2} ms",
        latencies.len(),
        mean * 1e3,
        worst * 1e3,
        100.0 * load.busy_s / run.t_s(),
        load.worst_s * 1e3,
    );
    assert!(latencies.len() > 10);
    assert!(worst <= 5e-3, "{worst}");
    assert!(load.worst_s < 4e-3 && load.dropped == 0, "{load:?}");
}

/// How far the sides are apart, degrees, at the frequency of the whisk; boards of a head are reset
/// and armed again before, so that each has noise of its own.
fn phase_deg(scene: &Scene, hz: f64) -> f64 {
    let mut run = Run::new(scene, None).unwrap();
    let settled = run.ticks() / 2;
    for tick in 0..settled {
        if let Some(bus) = run.bus() {
            let node = tick / 100;
            match tick % 100 {
                0 if (1..24).contains(&node) => bus.reset(node as usize),
                0 if node == 30 => bus.arm(0, true),
                _ => {}
            }
        }
        run.tick();
    }
    let mut sums = [[0.0_f64; 2]; 2];
    for tick in settled..run.ticks() {
        let (sin, cos) = (std::f64::consts::TAU * hz * tick as f64 / 2000.0).sin_cos();
        for ([x, y], theta) in sums.iter_mut().zip(run.tick().theta_deg) {
            *x += theta * cos;
            *y += theta * sin;
        }
    }
    let [left, right] = sums.map(|[x, y]| f64::atan2(y, x).to_degrees());
    left - right
}

#[test]
fn sides_on_many_boards_whisk_together_as_on_one() {
    for hz in [2.0, 8.0] {
        let free = ["plant.obstacle_deg=[300.0, 300.0]", "duration_s=40.0"];
        let [one, many] = [1, 24].map(|nodes| phase_deg(&whole(nodes, hz, &free), hz));
        println!("{hz} Hz: sides {one:.3} degrees apart on one board, {many:.3} on 24");
        assert!((many - one).abs() < 1.0);
    }
}

#[test]
fn a_stop_reaches_boards_that_were_cut_off() {
    // For long, and for less than the 30 ms after which it is missed.
    let cuts = [(1_000, 1_500), (1_195, 1_250)];
    for (stopped_by, (cut, back)) in [0, 2].into_iter().flat_map(|by| cuts.map(|cut| (by, cut))) {
        let mut run = Run::new(&whole(3, 2.0, &[]), None).unwrap();
        for tick in 0..2_000 {
            let bus = run.bus().unwrap();
            match tick {
                _ if tick == cut => bus.cut(2, true),
                1_200 => bus.arm(stopped_by, false),
                _ if tick == back => bus.cut(2, false),
                _ => {}
            }
            if tick == back {
                let armed = [0, 2].map(|node| bus.is_armed(node));
                assert_eq!(armed, [stopped_by == 2, stopped_by == 0]);
            }
            if tick > back + 60 {
                assert!(!(0..3).any(|node| bus.is_armed(node)), "{tick}");
            }
            run.tick();
        }
    }
}

/// Of two that are asked for at once the stop holds, whichever board says it.
#[test]
fn an_arm_that_was_made_before_a_stop_arms_no_board() {
    for (armed_by, stopped_by, after, is_armed) in [
        (0, 2, 0, false),
        (2, 0, 0, false),
        (1, 0, 0, false),
        // Its own stop it need not say again, and those of others are over.
        (0, 0, 1, true),
        (0, 2, 80, true),
    ] {
        let mut run = Run::new(&whole(3, 2.0, &[]), None).unwrap();
        for tick in 0..1_300 {
            let bus = run.bus().unwrap();
            if tick == 1_000 || tick == 1_100 {
                bus.arm(stopped_by, false);
            }
            if tick == 1_100 + after {
                bus.arm(armed_by, true);
            }
            if tick > 1_100 + after + 20 {
                let armed = [0, 1, 2].map(|node| bus.is_armed(node));
                assert_eq!(armed, [is_armed; 3], "{armed_by} {stopped_by} {tick}");
            }
            run.tick();
        }
    }
}
