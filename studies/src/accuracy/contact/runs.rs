//! Whisks against plates, as a reference has them and as ticks do.

use anyhow::Result;
use core::f64::consts::TAU;

use physics::{
    Biotact, Facing, Grit, Material, Modes, Plate, Pose, SensorSettings, Shaft, Surface,
    TouchingWhisker,
};

pub(in crate::accuracy) const TICKS_HZ: [u32; 5] = [500, 1_000, 2_000, 4_000, 8_000];
/// Steps of the reference a second, and how much finer it cuts them.
const REFERENCE: (u32, u32) = (128_000, 2);
/// The same run at half the rate: what the reference itself is worth.
const HALF: (u32, u32) = (64_000, 2);

/// Length of a run, s, and rate at which rotations are compared, Hz.
const SECONDS: u32 = 2;
const SAMPLES_HZ: u32 = 500;

/// The whisk: frequency, Hz, amplitude and mean, degrees beyond first touch.
const WHISK: [f64; 3] = [2.0, 10.0, -3.0];
/// Angle of first touch, rad.
const TOUCH_RAD: f64 = 1.7;

type Named = (&'static str, Surface);

fn surfaces() -> [Named; 8] {
    let of = Surface::of;
    [
        ("flat", of(Material::Flat)),
        (
            "flat, no friction",
            Surface {
                friction: 0.0,
                hold: 0.0,
                ..of(Material::Flat)
            },
        ),
        ("vinyl", of(Material::Vinyl)),
        ("tarmac", of(Material::Tarmac)),
        ("rough carpet", of(Material::RoughCarpet)),
        ("P80", of(Material::Sandpaper(Grit::P80))),
        ("P600", of(Material::Sandpaper(Grit::P600))),
        (
            "flat, 1e9 N/m",
            Surface {
                stiffness_n_m: 1e9,
                ..of(Material::Flat)
            },
        ),
    ]
}

/// The whisker of all runs: the middle one of BIOTACT.
struct Subject {
    shaft: Shaft,
    modes: Modes,
}

impl Subject {
    fn new() -> Result<Self> {
        let shaft = Shaft::biotact(Biotact::Middle);
        let modes = shaft.modes(8)?;
        Ok(Self { shaft, modes })
    }

    /// Straight and at rest.
    fn whisker(&self, finer: u32) -> Result<TouchingWhisker> {
        let sensor = SensorSettings::default();
        let whisker = TouchingWhisker::with_modes(&self.shaft, &self.modes, &sensor, 1);
        Ok(whisker?.finer(finer))
    }

    fn plate(&self, surface: Surface) -> Plate {
        Plate::in_the_way(TOUCH_RAD, self.shaft.length_m, &Facing::USUAL, surface)
    }
}

fn pose(overlap_deg: f64) -> Pose {
    Pose::swung(TOUCH_RAD + overlap_deg.to_radians())
}

/// Rotations of the base at [`SAMPLES_HZ`], rad, and what the run took.
struct Run {
    rotations: Vec<[f64; 2]>,
    /// Share of ticks cut into parts, and parts of such a tick.
    share: f64,
    parts: f64,
}

fn whisk(subject: &Subject, surface: Surface, (hz, finer): (u32, u32)) -> Result<Run> {
    let mut whisker = subject.whisker(finer)?;
    let plate = subject.plate(surface);
    let ticks = SECONDS * hz;
    let every = hz / SAMPLES_HZ;
    let dt_s = 1.0 / f64::from(hz);
    let (mut cut, mut parts) = (0_u32, 0_u64);
    let mut rotations = Vec::new();
    for n in 0..=ticks {
        let phase = TAU * WHISK[0] * f64::from(n) * dt_s;
        let overlap = WHISK[2] - WHISK[1] * libm::cos(phase);
        whisker.step(&pose(overlap), Some(&plate), dt_s);
        cut += u32::from(whisker.parts() > 0);
        parts += u64::from(whisker.parts());
        if n > 0 && n.is_multiple_of(every) {
            rotations.push(whisker.rotation_rad());
        }
    }
    Ok(Run {
        rotations,
        share: f64::from(cut) / f64::from(ticks),
        parts: parts as f64 / f64::from(cut.max(1)),
    })
}

#[derive(Debug, Clone, Copy)]
pub(in crate::accuracy) struct Measured {
    /// Root mean square and largest error of the rotation, in spreads of the
    /// reference's.
    pub(super) rms: f64,
    pub(super) largest: f64,
    /// Spread over the reference's: of the rotation, and of its change within
    /// 2 ms, which is what textures make.
    pub(super) spread: f64,
    pub(super) change: f64,
    /// Share of ticks before the plate that are cut into parts, and how many.
    pub(in crate::accuracy) share: f64,
    pub(super) parts: f64,
}

impl Measured {
    fn new(run: &Run, truth: &Run) -> Self {
        let (ours, theirs) = (&run.rotations, &truth.rotations);
        let (mut squares, mut largest) = (0.0, 0.0);
        for (a, b) in ours.iter().zip(theirs) {
            let square = (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
            squares += square;
            largest = f64::max(largest, square.sqrt());
        }
        let whole = spread(theirs);
        Self {
            rms: (squares / theirs.len() as f64).sqrt() / whole,
            largest: largest / whole,
            spread: spread(ours) / whole,
            change: spread(&changes(ours)) / spread(&changes(theirs)),
            share: run.share,
            parts: run.parts,
        }
    }
}

/// Root mean square distance from the mean, both axes together.
fn spread(list: &[[f64; 2]]) -> f64 {
    let count = list.len() as f64;
    let mean = [0, 1].map(|i| list.iter().map(|at| at[i]).sum::<f64>() / count);
    let squares = list
        .iter()
        .map(|at| (at[0] - mean[0]).powi(2) + (at[1] - mean[1]).powi(2));
    (squares.sum::<f64>() / count).sqrt()
}

fn changes(list: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let pairs = list.iter().zip(list.iter().skip(1));
    pairs.map(|(a, b)| [b[0] - a[0], b[1] - a[1]]).collect()
}

#[derive(Debug, Clone)]
pub(in crate::accuracy) struct Against {
    pub(in crate::accuracy) name: &'static str,
    /// At each of [`TICKS_HZ`].
    pub(in crate::accuracy) ticks: [Measured; TICKS_HZ.len()],
    pub(super) half: Measured,
}

pub(in crate::accuracy) fn measure() -> Result<Vec<Against>> {
    let subject = Subject::new()?;
    let against = |(name, surface): Named| {
        let truth = whisk(&subject, surface, REFERENCE)?;
        let of = |hz, finer| -> Result<Measured> {
            let run = whisk(&subject, surface, (hz, finer))?;
            Ok(Measured::new(&run, &truth))
        };
        let half = of(HALF.0, HALF.1)?;
        let mut ticks = [half; TICKS_HZ.len()];
        for (cell, hz) in ticks.iter_mut().zip(TICKS_HZ) {
            *cell = of(hz, 0)?;
        }
        Ok(Against { name, ticks, half })
    };
    surfaces().into_iter().map(against).collect()
}
