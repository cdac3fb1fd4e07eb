//! A recording with what the yardstick makes of it, and others held against it.

use scene::Rule;

use super::data::Recording;
use super::listeners::{Listener, Yardstick};
use super::measure::{COLUMNS, Decisions, Errors, OnOne, Same, columns};
use host_sim::Error;

/// In the open loop evidence starts again where the yardstick exceeds this.
pub(super) const RESTART: f64 = 0.999;
/// Classes below this posterior are not compared by its logarithm.
pub(super) const LEAST_POSTERIOR: f64 = 1e-6;

/// A decision that fell, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fallen {
    pub(super) stream: usize,
    pub(super) block: usize,
    pub(super) class: usize,
    pub(super) samples: u32,
}

/// The yardstick after a block of the open loop.
struct Step {
    stream: usize,
    block: usize,
    posteriors: Vec<f64>,
    leader: usize,
    /// Evidence starts again after it.
    last: bool,
}

/// A recording and the yardstick's account of it.
pub(super) struct Ground<'r> {
    recording: &'r Recording,
    steps: Vec<Step>,
    /// The decisions under each rule of each column.
    fallen: [Vec<Vec<Fallen>>; COLUMNS],
}

impl<'r> Ground<'r> {
    pub(super) fn new(recording: &'r Recording) -> Self {
        let fallen = columns().map(|rules| {
            let decided = rules.into_iter().map(|rule| {
                let mut yardstick = Yardstick::new(recording, Some(rule));
                closed_loop(recording, &mut yardstick)
            });
            decided.collect()
        });
        Self {
            recording,
            steps: open_loop(recording),
            fallen,
        }
    }

    /// Adds the errors of somebody in the open loop.
    pub(super) fn errors(&self, listener: &mut impl Listener, errors: &mut Errors) {
        for step in &self.steps {
            let fell = listener.hear(step.stream, step.block);
            // The product beyond 1 − 1e-12 would have forgotten what it should
            // tell. It does not come to that: a test counts the errors.
            if fell.is_none() {
                let found = listener.posteriors();
                for (class, (&exact, found)) in step.posteriors.iter().zip(found).enumerate() {
                    errors.posterior.add((found - exact).abs());
                    let error = (found / exact).ln().abs();
                    if exact > LEAST_POSTERIOR {
                        errors.all.add(error);
                    }
                    if class == step.leader {
                        errors.leader.add(error);
                    }
                }
            }
            if step.last {
                listener.forget();
            }
        }
    }

    /// The decisions of somebody under every rule.
    ///
    /// # Errors
    /// Those of `make`.
    pub(super) fn decisions<L: Listener>(
        &self,
        make: impl Fn(Rule) -> Result<L, Error>,
    ) -> Result<OnOne, Error> {
        let mut all = [Decisions {
            restarted: Same::default(),
            running: Same::default(),
            hit_rate: f64::NAN,
        }; COLUMNS];
        let columns = columns().into_iter().zip(&self.fallen);
        for ((rules, exact), decisions) in columns.zip(&mut all) {
            let mut found = Vec::new();
            for (rule, exact) in rules.into_iter().zip(exact) {
                let mut listener = make(rule)?;
                let fallen = closed_loop(self.recording, &mut listener);
                decisions.running = decisions.running.and(shared(exact, &fallen));
                let restarted = restarted(self.recording, exact, &mut listener);
                decisions.restarted = decisions.restarted.and(restarted);
                found.extend(fallen);
            }
            decisions.hit_rate = hit_rate(self.recording, &found);
        }
        Ok(all)
    }

    /// Hit rates of the yardstick.
    pub(super) fn hit_rates(&self) -> [f64; COLUMNS] {
        let fallen = self.fallen.each_ref();
        fallen.map(|rules| hit_rate(self.recording, &rules.concat()))
    }
}

/// The yardstick, block by block, starting again where it is sure.
fn open_loop(recording: &Recording) -> Vec<Step> {
    let mut yardstick = Yardstick::new(recording, None);
    let mut steps = Vec::new();
    for stream in 0..recording.streams.len() {
        let blocks = recording.blocks(stream);
        for block in 0..blocks {
            yardstick.hear(stream, block);
            let posteriors = yardstick.posteriors();
            let (leader, most) = largest(&posteriors);
            let last = most > RESTART || block + 1 == blocks;
            if last {
                yardstick.forget();
            }
            steps.push(Step {
                stream,
                block,
                posteriors,
                leader,
                last,
            });
        }
    }
    steps
}

/// The first of the largest.
fn largest(posteriors: &[f64]) -> (usize, f64) {
    let all = posteriors.iter().copied().enumerate();
    all.fold(
        (0, f64::MIN),
        |best, at| if at.1 > best.1 { at } else { best },
    )
}

/// Every stream from its beginning; decisions in order.
pub(super) fn closed_loop(recording: &Recording, listener: &mut impl Listener) -> Vec<Fallen> {
    let mut all = Vec::new();
    for stream in 0..recording.streams.len() {
        listener.forget();
        for block in 0..recording.blocks(stream) {
            let fell = listener.hear(stream, block);
            all.extend(fell.map(|(class, samples)| Fallen {
                stream,
                block,
                class,
                samples,
            }));
        }
    }
    all
}

/// How many of two accounts of a recording, each in order, are in both.
pub(super) fn shared(exact: &[Fallen], found: &[Fallen]) -> Same {
    let place = |fallen: &Fallen| (fallen.stream, fallen.block);
    let (mut same, mut both) = (0, 0);
    for fallen in found {
        if let Ok(at) = exact.binary_search_by_key(&place(fallen), place) {
            both += 1;
            same += usize::from(exact.get(at) == Some(fallen));
        }
    }
    Same {
        same,
        of: exact.len() + found.len() - both,
    }
}

/// The first decision of somebody who starts again after each of `exact`.
pub(super) fn restarted(
    recording: &Recording,
    exact: &[Fallen],
    listener: &mut impl Listener,
) -> Same {
    let mut expected = exact.iter().peekable();
    let mut count = Same::default();
    for stream in 0..recording.streams.len() {
        listener.forget();
        let mut first = None;
        for block in 0..recording.blocks(stream) {
            let fell = listener.hear(stream, block);
            first = first.or(fell.map(|(class, samples)| Fallen {
                stream,
                block,
                class,
                samples,
            }));
            let here = |exact: &&Fallen| exact.stream == stream && exact.block == block;
            if let Some(exact) = expected.next_if(here) {
                count.of += 1;
                count.same += usize::from(first.take() == Some(*exact));
                listener.forget();
            }
        }
        // A decision that the yardstick does not take before the stream ends.
        count.of += usize::from(first.is_some());
    }
    count
}

/// Share of right decisions, mean over the classes that there were.
fn hit_rate(recording: &Recording, fallen: &[Fallen]) -> f64 {
    let mut tallies = vec![(0_u32, 0_u32); recording.classes];
    for fallen in fallen {
        let heard = recording.streams.get(fallen.stream);
        if let Some(truth) = heard.map(|heard| heard.class)
            && let Some((right, all)) = tallies.get_mut(truth)
        {
            *right += u32::from(fallen.class == truth);
            *all += 1;
        }
    }
    let presented = tallies.iter().filter(|(_, all)| *all > 0);
    let rates = presented.map(|&(right, all)| f64::from(right) / f64::from(all));
    let rates: Vec<f64> = rates.collect();
    rates.iter().sum::<f64>() / rates.len() as f64
}
