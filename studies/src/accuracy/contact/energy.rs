//! Whether contact creates energy: whiskers let go over plates, bases at rest.

use super::runs::{Subject, TICKS_HZ, pose, surfaces};
use anyhow::Result;
use physics::{Material, Surface};

/// Stiffnesses of the smooth plates, N/m: all that a surface may have.
const STIFFNESSES_N_M: [f64; 5] = [1.0, 1e3, 1e5, 1e7, 1e9];
/// Tips are bent by this share of the length, and let go with the straight tip
/// this many degrees beyond or before first touch.
const BENDS: [[f64; 2]; 3] = [[0.1, 0.05], [0.2, 0.0], [0.02, -0.1]];
const OVERLAPS_DEG: [f64; 3] = [-3.0, -0.2, 5.0];
/// Length of a run, s.
const SECONDS: f64 = 0.2;

/// Largest rise of the energy from one tick to the next, as a share of the most
/// there was; and by how much the ground counted as lower than it is, at most, m;
/// over bends, overlaps and ticks.
fn rise(subject: &Subject, surface: Surface) -> Result<[f64; 2]> {
    let (mut worst, mut lowered) = (0.0_f64, 0.0_f64);
    for hz in TICKS_HZ {
        let dt_s = 1.0 / f64::from(hz);
        for bend in BENDS {
            for overlap in OVERLAPS_DEG {
                let mut whisker = subject.whisker(0)?;
                let (pose, plate) = (pose(overlap), subject.plate(surface));
                whisker.bend(bend.map(|share| share * subject.length_m()));
                // The first step may find the tip below the ground.
                whisker.step(&pose, Some(&plate), dt_s);
                let mut last = whisker.energy_j();
                let (mut most, mut up) = (last, 0.0);
                for _ in 0..(SECONDS / dt_s) as u32 {
                    whisker.step(&pose, Some(&plate), dt_s);
                    let energy = whisker.energy_j();
                    up = f64::max(up, energy - last);
                    most = most.max(energy);
                    lowered = lowered.max(whisker.lowered_m());
                    last = energy;
                }
                worst = worst.max(up / most.max(f64::MIN_POSITIVE));
            }
        }
    }
    Ok([worst, lowered])
}

/// Largest rises and lowerings by plate: smooth ones without damping, by stiffness and
/// friction, and textured ones as they are.
pub(super) fn rises() -> Result<Vec<(String, [f64; 2])>> {
    let subject = Subject::new()?;
    let mut list = Vec::new();
    for stiffness_n_m in STIFFNESSES_N_M {
        for friction in [0.0, 0.5] {
            let surface = Surface {
                stiffness_n_m,
                damping: 0.0,
                friction,
                hold: 1.2 * friction,
                ..Surface::of(Material::Flat)
            };
            let name = format!("smooth, {stiffness_n_m:.0e} N/m, μ {friction}, undamped");
            list.push((name, rise(&subject, surface)?));
        }
    }
    for (name, surface) in surfaces() {
        if surface.height_m > 0.0 {
            list.push((name.to_owned(), rise(&subject, surface)?));
        }
    }
    Ok(list)
}
