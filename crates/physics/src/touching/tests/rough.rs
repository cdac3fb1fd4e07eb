//! Textures: jumps, dead zones, seeds, and what depends on the material.

use super::energy::materials;
use super::{DT, QUIET, floor};
use crate::{Biotact, Material, Pose, SensorSettings, Shaft, Surface, TouchingWhisker};

/// A reading, and whether the tip touched.
type Read = ([f64; 2], bool);

/// After `n` steps at 0.2 m/s: 15° below the level and 45° to the way, pressed
/// down by a twentieth of the length.
fn slanted(n: usize, length_m: f64) -> Pose {
    let (sine, cosine) = 15.0_f64.to_radians().sin_cos();
    let half = 0.5_f64.sqrt();
    Pose {
        base_m: [1e-4 * n as f64, 0.0, length_m * (sine - 0.05)],
        x: [-half, half, 0.0],
        y: [half * sine, half * sine, cosine],
    }
}

/// The floor robot's whisker drawn over a surface for 5 s.
fn drawn(surface: Surface, settings: SensorSettings, seed: u64) -> Vec<Read> {
    let mut whisker = TouchingWhisker::new(&Shaft::floor_robot(), &settings, seed).unwrap();
    let mut step = |n: usize| {
        whisker.step(&slanted(n, 0.2), Some(&floor(surface)), DT);
        (whisker.reading(), whisker.contact())
    };
    (0..12_000).map(&mut step).skip(2000).collect()
}

/// Mean and spread of x and y, and the share of time in contact.
fn numbers(run: &[Read]) -> ([f64; 2], [f64; 2], f64) {
    let count = run.len() as f64;
    let mean = [0, 1].map(|i| run.iter().map(|at| at.0[i]).sum::<f64>() / count);
    let spread = [0, 1].map(|i| {
        let squares = run.iter().map(|at| (at.0[i] - mean[i]).powi(2));
        (squares.sum::<f64>() / count).sqrt()
    });
    let touching = run.iter().filter(|at| at.1).count() as f64;
    (mean, spread, touching / count)
}

#[test]
fn rough_grounds_shake_more_and_are_left_at_times() {
    let of = |material| numbers(&drawn(Surface::of(material), QUIET, 1));
    let vinyl = of(Material::Vinyl);
    assert!(vinyl.2 > 0.99, "{vinyl:?}");
    for rough in [of(Material::Tarmac), of(Material::RoughCarpet)] {
        assert!((0.5..0.99).contains(&rough.2), "{rough:?}");
        for k in 0..2 {
            assert!(rough.1[k] > 4.0 * vinyl.1[k], "{rough:?} {vinyl:?}");
        }
        // Dragged back more strongly (LEP12 section 6).
        let more = rough.0[0].abs() / vinyl.0[0].abs();
        assert!(more > 1.5, "{rough:?} {vinyl:?}");
    }
}

#[test]
fn dead_zones_and_jumps_come_out() {
    let run = drawn(Surface::of(Material::RoughCarpet), QUIET, 1);
    // A dead zone: off the ground for 10 ms or more.
    let longest = run.split(|at| at.1).map(<[_]>::len).max().unwrap();
    assert!(longest >= 20, "{longest}");
    // A jump: within 2 ms by more than the spread of the whole.
    let (_, spread, _) = numbers(&run);
    let jump = |five: &[Read]| (five[4].0[0] - five[0].0[0]).abs();
    let most = run.windows(5).map(jump).fold(0.0, f64::max);
    assert!(most > spread[0], "{most} {spread:?}");
}

#[test]
fn the_same_seeds_give_the_same_readings_and_others_do_not() {
    let noisy = SensorSettings::default();
    let surface = Surface::of(Material::Tarmac);
    let one = drawn(surface, noisy, 5);
    assert!(one == drawn(surface, noisy, 5));
    assert!(one != drawn(surface, noisy, 6));
    assert!(one != drawn(surface.piece(1), noisy, 5));
}

#[test]
fn a_floor_rings_where_the_whisker_does_with_its_tip_held() {
    // LEP12 Fig. 9: 30 to 40 Hz. The floor holds the tip in y and lets it slide
    // in x.
    let run = drawn(Surface::of(Material::Vinyl), QUIET, 1);
    let mean = numbers(&run).0[1];
    let power = |hz: f64| {
        let step = core::f64::consts::TAU * hz * DT;
        let (mut c, mut s) = (0.0, 0.0);
        for (n, at) in run.iter().enumerate() {
            let (sine, cosine) = (step * n as f64).sin_cos();
            c += (at.0[1] - mean) * cosine;
            s += (at.0[1] - mean) * sine;
        }
        c * c + s * s
    };
    // Mean power of bands, at every fifth of a hertz.
    let band = |low: u32, high: u32| {
        let bins = (5 * low..5 * high).map(|bin| power(f64::from(bin) / 5.0));
        bins.sum::<f64>() / f64::from(high - low)
    };
    let rings = band(30, 40);
    for (low, high) in [(4, 12), (12, 20), (20, 28), (42, 60), (60, 90)] {
        assert!(band(low, high) < rings, "{low} to {high} Hz");
    }
}

#[test]
fn the_ground_stays_where_it_is() {
    // Drawn over every material at 0.2 m/s: contact pays for the ground's height at once.
    let shafts = [
        Shaft::floor_robot(),
        Shaft::biotact(Biotact::Front),
        Shaft::psikharpax(1),
    ];
    for material in materials() {
        let surface = Surface::of(material);
        // The coarsest abrasives have the steepest grains: it soon does.
        let coarse = surface.grain_m > 0.2e-3 && surface.height_m > 0.3 * surface.grain_m;
        let seldom = if coarse { 30 } else { 500 };
        for shaft in &shafts {
            let mut whisker = TouchingWhisker::new(shaft, &QUIET, 1).unwrap();
            let (mut touching, mut lowered) = (0, 0);
            for n in 0..2000 {
                whisker.step(&slanted(n, shaft.length_m), Some(&floor(surface)), DT);
                touching += u32::from(whisker.contact());
                lowered += u32::from(whisker.lowered_m() > 0.01 * surface.height_m);
            }
            let is_paid = touching > 1000 && lowered <= touching / seldom;
            assert!(is_paid, "{material:?} {lowered} {touching}");
        }
    }
}
