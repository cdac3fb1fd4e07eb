//! Contact of an elastic whisker with plates: error against run time.
//! What is compared is the rotation of the whisker's base in x and y, which its sensor measures. Ticks
//! before a plate are cut into 1, 2, 4 … 32 parts.

use anyhow::Result;
use core::f64::consts::TAU;

use physics::{
    Biotact, Facing, Grit, Material, Modes, Plate, Pose, SensorSettings, Shaft, Surface,
    TouchingWhisker,
};

use crate::chart::{Axis, Mark, Panel, Series, draw};
use crate::page::{Page, row, short};

const TICKS_HZ: [u32; 5] = [500, 1_000, 2_000, 4_000, 8_000];
/// Steps of the reference a second, and how much finer it cuts them; and at half the rate: what the
/// reference itself is worth.
const REFERENCE: (u32, u32) = (128_000, 2);
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
    let slippery = Surface {
        friction: 0.0,
        hold: 0.0,
        ..of(Material::Flat)
    };
    let hard = Surface {
        stiffness_n_m: 1e9,
        ..of(Material::Flat)
    };
    [
        ("flat", of(Material::Flat)),
        ("flat, no friction", slippery),
        ("vinyl", of(Material::Vinyl)),
        ("tarmac", of(Material::Tarmac)),
        ("rough carpet", of(Material::RoughCarpet)),
        ("P80", of(Material::Sandpaper(Grit::P80))),
        ("P600", of(Material::Sandpaper(Grit::P600))),
        ("flat, 1e9 N/m", hard),
    ]
}

/// Rotations of the base at [`SAMPLES_HZ`], rad, and what the run took.
struct Run {
    rotations: Vec<[f64; 2]>,
    /// Share of ticks cut into parts, and parts of such a tick.
    share: f64,
    parts: f64,
}

/// A whisk of the middle whisker of BIOTACT, which is straight and at rest before.
fn whisk(
    (shaft, modes): &(Shaft, Modes),
    surface: Surface,
    (hz, finer): (u32, u32),
) -> Result<Run> {
    let sensor = SensorSettings::default();
    let mut whisker = TouchingWhisker::with_modes(shaft, modes, &sensor, 1)?.finer(finer);
    let plate = Plate::in_the_way(TOUCH_RAD, shaft.length_m, &Facing::USUAL, surface);
    let ticks = SECONDS * hz;
    let every = hz / SAMPLES_HZ;
    let dt_s = 1.0 / f64::from(hz);
    let (mut cut, mut parts) = (0_u32, 0_u64);
    let mut rotations = Vec::new();
    for n in 0..=ticks {
        let phase = TAU * WHISK[0] * f64::from(n) * dt_s;
        let overlap = WHISK[2] - WHISK[1] * libm::cos(phase);
        let pose = Pose::swung(TOUCH_RAD + overlap.to_radians());
        whisker.step(&pose, Some(&plate), dt_s);
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
struct Measured {
    /// Root mean square and largest error of the rotation, in spreads of the reference's.
    rms: f64,
    largest: f64,
    /// Spread over the reference's: of the rotation, and of its change within
    /// 2 ms, which is what textures make.
    spread: f64,
    change: f64,
    /// Share of ticks before the plate that are cut into parts, and how many.
    share: f64,
    parts: f64,
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
    let square = |at: &[f64; 2]| (at[0] - mean[0]).powi(2) + (at[1] - mean[1]).powi(2);
    (list.iter().map(square).sum::<f64>() / count).sqrt()
}

fn changes(list: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let pairs = list.iter().zip(list.iter().skip(1));
    pairs.map(|(a, b)| [b[0] - a[0], b[1] - a[1]]).collect()
}

#[derive(Debug, Clone)]
pub(super) struct Against {
    name: &'static str,
    /// At each of [`TICKS_HZ`].
    ticks: [Measured; TICKS_HZ.len()],
    half: Measured,
}

pub(super) fn measure() -> Result<Vec<Against>> {
    let shaft = Shaft::biotact(Biotact::Middle);
    let modes = shaft.modes(8)?;
    let subject = (shaft, modes);
    let against = |(name, surface): Named| {
        let truth = whisk(&subject, surface, REFERENCE)?;
        let of = |steps| -> Result<Measured> {
            Ok(Measured::new(&whisk(&subject, surface, steps)?, &truth))
        };
        let half = of(HALF)?;
        let mut ticks = [half; TICKS_HZ.len()];
        for (cell, hz) in ticks.iter_mut().zip(TICKS_HZ) {
            *cell = of((hz, 0))?;
        }
        Ok(Against { name, ticks, half })
    };
    surfaces().into_iter().map(against).collect()
}

pub(super) fn section(page: &mut Page, measured: &[Against]) -> Result<()> {
    page.heading(2, "Contact");
    page.say(
        "The middle whisker of BIOTACT (112 mm, 50 Hz) whisks at 2 Hz, by 10 degrees to both \
         sides of 3 degrees before first touch, against a plate that the shaft meets at 30 \
         degrees; for 2 s from rest. Rotations of its base are compared every 2 ms with those \
         of 128,000 ticks a second that are cut four times finer than usual. Errors are in \
         spreads of the reference's rotation. A coarse tick also knows the base's way at its \
         ticks only, and moves it uniformly in between: that is part of the error.",
    );
    let header = "surface | 500 Hz | 1 kHz | 2 kHz | 4 kHz | 8 kHz | reference at half its rate";
    let mut table = |what: &str, value: fn(&Measured) -> f64| {
        page.say(what);
        let line = |against: &Against| {
            let all = against.ticks.iter().chain([&against.half]);
            let cells = all.map(|measured| short(value(measured)));
            row(against.name, cells)
        };
        page.table(header, measured.iter().map(line));
    };
    table("Root mean square error:", |m| m.rms);
    table("Largest error:", |m| m.largest);
    table("Spread of the rotation over the reference's:", |m| m.spread);
    table("Spread of its change within 2 ms, likewise:", |m| m.change);
    let parts = "Parts of a tick before the plate, in the mean:";
    table(parts, |m| m.parts);
    page.say(
        "The error falls with the tick wherever the tip slides, first with what a tick knows of \
         the base's way, then with the length of a part. Where a tip jams before a steep grain and jumps (P80), or \
         sticks and slips on steep stones (tarmac), a small error decides when it lets go: the \
         error at a time then takes far shorter parts to fall, and the spreads are what to go by.",
    );
    page.picture(
        "contact.svg",
        "error of the rotation against parts a second, and its vibration against the tick",
        picture(measured)?,
    );
    Ok(())
}

fn curves(measured: &[Against], point: impl Fn(&Measured, u32) -> (f64, f64)) -> Vec<Series> {
    let curve = |(n, against): (usize, &Against)| {
        let points = against.ticks.iter().zip(TICKS_HZ);
        let points = points.map(|(m, hz)| point(m, hz)).collect();
        Series::new(against.name, n, Mark::Dot, points)
    };
    measured.iter().enumerate().map(curve).collect()
}

fn panel(title: &str, names: [&'static str; 2], series: Vec<Series>) -> Panel {
    let points = || series.iter().flat_map(|series| series.points.iter());
    let x = Axis::decades(names[0], points().map(|point| point.0));
    let y = Axis::decades(names[1], points().map(|point| point.1));
    Panel::new(title, x, y, series)
}

fn picture(measured: &[Against]) -> Result<String> {
    let error = curves(measured, |m, hz| {
        let steps = 1.0 - m.share + m.share * m.parts;
        (steps * f64::from(hz), m.rms)
    });
    let change = curves(measured, |m, hz| (f64::from(hz), (m.change - 1.0).abs()));
    let of_error = ["parts and free ticks a second", "rms error, spreads"];
    let of_change = ["tick rate, Hz", "|ratio - 1|"];
    draw(&[
        panel("error of the rotation", of_error, error),
        panel("error of the change's spread", of_change, change),
    ])
}

#[cfg(test)]
mod tests {
    use super::measure;

    #[test]
    fn shorter_ticks_are_closer_to_the_reference() {
        let measured = measure().unwrap();
        for against in &measured {
            let [coarse, .., fine] = &against.ticks;
            assert!((0.2..0.8).contains(&fine.share), "{against:?}");
            assert!((fine.spread - 1.0).abs() < 0.05, "{against:?}");
            // P80 decides by small differences when it lets go.
            if against.name == "P80" {
                assert!(fine.rms < 0.2, "{against:?}");
                continue;
            }
            // A coarse tick is cut in parts that are as long as a fine one's.
            let are_close = against.ticks.iter().all(|tick| tick.rms < 0.01);
            assert!(are_close && fine.rms < coarse.rms, "{against:?}");
            assert!(against.half.rms < 0.1 * fine.rms, "{against:?}");
        }
        let flat = &measured[0];
        assert!(flat.ticks[3].rms < 0.2 * flat.ticks[0].rms, "{flat:?}");
    }
}
