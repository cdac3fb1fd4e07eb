//! A second opinion, by the trembling of a whole touch, and whether the touch is of the kind
//! that was trained.
//!
//! Blocks of a touch are cut in four *states* (onset, early, late, unloading). After each block
//! the sums of the [features](differences) over the states that have begun are weighed by a
//! linear discriminant of that *stage*, whose covariance knows by what pose changes them: what
//! differs between poses is a nuisance and is weighed down. A class is named only if
//!
//! 1. the way of the touch, mean deflections of x and y a block, lies near the way of that class
//!    in one of the poses of training, or between two that are neighbours ([path]), by a sensor
//!    that may be turned and scaled a little;
//! 2. the features are *typical* of the class: a sum over states of squared distances, each by
//!    the class's own covariance;
//! 3. the opinion agrees.
//!
//! Trained in one pose, it *objects* to names that the tables give. Trained in several, it
//! *names* by itself, once a touch at most, and there are no tables; mean deflections are then
//! weighed as features are. Either way nothing is decided
//! in the first blocks of a touch, in which all ways are alike ([`Section::least`]).
//!
//! A touch of more than nine blocks is cut in *parts* of nine. Each must pass by itself, and the
//! mean over the parts as well: of distances (2) and of scores (3), m ← m + (part − m) / w with a w
//! of 1, 2, 4, 4, … Mean scores count as they are, as what is not as in training moves all parts
//! alike; where the mean distance is within that of half of the touches of training they count √w
//! times. Nothing is decided in the first two parts.
//!
//! Of what is named the [pose] may be estimated too.
//!
//! What is refused has a [`Reason`](crate::Reason): 1 the pose, 2 unknown, 3 between two classes. So
//! many decisions in a row must name none until it is said: the next touch may yet name a class.

pub(crate) mod differences;
pub(crate) mod path;
pub(crate) mod pose;
pub(crate) mod section;
#[cfg(test)]
mod tests;
mod typical;

use crate::decision::{Decision, Reason};
use crate::evidence::{EvidenceScale, MAX_DEFICIT};
use crate::format::MAX_CLASSES;
use crate::rule::DecisionRule;
pub(crate) use differences::{Differences, Narrow};
pub use pose::{Estimate, Pose};
pub(crate) use section::Section;
use section::{STATE_WORDS, halves};

/// What is known of how it is whisked, in training or by a scene. In whole numbers, which a
/// core without an FPU compares by few instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Whisked {
    /// Frequency, 1/1000 Hz.
    pub frequency_mhz: Option<u32>,
    /// Whether with RCP.
    pub has_rcp: Option<bool>,
}

impl Whisked {
    /// Whether whisking differs from this where both are known: by more than 5 % of the
    /// frequency, or with RCP for without.
    pub fn differs(&self, other: &Self) -> bool {
        let frequency = match (self.frequency_mhz, other.frequency_mhz) {
            (Some(a), Some(b)) => a.abs_diff(b) > a / 20,
            _ => false,
        };
        let rcp = match (self.has_rcp, other.has_rcp) {
            (Some(a), Some(b)) => a != b,
            _ => false,
        };
        frequency || rcp
    }
}

pub(crate) const FEATURES: usize = 10;
/// What is weighed of a state: the features, and the mean deflection of x and y from rest where it
/// [names](Section::names).
pub(crate) const WEIGHED: usize = FEATURES + 2;
/// Bits that are left off a deflection: sums of three, each below 2¹⁴, then fit 16 bits.
pub(crate) const DEFLECTION_SHIFT: u32 = 2;
/// Blocks of a touch that are distinguished; a longer one begins again.
pub(crate) const BLOCKS: usize = 9;
/// Blocks after which there are weights.
pub(crate) const STAGES: usize = 8;
/// First and last block, from 0 and excluded, of each state.
pub(crate) const STATES: [[usize; 2]; 4] = [[0, 1], [1, 3], [3, 6], [6, BLOCKS]];

/// `block` is from 0.
pub(crate) fn state_of(block: usize) -> usize {
    let past = STATES.iter().filter(|[_, end]| *end <= block).count();
    past.min(STATES.len() - 1)
}

/// Blocks of a state after so many of the touch.
pub(crate) fn blocks_of(state: [usize; 2], blocks: usize) -> usize {
    let [first, end] = state;
    blocks.min(end).saturating_sub(first)
}

/// Parts of a long touch that are counted.
pub(crate) const PARTS: usize = 3;
/// A part counts as so many times its limit at most, so that a knock is not felt for long.
pub(crate) const OUTLIER: u32 = 4;
/// Of the fraction of what a mean of scores weighs.
const WEIGHT_BITS: u32 = 5;
/// What the mean of two parts weighs, and of more: √2 and √4.
const WEIGHTS: [u32; PARTS - 1] = [45, 64];

/// How near the parts of a long touch are to a class in the mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Nearness {
    /// There are no means.
    Unknown,
    /// As half of what was trained, and what the mean of scores then weighs.
    Near(u32),
    Between,
    /// As next to nothing of it.
    Far,
}

/// The most that a deviation counts, in deviations of training.
const DEVIATION_MOST: i32 = 128;
/// Bits of the fraction of a deviation along a path.
pub(crate) const PATH_BITS: u32 = 5;
/// Of one of a state.
pub(crate) const STATE_BITS: u32 = 4;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Opinion {
    pub(crate) differences: Differences,
    /// Sums of the features, and of deflections, of each state: of three blocks at most, each
    /// below 2¹³.
    states: [[i16; WEIGHED]; STATES.len()],
    path: [[i16; 2]; BLOCKS],
    blocks: usize,
    /// Of each class, 1/1024 bit.
    scores: [i32; MAX_CLASSES],
    /// How far the states that have ended are from each class, where it is known.
    ended: [typical::Ended; MAX_CLASSES],
    /// Of the parts of a long touch that have ended: how many, to [`PARTS`].
    parts: usize,
    /// And of each class their mean score and distance from what is typical of it.
    means: [[i32; 2]; MAX_CLASSES],
}

impl Opinion {
    const fn new() -> Self {
        Self {
            differences: Differences::new([0; 2]),
            states: [[0; WEIGHED]; STATES.len()],
            path: [[0; 2]; BLOCKS],
            blocks: 0,
            scores: [0; MAX_CLASSES],
            ended: [[0; STATES.len()]; MAX_CLASSES],
            parts: 0,
            means: [[0; 2]; MAX_CLASSES],
        }
    }

    // As fast as this crate is built, which a board's program for size is not.
    #[inline(never)]
    pub(crate) fn push(
        &mut self,
        (section, classes): (Section<'_>, usize),
        codes: &[i32],
        counts: bool,
    ) {
        let narrow = section.narrow();
        if let [x, y, ..] = *codes {
            self.differences.push([narrow.of(x), narrow.of(y)], counts);
        }
        // By a class after each of the first samples.
        let class = self.differences.counted().wrapping_sub(1) as usize;
        if counts && class < classes {
            self.look_back(section, class);
        }
    }

    /// A touch begins: the open block is dropped, and what was felt.
    pub(crate) fn begin(&mut self) {
        self.differences.clear();
        self.parts = 0;
        self.clear();
    }

    /// A touch is long: of what was felt the scores and distances are kept in their means.
    #[inline(never)]
    pub(crate) fn begin_again(&mut self, section: Section<'_>, classes: usize) {
        if section.has_means() {
            // The first part is all of the mean, whatever it was.
            let shift = self.parts.min(PARTS - 1) as u32;
            for class in 0..classes.min(MAX_CLASSES) {
                let (distance, most) = self.distance(class, section);
                let distance = distance.min(most.saturating_mul(OUTLIER)).cast_signed();
                let score = self.scores.get(class).copied().unwrap_or(0);
                if let Some([mean, mean_distance]) = self.means.get_mut(class) {
                    *mean += (score - *mean) >> shift;
                    *mean_distance += (distance - *mean_distance) >> shift;
                }
            }
            self.parts = (self.parts + 1).min(PARTS);
        }
        self.clear();
    }

    fn clear(&mut self) {
        self.states = [[0; WEIGHED]; STATES.len()];
        self.blocks = 0;
        self.scores = [0; MAX_CLASSES];
        self.ended = [[0; STATES.len()]; MAX_CLASSES];
    }

    pub(crate) const fn blocks(&self) -> usize {
        self.blocks
    }

    pub(crate) const fn is_full(&self) -> bool {
        self.blocks >= BLOCKS
    }

    /// Ends a block; where touches last, it counts if no differences are missing. By how much the
    /// score of each class has risen, 1/1024 bit.
    // Once a block, and not within what is generic: as fast as this crate is built.
    #[inline(never)]
    pub(crate) fn end_of_block(&mut self, section: Section<'_>, classes: usize) -> Rise {
        let is_whole = self.differences.is_whole();
        let (features, deflection) = self.differences.end_of_block();
        let is_missed = section.begins_again() && !is_whole;
        if self.blocks >= BLOCKS || is_missed {
            return [0; MAX_CLASSES];
        }
        if let Some(state) = self.states.get_mut(state_of(self.blocks)) {
            let deflection = deflection.map(|code| code >> DEFLECTION_SHIFT);
            for (sum, value) in state.iter_mut().zip(features.iter().chain(&deflection)) {
                *sum = sum.wrapping_add(*value);
            }
        }
        if let Some(place) = self.path.get_mut(self.blocks) {
            *place = deflection;
        }
        self.blocks = (self.blocks + 1).min(BLOCKS);
        let mut rise = [0; MAX_CLASSES];
        if !(section.first_stage()..=section.stages()).contains(&self.blocks) {
            return rise;
        }
        let (shift, biases, weights) = section.stage(self.blocks);
        let begun = section::begun(self.blocks);
        // At least one state: said where the compiler sees that no chunk is empty.
        let weighed = section.weighed();
        let mut weights = halves(weights).chunks((begun * weighed).max(1));
        let classes = self.scores.iter_mut().zip(&mut rise).take(classes);
        for ((score, rise), bias) in classes.zip(biases) {
            let weights = weights.next().unwrap_or_default().chunks(weighed.max(1));
            let products = weights.zip(&self.states).flat_map(|(weights, sums)| {
                let products = weights.iter().zip(sums);
                products.map(|(weight, sum)| i64::from(i32::from(*sum) * i32::from(*weight)))
            });
            let sum: i64 = products.sum();
            let bits = (sum >> shift.min(63)) + i64::from(bias.cast_signed());
            let bits = bits.clamp(-SCORE_MOST, SCORE_MOST) as i32;
            *rise = bits.wrapping_sub(*score);
            *score = bits;
        }
        rise
    }

    /// What the next block adds to the scores is to be all that the touch says.
    pub(crate) fn forget_scores(&mut self) {
        self.scores = [0; MAX_CLASSES];
    }

    /// Whether too little of a touch is known to decide.
    pub(crate) fn is_early(&self, section: Section<'_>) -> bool {
        self.blocks < section.least() || (section.has_means() && self.parts < 2)
    }

    // At a decision, likewise.
    #[inline(never)]
    pub(crate) fn objection(
        &self,
        section: Section<'_>,
        classes: usize,
        class: usize,
    ) -> Option<Reason> {
        let path = self.path.get(..self.blocks).unwrap_or_default();
        let rest = section.rest().map(|rest| rest >> 8);
        if !path::is_near(path, section.path(class), rest, section.bounds()) {
            return Some(Reason::Pose);
        }
        let (distance, most) = self.distance(class, section);
        let nearness = self.nearness(class, section);
        if distance > most || nearness == Nearness::Far {
            return Some(Reason::Unknown);
        }
        if section.names() {
            return None;
        }
        self.rival((section.most_odds(), nearness), classes, class)
            .map(Reason::Between)
    }

    /// None where the model does not say.
    pub(crate) fn pose(&self, section: Section<'_>, class: usize) -> Option<Pose> {
        let (limits, stage, words) = section.pose(class, self.blocks)?;
        pose::estimate(self.path.get(..stage)?, words, limits)
    }

    /// The class that stands against this one, by the scores, if the odds against it are too many.
    fn rival(
        &self,
        (most_odds, nearness): (u32, Nearness),
        classes: usize,
        class: usize,
    ) -> Option<usize> {
        // Near, each part errs for itself; elsewhere all of them may err alike.
        let weight = match nearness {
            Nearness::Near(weight) => weight,
            _ => 1 << WEIGHT_BITS,
        };
        let scores = self.scores.iter().zip(&self.means).take(classes);
        let scores = scores.map(|(score, [mean, _])| match nearness {
            Nearness::Unknown => *score,
            _ => *mean,
        });
        let own = scores.clone().nth(class)?;
        let (mut odds, mut rival, mut best) = (0_u32, class, i32::MIN);
        for (other, score) in scores.enumerate() {
            if other == class {
                continue;
            }
            if score > best {
                (best, rival) = (score, other);
            }
            let behind = own.saturating_sub(score).max(0).unsigned_abs();
            let behind = behind.saturating_mul(weight) >> WEIGHT_BITS;
            let scale = const { EvidenceScale::per_samples(1) };
            odds = odds.saturating_add(scale.term(behind.min(MAX_DEFICIT), 0));
        }
        (odds > most_odds).then_some(rival)
    }

    /// How near the parts are to a class in the mean.
    fn nearness(&self, class: usize, section: Section<'_>) -> Nearness {
        let of = self.parts.checked_sub(2);
        let limits = of.and_then(|of| section.mean_distances(class, of));
        let (Some(of), Some([near, most]), Some([_, mean])) = (of, limits, self.means.get(class))
        else {
            return Nearness::Unknown;
        };
        match mean.unsigned_abs() {
            mean if mean > most => Nearness::Far,
            mean if mean > near => Nearness::Between,
            _ => Nearness::Near(WEIGHTS.get(of).copied().unwrap_or(1 << WEIGHT_BITS)),
        }
    }

    /// How far the states are from a class, and the most that is typical.
    #[inline(never)]
    fn distance(&self, class: usize, section: Section<'_>) -> (u32, u32) {
        let (states, limits) = section.typical(class);
        let ended = self.ended.get(class).copied().unwrap_or_default();
        let words = states.chunks(STATE_WORDS);
        let of_states = words.zip(&self.states).zip(STATES).enumerate();
        let squares = of_states.map(|(n, ((words, sums), state))| match ended.get(n) {
            Some(inverted) if *inverted != 0 => !inverted,
            _ => typical::square(words, sums, blocks_of(state, self.blocks)),
        });
        let distance = squares.fold(0, u32::saturating_add);
        let stage = self.blocks.clamp(1, section.stages().max(1));
        (distance, limits.get(stage - 1).copied().unwrap_or(0))
    }

    /// Works out what a decision will ask of the state that has ended last, of the class of this
    /// number: with all of them at once a small core would not be done within a tick.
    #[inline(never)]
    fn look_back(&mut self, section: Section<'_>, class: usize) {
        let state = STATES.iter().position(|[_, end]| *end == self.blocks);
        let Some((n, state)) = state.and_then(|n| Some((n, STATES.get(n)?))) else {
            return;
        };
        let (words, _) = section.typical(class);
        let words = words.chunks(STATE_WORDS).nth(n).unwrap_or_default();
        let ended = self.ended.get_mut(class).and_then(|of| of.get_mut(n));
        if let (Some(ended), Some(sums)) = (ended, self.states.get(n)) {
            *ended = !typical::square(words, sums, blocks_of(*state, self.blocks));
        }
    }
}

/// An opinion, and what it has made of a touch where it names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Judge {
    pub(crate) opinion: Opinion,
    /// A decision that was refused; it is said when patience ends.
    held: Option<Decision>,
    /// Samples of those before it.
    spent: u32,
    is_done: bool,
    /// Decisions in a row that named none, and were not said.
    refused: u8,
}

/// The number of decisions in a row that name none of which the last is said, if it has this reason:
/// what is known is mostly named by the next.
const fn needed(reason: Reason) -> u8 {
    match reason {
        Reason::Pose => 1,
        Reason::Unknown => 2,
        Reason::Between(_) => 3,
    }
}

impl Judge {
    pub(crate) const fn new() -> Self {
        Self {
            opinion: Opinion::new(),
            held: None,
            spent: 0,
            is_done: false,
            refused: 0,
        }
    }

    /// The decision, if it is to be said.
    pub(crate) fn say(&mut self, decision: Decision) -> Option<Decision> {
        self.refused = self.refused.saturating_add(1);
        let reason = decision.reason();
        if reason.is_some_and(|reason| self.refused < needed(reason)) {
            return None;
        }
        self.refused = 0;
        Some(decision)
    }

    /// A touch begins; whether the one before was refused and that was not said.
    pub(crate) fn begin(&mut self) -> bool {
        self.opinion.begin();
        self.is_done = false;
        let is_refused = self.held.take().is_some();
        if is_refused {
            self.spent = 0;
        }
        is_refused
    }

    pub(crate) fn finish(&mut self) {
        self.is_done = true;
        self.held = None;
        self.spent = 0;
    }

    /// The end of a block whose sums are what the opinion's scores have risen by.
    ///
    /// A class is named once the touch has lasted for two thirds of the model's patience and its
    /// posterior exceeds the threshold, if nothing objects. What was refused is said, as is a pair
    /// of classes that exceeds the threshold together, once patience ends.
    pub(crate) fn name<R: DecisionRule>(
        &mut self,
        (section, classes): (Section<'_>, usize),
        rule: &R,
        sums: &mut [u32],
        evidence: &mut R::Evidence,
        touch: u16,
    ) -> Option<Decision> {
        if self.is_done {
            sums.fill(0);
            return None;
        }
        if self.opinion.blocks() < section.least() {
            rule.gather(sums, evidence);
            return None;
        }
        if let Some(decision) = rule.end_of_block(sums, evidence) {
            let decision = decision.after(self.spent);
            let reason = self.opinion.objection(section, classes, decision.leader());
            let decision = decision.in_touch(touch, reason);
            if reason.is_none() {
                self.finish();
                return self.say(decision);
            }
            self.spent = decision.samples();
            self.held = Some(decision);
            self.opinion.forget_scores();
        }
        if self.opinion.blocks() < section.patience() {
            return None;
        }
        let said = self.held.or_else(|| {
            let pair = rule.decide_between(classes, evidence)?;
            Some(pair.after(self.spent).in_touch(touch, pair.reason()))
        })?;
        self.finish();
        *evidence = rule.start();
        self.say(said)
    }
}

pub(crate) type Rise = [i32; MAX_CLASSES];

/// The largest size of a score: 1024 bits.
const SCORE_MOST: i64 = 1 << 20;
