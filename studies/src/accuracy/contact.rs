//! Contact of an elastic whisker with plates: error against run time.
//!
//! # Glossary
//!
//! - **rotation**: of the whisker's base, what its sensor measures, in x and y.
//! - **spread**: root mean square distance from the mean.
//! - **change**: of the rotation within 2 ms, what textures make of it.
//! - **part**: ticks before a plate are cut into 1, 2, 4 … 32 parts.

mod runs;

use anyhow::Result;

use crate::chart::{Axis, Mark, Panel, Series, draw};
use crate::page::{Page, row, short};
use runs::{Measured, TICKS_HZ};

pub(super) use runs::{Against, measure};

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
    table("Parts of a tick before the plate, in the mean:", |m| {
        m.parts
    });
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
    Panel {
        title: title.to_owned(),
        x: Axis::decades(names[0], points().map(|point| point.0)),
        y: Axis::decades(names[1], points().map(|point| point.1)),
        series,
    }
}

fn picture(measured: &[Against]) -> Result<String> {
    let error = curves(measured, |m, hz| {
        let steps = 1.0 - m.share + m.share * m.parts;
        (steps * f64::from(hz), m.rms)
    });
    let change = curves(measured, |m, hz| (f64::from(hz), (m.change - 1.0).abs()));
    draw(&[
        panel(
            "error of the rotation",
            ["parts and free ticks a second", "rms error, spreads"],
            error,
        ),
        panel(
            "error of the change's spread",
            ["tick rate, Hz", "|ratio - 1|"],
            change,
        ),
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
            let worst = against
                .ticks
                .iter()
                .map(|tick| tick.rms)
                .fold(0.0, f64::max);
            assert!(worst < 0.01 && fine.rms < coarse.rms, "{against:?}");
            assert!(against.half.rms < 0.1 * fine.rms, "{against:?}");
        }
        let flat = &measured[0];
        assert!(flat.ticks[3].rms < 0.2 * flat.ticks[0].rms, "{flat:?}");
    }
}
