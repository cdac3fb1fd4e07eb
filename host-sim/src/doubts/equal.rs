//! Trials that have samples in common: cut from one stretch so that they overlap, or the same
//! recording under two names. What is held out of training is then not new.

use std::collections::{BTreeMap, HashMap};

use super::Doubt;
use crate::recording::{GATE, Stream};

/// Samples that must be equal, one after the other.
const STRETCH: usize = 16;
/// Steps between them in which they must change: what rests is equal by chance.
const CHANGES: usize = STRETCH / 2;
/// The share of a trial that must be found in another one.
const SHARE: f64 = 0.1;
/// What a rolling sum is multiplied with.
const BASE: u64 = 0x9E37_79B9_7F4A_7C15;

/// A stream: of which recording it is, and at which of its samples it begins, both from 0.
type Placed<'s> = (usize, usize, &'s Stream);

fn sum(sample: [f64; 2]) -> u64 {
    let [x, y] = sample.map(f64::to_bits);
    (x.wrapping_mul(BASE) ^ y.rotate_left(31)).wrapping_mul(BASE)
}

/// The first sample and the sum of every stretch of a stream that counts and changes.
fn stretches(stream: &Stream) -> Vec<(usize, u64)> {
    let samples = &stream.samples;
    let oldest = (1..STRETCH).fold(1_u64, |power, _| power.wrapping_mul(BASE));
    let counts: Vec<bool> = stream.counts(GATE).collect();
    let changes = |n: usize| n > 0 && samples.get(n) != samples.get(n - 1);
    let (mut rolling, mut counted, mut changed) = (0_u64, 0, 0);
    let mut found = Vec::new();
    for (n, (sample, counts_now)) in samples.iter().zip(&counts).enumerate() {
        if let Some(before) = n.checked_sub(STRETCH) {
            rolling = rolling.wrapping_sub(sum(samples[before]).wrapping_mul(oldest));
            counted -= usize::from(counts[before]);
            changed -= usize::from(changes(before));
        }
        rolling = rolling.wrapping_mul(BASE).wrapping_add(sum(*sample));
        counted += usize::from(*counts_now);
        changed += usize::from(changes(n));
        if counted == STRETCH && changed >= CHANGES {
            found.push((n + 1 - STRETCH, rolling));
        }
    }
    found
}

fn stretch(stream: &Stream, at: usize) -> &[[f64; 2]] {
    stream.samples.get(at..at + STRETCH).unwrap_or_default()
}

/// Two streams, and by how many samples what they have in common is later in the second.
type Shifted = (usize, usize, isize);

/// Streams of which a stretch of one is in the other: each two once.
fn alike(streams: &[Placed<'_>]) -> Vec<Shifted> {
    let all = streams.iter().map(|(.., stream)| stretches(stream));
    let all: Vec<_> = all.collect();
    let mut marks: HashMap<u64, (usize, usize)> = HashMap::new();
    for (of, stretches) in all.iter().enumerate() {
        let apart = stretches
            .iter()
            .filter(|(at, _)| at.is_multiple_of(STRETCH));
        for (at, sum) in apart {
            marks.entry(*sum).or_insert((of, *at));
        }
    }
    let mut pairs = BTreeMap::new();
    for (other, stretches) in all.iter().enumerate() {
        for (place, sum) in stretches {
            let Some((of, at)) = marks.get(sum).filter(|(of, _)| *of != other) else {
                continue;
            };
            if stretch(streams[*of].2, *at) == stretch(streams[other].2, *place) {
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
