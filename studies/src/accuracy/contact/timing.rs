//! What a tick of an elastic whisker takes on this PC: free and in contact.

use core::f64::consts::TAU;
use std::hint::black_box;

use super::runs::{Against, Subject, TICKS_HZ, pose, surfaces};
use super::{curves, panel};
use crate::accuracy::chart::draw;
use crate::accuracy::host::{Batch, CALLS, medians};
use crate::accuracy::page::{Page, short};
use host_sim::Error;
use physics::Plate;

/// A batch has this many times fewer calls than the others of the page: they
/// take longer.
const FEWER: i32 = 20;

/// Ticks at `hz` before a plate, always in contact, or before none.
fn batch(subject: &Subject, plate: Option<Plate>, hz: u32) -> Result<Batch, Error> {
    let mut whisker = subject.whisker(0)?;
    let dt_s = 1.0 / f64::from(hz);
    let poses: Vec<_> = (0..CALLS / FEWER)
        .map(|n| pose(5.0 - 2.0 * libm::cos(TAU * 2.0 * f64::from(n) * dt_s)))
        .collect();
    Ok(Box::new(move || {
        whisker.rest();
        for pose in &poses {
            whisker.step(black_box(pose), plate.as_ref(), dt_s);
        }
        black_box(whisker.rotation_rad());
    }))
}

/// Appends what ticks take, as ratios to `unit`, ns.
pub(in crate::accuracy) fn section(
    page: &mut Page,
    measured: &[Against],
    unit: f64,
) -> Result<(), Error> {
    let subject = Subject::new()?;
    let mut batches = vec![batch(&subject, None, 2_000)?];
    for (_, surface) in surfaces() {
        for hz in TICKS_HZ {
            batches.push(batch(&subject, Some(subject.plate(surface)), hz)?);
        }
    }
    let times: Vec<f64> = medians(&mut batches)
        .into_iter()
        .map(|ns| f64::from(FEWER) * ns / unit)
        .collect();
    let (free, touching) = times.split_first().unwrap_or((&f64::NAN, &[]));
    let of = |surface: usize, tick: usize| {
        let at = surface * TICKS_HZ.len() + tick;
        touching.get(at).copied().unwrap_or(f64::NAN)
    };

    page.heading(2, "An elastic whisker");
    page.say(format_args!(
        "A tick of a whisker of four modes in both axes, as a ratio to the same Euler f64 tick. \
         Before no plate it takes {}; always in contact, sliding to and fro (ticks are cut \
         into more parts the longer they are):",
        short(*free)
    ));
    let row = |(n, against): (usize, &Against)| {
        let cells = (0..TICKS_HZ.len()).map(|tick| short(of(n, tick)));
        std::iter::once(against.name.to_owned())
            .chain(cells)
            .collect()
    };
    page.table(
        "surface | 500 Hz | 1 kHz | 2 kHz | 4 kHz | 8 kHz",
        measured.iter().enumerate().map(row),
    );
    page.say(
        "Error of the rotation (see [contact](accuracy.md#contact)) against the time of a \
         second of whisking, free and in contact as it comes, in thousands of those Euler ticks:",
    );
    let series = curves(measured, |n, _, m, hz| {
        let tick = TICKS_HZ.iter().position(|own| *own == hz).unwrap_or(0);
        let each = (1.0 - m.share) * free + m.share * of(n, tick);
        (1e-3 * each * f64::from(hz), m.rms)
    });
    let names = ["thousand Euler ticks a second", "rms error, spreads"];
    let svg = draw(&[panel("contact: error against run time", names, series)])?;
    page.picture("host-contact.svg", "error of contact against run time", svg);
    Ok(())
}
