//! Poses: how they are spread, what they depend on, and when they may change.

use scene::Scene;

use super::Poses;
use crate::plant::SurfacePose;
use crate::run::Run;

fn scene(keys: &str) -> Scene {
    let text = include_str!("../../../../scenes/whisker.toml");
    let (all, _) = text.split_once("[classifier]").unwrap();
    Scene::from_str("s.toml", &format!("{all}{keys}\n")).unwrap()
}

const ALL: &str = "tilt_spread_deg = 3\nobstacle_spread_deg = 2\ngain_spread = 0.05";

fn parts(pose: SurfacePose) -> [f64; 3] {
    [pose.tilt_deg, pose.obstacle_deg, pose.gain - 1.0]
}

fn drawn(poses: &mut Poses, count: usize) -> Vec<[f64; 3]> {
    let pose = |_| parts(poses.take().unwrap());
    (0..count).map(pose).collect()
}

/// By the module's own whisk in the air, whose exact integrator shares no code with it.
#[test]
fn depth_is_how_far_the_free_whisk_goes_beyond_the_surface() {
    let scene = scene(ALL);
    let mut poses = Poses::new(&scene);
    let pose = poses.take().unwrap();
    let mut free = scene.clone();
    free.duration_s = 2.0;
    free.plant.spread = None;
    // A shaft that bends by its own inertia is contact to RCP, which takes a degree.
    free.rcp = None;
    free.whisking.as_mut().unwrap().noise = 0.0;
    free.plant.obstacle.as_mut().unwrap().obstacle_deg = vec![200.0];
    let mut run = Run::new(&free, None).unwrap();
    let angle = (0..run.ticks()).map(|_| run.tick().theta_deg[0]);
    let farthest = angle.fold(0.0, f64::max);
    let [[tilt, depth]] = poses.stands()[..] else {
        panic!("one whisker")
    };
    assert!((tilt - 20.0 - pose.tilt_deg).abs() < 1e-4, "{tilt}");
    let expected = farthest - 100.0 - pose.obstacle_deg;
    assert!((depth - expected).abs() < 0.05, "{depth} {expected}");
}

#[test]
fn they_are_even_within_the_spread_and_each_part_by_itself() {
    let count = 40_000;
    let poses = drawn(&mut Poses::new(&scene(ALL)), count);
    let mean = |value: &dyn Fn(&[f64; 3]) -> f64| poses.iter().map(value).sum::<f64>() / 40e3;
    for (part, spread) in [3.0, 2.0, 0.05].into_iter().enumerate() {
        let of = |pose: &[f64; 3]| pose[part] / spread;
        let most = poses.iter().map(|pose| of(pose).abs()).fold(0.0, f64::max);
        assert!((0.999..=1.0 + 1e-12).contains(&most), "{part}: {most}");
        // Five standard errors of the mean, √(1/3)/200, and of the square's, √(4/45)/200.
        assert!(mean(&of).abs() < 0.0145, "{part}");
        let square = mean(&|pose| of(pose).powi(2));
        assert!((square - 1.0 / 3.0).abs() < 0.0075, "{part}: {square}");
        let next = (part + 1) % 3;
        let product = mean(&|pose| of(pose) * pose[next] / [3.0, 2.0, 0.05][next]);
        assert!(product.abs() < 0.0084, "{part}: {product}");
        let pairs = poses.windows(2).map(|pair| of(&pair[0]) * of(&pair[1]));
        assert!((pairs.sum::<f64>() / 40e3).abs() < 0.0084, "{part}");
    }
}

#[test]
fn they_depend_on_the_seed_alone_and_no_spread_on_another() {
    let mut poses = Poses::new(&scene(ALL));
    let first = drawn(&mut poses, 50);
    assert!(first.windows(2).all(|pair| pair[0] != pair[1]));
    assert_eq!(poses.number(), Some(49));
    poses.restart(2);
    assert_eq!(poses.number(), None);
    assert_eq!(drawn(&mut poses, 50), first, "the scene's own seed");
    poses.restart(3);
    let others = drawn(&mut poses, 50);
    assert!(others.iter().all(|pose| !first.contains(pose)));
    let tilted = drawn(&mut Poses::new(&scene("tilt_spread_deg = 3")), 50);
    for (pose, [tilt, ..]) in tilted.into_iter().zip(first) {
        assert_eq!(pose, [tilt, 0.0, 0.0]);
    }
}

#[test]
fn without_a_spread_there_are_none() {
    let mut poses = Poses::new(&scene("tilt_spread_deg = 0"));
    assert!(poses.next().is_none() && poses.take().is_none());
    assert_eq!(poses.number(), None);
}

/// Runs a scene; the number of each pose that was new, and whether anything was touched in the
/// tick before it or in twenty from there on.
fn exchanges(scene: &Scene) -> Vec<(u64, bool)> {
    let mut run = Run::new(scene, None).unwrap();
    let (mut seen, mut touched, mut since) = (Vec::new(), false, 0);
    for _ in 0..run.ticks() {
        let before = run.pose();
        run.pass();
        if let Some(pose) = run.pose().filter(|pose| before != Some(*pose)) {
            seen.push((pose, touched));
            since = 0;
        }
        touched = run.touches();
        if since < 20
            && let Some((_, is_touched)) = seen.last_mut()
        {
            *is_touched |= touched;
        }
        since += 1;
    }
    seen
}

#[test]
fn each_presentation_has_another_pose_and_begins_in_the_air() {
    // Far wider than on any bench: the whisker goes back to 73°.
    let wide = "tilt_spread_deg = 40\nobstacle_spread_deg = 20\ngain_spread = 0.3";
    let mut scene = Scene {
        duration_s: 40.0,
        ..scene(wide)
    };
    if let Some(textured) = &mut scene.plant.textured {
        textured.present_s = 0.5;
    }
    let seen = exchanges(&scene);
    let numbers: Vec<u64> = seen.iter().map(|(pose, _)| *pose).collect();
    let expected: Vec<u64> = (0..seen.len() as u64).collect();
    assert_eq!(numbers, expected);
    assert!(seen.len() > 60, "{}", seen.len());
    assert!(seen.iter().all(|(_, is_touched)| !is_touched), "{seen:?}");
}
