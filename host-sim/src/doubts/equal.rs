//! Trials that have samples in common: cut from one stretch so that they overlap, or the same
//! recording under two names. What is held out of training is then not new.

use std::collections::{BTreeMap, HashMap};

use super::Doubt;
use crate::recording::{GATE, Stream};

const STRETCH: usize = 16;
/// Steps between them in which they must change: what rests is equal by chance.
const CHANGES: usize = STRETCH / 2;
/// The share of a trial that must be found in another one.
const SHARE: f64 = 0.1;

/// A stream: of which recording it is, and at which of its samples it begins, both from 0.
type Placed<'s> = (usize, usize, &'s Stream);

type Bits = [u64; 2];

/// Every stretch of a stream that counts and changes, with the place of its first sample.
fn stretches<'b>(stream: &Stream, bits: &'b [Bits]) -> Vec<(usize, &'b [Bits])> {
    let counts: Vec<bool> = stream.counts(GATE).collect();
    let changes = |n: &usize| *n > 0 && stream.samples[*n] != stream.samples[n - 1];
    let all = bits.windows(STRETCH).enumerate();
    let kept = all.filter(|(at, _)| {
        let within = *at..at + STRETCH;
        let changed = within.clone().filter(changes).count();
        changed >= CHANGES && counts[within].iter().all(|counts| *counts)
    });
    kept.collect()
}

/// Two streams, and by how many samples what they have in common is later in the second.
type Shifted = (usize, usize, isize);

/// Streams of which a stretch of one is in the other: each two once.
fn alike(streams: &[Placed<'_>]) -> Vec<Shifted> {
    let bits = streams.iter().map(|(.., stream)| {
        let samples = stream.samples.iter();
        samples.map(|sample| sample.map(f64::to_bits)).collect()
    });
    let bits: Vec<Vec<Bits>> = bits.collect();
    let all = streams.iter().zip(&bits);
    let all: Vec<_> = all.map(|((.., of), bits)| stretches(of, bits)).collect();
    let mut marks: HashMap<&[Bits], (usize, usize)> = HashMap::new();
    for (of, stretches) in all.iter().enumerate() {
        let apart = stretches.iter();
        for (at, stretch) in apart.filter(|(at, _)| at.is_multiple_of(STRETCH)) {
            marks.entry(stretch).or_insert((of, *at));
        }
    }
    let mut pairs = BTreeMap::new();
    for (other, stretches) in all.iter().enumerate() {
        for (place, stretch) in stretches {
            if let Some((of, at)) = marks.get(stretch).filter(|(of, _)| *of != other) {
                let later = place.cast_signed() - at.cast_signed();
                pairs.entry((*of, other)).or_insert(later);
            }
        }
    }
    let pairs = pairs.into_iter();
    pairs
        .map(|((of, other), later)| (of, other, later))
        .collect()
}

/// Samples that are equal in two streams of which the second has them later.
fn in_common(one: &Stream, other: &Stream, later: isize) -> usize {
    let [skip_one, skip_other] = [-later, later].map(|skip| usize::try_from(skip).unwrap_or(0));
    let pairs = one.samples.iter().skip(skip_one);
    let pairs = pairs.zip(other.samples.iter().skip(skip_other));
    pairs.filter(|(a, b)| a == b).count()
}

/// Of each stream the one that has most of it too, and the share.
fn partners(streams: &[Placed<'_>]) -> Vec<Option<(usize, f64)>> {
    let mut best: Vec<Option<(usize, f64)>> = vec![None; streams.len()];
    for (one, other, later) in alike(streams) {
        let common = in_common(streams[one].2, streams[other].2, later) as f64;
        for (of, partner) in [(one, other), (other, one)] {
            let share = common / streams[of].2.samples.len() as f64;
            if share >= SHARE && best[of].is_none_or(|(_, most)| share > most) {
                best[of] = Some((partner, share));
            }
        }
    }
    best
}

/// Of each two recordings, and within each, the first trial that has samples in common with
/// another, and how many do.
pub(super) fn doubts(recordings: &[(String, Vec<Stream>)]) -> Vec<Doubt> {
    let mut streams: Vec<Placed<'_>> = Vec::new();
    for (recording, (_, own)) in recordings.iter().enumerate() {
        let mut sample = 0;
        for stream in own {
            streams.push((recording, sample, stream));
            sample += stream.samples.len();
        }
    }
    // By the two recordings: the first, and how many.
    let mut groups: BTreeMap<(usize, usize), (usize, usize, f64, usize)> = BTreeMap::new();
    for (one, partner) in partners(&streams).into_iter().enumerate() {
        let Some((other, share)) = partner else {
            continue;
        };
        let (a, b) = (streams[one].0, streams[other].0);
        let key = (a.min(b), a.max(b));
        let group = groups.entry(key).or_insert((one, other, share, 0));
        group.3 += 1;
    }
    let groups = groups.into_values();
    let doubts = groups.map(|(one, other, share, count)| {
        let (recording, sample, stream) = streams[one];
        let (other_recording, _, partner) = streams[other];
        let of = if other_recording == recording {
            String::new()
        } else {
            format!(" in {}", recordings[other_recording].0)
        };
        let so = match count {
            1 => String::new(),
            count => format!(" So it is with {count} trials."),
        };
        Doubt {
            recording,
            sample,
            said: format!(
                "{:.0} % of trial {:?} of {:?} is, sample for sample, in trial {:?} of {:?}{of} \
                     too.{so} What is held out is then not new, and figures are too good; trials \
                     must not overlap",
                100.0 * share,
                stream.trial,
                stream.label,
                partner.trial,
                partner.label
            ),
        }
    });
    doubts.collect()
}
