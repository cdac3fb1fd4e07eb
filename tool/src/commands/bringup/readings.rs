//! What the sensor's readings are: how often there is a new one, and how much they scatter.

use serde::Serialize;
use wire::Flags;

use super::bench::Bench;
use super::report::{Done, Ended, Part, not_done};
use crate::calibrate::Zero;
use crate::sample::Sample;

/// Of a hundred ticks so many have a new reading, at least.
const NEW: f64 = 0.9;
/// Readings at rest scatter by less, codes, root mean square: `check` asks for a look from about
/// there, which is twice what the simulated sensor does.
const NOISY_CODES: f64 = 9.0;

const INVALID: &str = "not done: no reading counts; the step frames comes first, and whisker log names \
                       the fault";

/// Readings that count, of so many ticks.
fn watched(bench: &mut Bench, side: u8) -> Result<Vec<Sample>, Ended> {
    bench.stream()?;
    let frames = f64::from(bench.frames);
    let mut whisker = bench.whisker(side)?;
    let seconds = frames * whisker.tick_s();
    let samples = whisker.watch(seconds, |_| true)?;
    let counts = samples
        .into_iter()
        .filter(|sample| sample.is_valid() && sample.flags.contains(Flags::FRESH));
    let counts: Vec<Sample> = counts.collect();
    if counts.len() < 2 {
        return not_done(INVALID);
    }
    Ok(counts)
}

#[derive(Serialize)]
struct Rate {
    readings: usize,
    /// Share of those that are not the one before.
    new: f64,
    update_hz: f64,
}

pub(super) fn rate(bench: &mut Bench, side: u8) -> Done {
    bench.ask("move the whisker to and fro, by hand, until the next step")?;
    let samples = watched(bench, side)?;
    let pairs = samples.windows(2);
    let new = pairs.filter(|pair| pair[0].words != pair[1].words).count();
    let new = new as f64 / (samples.len() - 1) as f64;
    let tick_hz = f64::from(bench.about.tick_hz);
    let rate = Rate {
        readings: samples.len(),
        new,
        update_hz: new * tick_hz,
    };
    let mut part = Part::new(format!("watched {} readings", samples.len())).with(&rate);
    part.saw(format!(
        "{:.1} % of them are new, {:.0} a second at {tick_hz} ticks a second",
        100.0 * new,
        rate.update_hz
    ));
    if new >= NEW {
        return Ok(part.means("the sensor has a new reading for each tick, or nearly so"));
    }
    part.find(format!(
        "if the whisker moved all the time, the sensor has {:.0} new readings a second: set tick_hz to \
         that or less, or another mode or filter in the sensor's EEPROM. What repeats says nothing new \
         to the classifier",
        rate.update_hz
    ));
    Ok(part.means("readings repeat: the sensor converts less often than the module reads it"))
}

pub(super) fn noise(bench: &mut Bench, side: u8) -> Done {
    bench.ask("let go of the whisker, and of the bench")?;
    let samples = watched(bench, side)?;
    let Some(Zero { channels, .. }) = Zero::of(&samples) else {
        return not_done(INVALID);
    };
    let noise = channels.map(|channel| channel.sd);
    let mut part = Part::new(format!("watched {} readings at rest", samples.len())).with(&noise);
    let [x, y] = noise;
    let [at_x, at_y] = channels.map(|channel| channel.mean);
    part.saw(format!(
        "x scatters by {x:.1} codes about {at_x:.0}, y by {y:.1} about {at_y:.0} (root mean square)"
    ));
    if noise.iter().all(|noise| *noise <= NOISY_CODES) {
        return Ok(part.means(format!("quiet: at most {NOISY_CODES} codes")));
    }
    part.find(format!(
        "more than {NOISY_CODES} codes: a field too weak (a gap too wide), a capacitor that lacks at the \
         sensor's supply, grounds joined at two points, or something that moves; whisker check tells \
         slow from fast"
    ));
    Ok(part.means("what is felt has to be larger than this noise"))
}
