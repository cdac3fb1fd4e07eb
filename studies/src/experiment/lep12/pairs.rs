//! Two floors at a time by the sequential probability ratio test, with a prior ratio (LEP12 eqs.
//! 1 and 2).

use anyhow::Result;
use rayon::prelude::*;
use tactile::{SequentialRule, Threshold};

use super::groups::{BLOCK, BOTH, Group};
use crate::classifiers::recogniser::{Bayes, Outcome, Recogniser, Sprt};
use crate::experiment::floors::{CHANNELS, Stream, train};
use crate::page::{Page, bold, figure};
use crate::paper::lep10::FLOORS;

/// Threshold on the probability: the middle one of Fig. 8.
const THETA: f64 = 0.9;
/// How much more often one floor comes than the other (chosen).
const PRIOR_RATIO: f64 = 4.0;
/// Share of decisions that must be alike, percent (chosen: one of a thousand may fall otherwise
/// by rounding).
const ALIKE: f64 = 99.9;

/// What a rule makes of all streams of a floor, stream by stream.
fn each(rule: &mut impl Recogniser, streams: &[Stream], floor: usize) -> Vec<Vec<Outcome>> {
    let of = streams.iter().filter(|stream| stream.floor == floor);
    of.map(|of| rule.outcomes(&of.samples, CHANNELS)).collect()
}

/// Errors, percent, and mean samples; no number of errors where nothing is decided.
fn decisions(found: &[Vec<Outcome>], class: usize) -> [f64; 2] {
    let count = found.iter().flatten().count() as f64;
    let wrong = found.iter().flatten().filter(|one| one.class != class);
    let samples = found.iter().flatten().map(|one| f64::from(one.samples));
    let error = 100.0 * wrong.count() as f64 / count;
    [error, samples.sum::<f64>() / count.max(1.0)]
}

struct Pair {
    floors: [usize; 2],
    /// Percent of the decisions that eq. 8 makes at the same sample too.
    alike: f64,
    /// Errors, percent, and mean samples, without the prior ratio and with it, of streams in
    /// which one floor is so much more frequent, the mean of either.
    error: [f64; 2],
    time: [f64; 2],
}

fn alike(ours: &[Vec<Outcome>], theirs: &[Vec<Outcome>]) -> (f64, f64) {
    let (mut same, mut all) = (0, 0);
    for (ours, theirs) in ours.iter().zip(theirs) {
        all += ours.len().max(theirs.len());
        same += ours.iter().zip(theirs).filter(|(a, b)| a == b).count();
    }
    (same as f64, all as f64)
}

impl Pair {
    fn of(group: &Group, floors: [usize; 2]) -> Result<Self> {
        let is_one = |stream: &&Stream| floors.contains(&stream.floor);
        let training: Vec<Stream> = group.training.iter().filter(is_one).cloned().collect();
        let model = train(&training, &BOTH, BLOCK)?;
        let model = model.view();
        let threshold = Threshold::new(THETA)?;
        let mut eq8 = Bayes::<SequentialRule>::new(model, threshold)?;
        let mut flat = Sprt::new(model, THETA, 1.0)?;
        let (mut same, mut all) = (0.0, 0.0);
        let mut plain = [[0.0; 2]; 2];
        for (class, floor) in floors.into_iter().enumerate() {
            let ours = each(&mut flat, &group.validation, floor);
            let theirs = each(&mut eq8, &group.validation, floor);
            let (some, of) = alike(&ours, &theirs);
            (same, all) = (same + some, all + of);
            plain[class] = decisions(&ours, class);
        }
        let share = PRIOR_RATIO / (1.0 + PRIOR_RATIO);
        let (mut error, mut time) = ([0.0; 2], [0.0; 2]);
        for likely in [0, 1] {
            let ratio = [PRIOR_RATIO, 1.0 / PRIOR_RATIO][likely];
            let mut knowing = Sprt::new(model, THETA, ratio)?;
            for (class, floor) in floors.into_iter().enumerate() {
                let weight = 0.5 * if class == likely { share } else { 1.0 - share };
                let known = decisions(&each(&mut knowing, &group.validation, floor), class);
                for (place, [wrong, samples]) in [plain[class], known].into_iter().enumerate() {
                    error[place] += weight * wrong;
                    time[place] += weight * samples;
                }
            }
        }
        Ok(Self {
            floors,
            alike: 100.0 * same / f64::max(all, 1.0),
            error,
            time,
        })
    }
}

pub(super) fn section(page: &mut Page, group: &Group, rate_hz: f64) -> Result<()> {
    let mut pairs = Vec::new();
    for a in 0..FLOORS.len() {
        pairs.extend((a + 1..FLOORS.len()).map(|b| [a, b]));
    }
    let pairs = pairs.into_par_iter().map(|floors| Pair::of(group, floors));
    let pairs = pairs.collect::<Result<Vec<_>, _>>()?;
    page.say(format_args!(
        "**Equations 1 and 2**: two floors at a time, {} motion, by the sequential probability \
         ratio test, log PR = log HR + Σ log LR, at θ = {THETA}. One floor comes {PRIOR_RATIO} \
         times as often as the other; the test takes both for equally frequent (HR = 1), or knows \
         better. Means of either floor being the frequent one.",
        group.name
    ));
    let ms = |samples: f64| figure(1000.0 * samples / rate_hz, 0);
    let line = |pair: &Pair| {
        let name = pair.floors.map(|floor| FLOORS[floor]).join(" or ");
        let shares = [pair.alike, pair.error[0], pair.error[1]].map(|share| figure(share, 1));
        bold(name, shares.into_iter().chain(pair.time.map(ms)))
    };
    page.table(
        "floors | decided as by eq. 8, % | errors with HR = 1, % | with HR known, % | time with \
         HR = 1, ms | with HR known, ms",
        pairs.iter().map(line),
    );
    let mean =
        |of: &dyn Fn(&Pair) -> f64| pairs.iter().map(of).sum::<f64>() / pairs.len().max(1) as f64;
    let (flat, known) = (mean(&|pair| pair.error[0]), mean(&|pair| pair.error[1]));
    let same = mean(&|pair| pair.alike);
    page.claim(
        "LEP12, below eq. 8: for two choices, eq. 8 is the sequential probability ratio test",
        "formally equivalent",
        format_args!("{} % of all decisions alike", figure(same, 2)),
        (same - ALIKE, "points over 99.9"),
    );
    page.claim(
        "LEP12 eq. 1: a prior ratio that is known saves errors",
        "trades off sensory information and prior probability",
        format_args!("{} against {} %", figure(known, 1), figure(flat, 1)),
        (flat - known, "points"),
    )
    .rests_on(100.0 - flat, 50.0);
    Ok(())
}
