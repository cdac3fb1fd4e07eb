//! What is odd about recordings, though they can be read: values that stand apart, trials in
//! pieces, trials that are there twice.

pub mod equal;
pub mod outliers;

use std::collections::HashSet;

use tactile::ModelBuf;

use crate::evaluation;
use crate::recording::Stream;

/// Share of samples that may lie outside of a model's range; of the training itself it is
/// below 1 %.
const OUTSIDE: f64 = 0.05;

/// Something odd.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Doubt {
    /// In which recording, from 0.
    pub recording: usize,
    /// At which of its samples, from 0 over all its streams.
    pub sample: usize,
    /// What it is.
    pub said: String,
}

/// What is odd about recordings, each with its name, whose channels are called so.
pub fn doubts(recordings: &[(String, Vec<Stream>)], channels: [&str; 2]) -> Vec<Doubt> {
    let mut found = outliers::doubts(recordings, channels);
    for (recording, (_, streams)) in recordings.iter().enumerate() {
        found.extend(in_pieces(streams).map(|(sample, said)| Doubt {
            recording,
            sample,
            said,
        }));
    }
    found.extend(equal::doubts(recordings));
    found
}

/// The first sample outside of a model's range, counted from 0 over all streams, and what it is; none
/// where few are.
pub fn outside(
    model: &ModelBuf,
    streams: &[Stream],
    channels: [&str; 2],
) -> Option<(usize, String)> {
    let (outside, first) = evaluation::outside(model, streams);
    let (sample, [channel, of_model]) = first.filter(|_| outside > OUTSIDE)?;
    let mut samples = streams.iter().flat_map(|stream| &stream.samples);
    let value = samples.nth(sample).and_then(|values| values.get(channel));
    let (low, high) = model.quantiser(of_model).map_or((0.0, 0.0), |quantiser| {
        let unit = f64::from(-quantiser.exponent).exp2();
        let value = |code: i32| quantiser.origin + f64::from(code) * unit;
        (value(quantiser.low), value(quantiser.high))
    });
    let said = format!(
        "{} is {}; the model was trained on {low} to {high}. {:.0} % of samples lie outside of \
         the range that the model was trained on: other units, another sensor, or another motion?",
        channels.get(channel).unwrap_or(&""),
        value.unwrap_or(&f64::NAN),
        100.0 * outside
    );
    Some((sample, said))
}

/// Where a trial begins again after rows of another, and how often that is so.
fn in_pieces(streams: &[Stream]) -> Option<(usize, String)> {
    let (mut trials, mut first, mut sample) = (HashSet::new(), None, 0);
    for stream in streams {
        let is_new = trials.insert((&stream.label, &stream.trial, &stream.pose));
        if !is_new {
            first.get_or_insert((sample, stream));
        }
        sample += stream.samples.len();
    }
    let (sample, Stream { label, trial, .. }) = first?;
    let said = format!(
        "trial {trial:?} of {label:?} begins again after rows of another: {} trials are in {} \
         pieces. The rows of a trial must follow each other in time order; a piece counts as a \
         trial",
        trials.len(),
        streams.len()
    );
    Some((sample, said))
}

/// What makes trials too short to learn from.
pub fn short(recordings: &[(String, Vec<Stream>)]) -> String {
    let streams = || recordings.iter().flat_map(|(_, streams)| streams);
    let rows: usize = streams().map(|stream| stream.samples.len()).sum();
    let count = streams().count();
    format!(
        "a trial is what rows of one label, trial and pose are that follow each other: found {count}, of \
         {:.1} rows in the mean",
        rows as f64 / count.max(1) as f64
    )
}
