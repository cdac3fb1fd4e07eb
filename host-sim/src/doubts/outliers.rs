//! Values that stand apart from all others, such as of a reading that failed: one of them would
//! make the scale of a model, in which all others are alike.

use super::Doubt;
use crate::recording::Stream;

/// Of how many values one may stand apart at each end.
const OF: usize = 200;
/// Fewer samples say nothing of what is usual.
const LEAST: usize = 20;
/// How often the span of all others it is away from them.
const FAR: f64 = 10.0;

/// Between which values all but a few of a channel lie; what is farther away than `FAR` times the
/// span between them stands apart.
#[derive(Debug, Clone, Copy)]
struct Usual {
    low: f64,
    high: f64,
}

impl Usual {
    /// Of a channel; of too few samples, and of one that hardly ever changes, all are usual.
    fn of(recordings: &[(String, Vec<Stream>)], channel: usize) -> Self {
        let all = Self {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        };
        let streams = recordings.iter().flat_map(|(_, streams)| streams);
        let samples = streams.flat_map(|stream| &stream.samples);
        let mut values: Vec<f64> = samples.map(|sample| sample[channel]).collect();
        if values.len() < LEAST {
            return all;
        }
        let left_out = (values.len() / OF).max(1);
        let last = values.len() - 1 - left_out;
        let (_, low, _) = values.select_nth_unstable_by(left_out, f64::total_cmp);
        let low = *low;
        let (_, high, _) = values.select_nth_unstable_by(last, f64::total_cmp);
        let high = *high;
        if high > low { Self { low, high } } else { all }
    }

    fn has_apart(&self, value: f64) -> bool {
        // Halves: a span may be beyond the largest number.
        let away = (self.low / 2.0 - value / 2.0).max(value / 2.0 - self.high / 2.0);
        away > FAR * (self.high / 2.0 - self.low / 2.0)
    }
}

/// The same recordings, in which what stands apart is the nearest value that does not; none where
/// nothing does.
pub fn tamed(recordings: &[(String, Vec<Stream>)]) -> Option<Vec<(String, Vec<Stream>)>> {
    let usual = [0, 1].map(|channel| Usual::of(recordings, channel));
    let streams = recordings.iter().flat_map(|(_, streams)| streams);
    let samples = || streams.clone().flat_map(|stream| &stream.samples);
    let apart =
        |channel: usize| move |sample: &&[f64; 2]| usual[channel].has_apart(sample[channel]);
    if !(0..2).any(|channel| samples().any(|sample| apart(channel)(&sample))) {
        return None;
    }
    let ends = [0, 1].map(|channel| {
        let kept = samples().filter(|sample| !apart(channel)(sample));
        let kept = kept.map(|sample| sample[channel]);
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        kept.fold(none, |(low, high), x| (low.min(x), high.max(x)))
    });
    let mut tamed = recordings.to_vec();
    let streams = tamed.iter_mut().flat_map(|(_, streams)| streams);
    for sample in streams.flat_map(|stream| &mut stream.samples) {
        for (value, (low, high)) in sample.iter_mut().zip(ends) {
            *value = value.clamp(low, high);
        }
    }
    Some(tamed)
}

/// Of each channel of each recording the first value that stands apart, and how many do.
pub(super) fn doubts(recordings: &[(String, Vec<Stream>)], channels: [&str; 2]) -> Vec<Doubt> {
    let usual = [0, 1].map(|channel| Usual::of(recordings, channel));
    let mut found = Vec::new();
    for (recording, (_, streams)) in recordings.iter().enumerate() {
        for (channel, name) in channels.iter().enumerate() {
            let usual = usual[channel];
            let samples = streams.iter().flat_map(|stream| &stream.samples);
            let values = samples.map(|sample| sample[channel]).enumerate();
            let mut apart = values.filter(|(_, value)| usual.has_apart(*value));
            let Some((sample, value)) = apart.next() else {
                continue;
            };
            let Usual { low, high } = usual;
            let more = match apart.count() {
                0 => String::new(),
                more => format!(", as {more} more are"),
            };
            let said = format!(
                "{name} is {value}{more}, far from all others, which are about {low} to {high}: a \
                 reading that failed? It does not make the scale"
            );
            found.push(Doubt {
                recording,
                sample,
                said,
            });
        }
    }
    found
}
