//! The opinion's part of a model file, read in place.
//!
//! | words | content |
//! |---|---|
//! | 1 | kind u8 (bit 0: names, otherwise it objects; bit 1: touches longer than nine blocks begin again; bit 2: poses are estimated; bit 3: paths allow for another sensor; bit 4: there are no weights of stages before the first that decides; bit 5: deflections are weighed; bit 6: of parts of a long touch means count), poses of paths P u8 (1 to 12), stages u8 (1 to 8), patience u8 (1 to 9) |
//! | 1 | most odds against the leader by the opinion, 2⁻²⁶ |
//! | 1, 1 | code that becomes zero i32; bits that are left off a code |
//! | 2 | rest of x and y where no air was felt yet, i32, 1/256 narrow codes |
//! | 2 | frequency of the whisk, 1/1000 Hz, 0: not known; 1 without RCP, 2 with, 0: not known |
//! | per stage, all or from the first that decides | shift; K × bias i32, 1/1024 bit; K × weights i16, ten a state begun, with deflections twelve |
//! | only with poses: 2 | least and most tilt, then depth, i16, 1/100 |
//! | per class and stage from the first that decides | errors of tilt and depth u16, 1/100; shifts u16; for each bias i32, 1/100, and [weights](super::pose) i32 |
//! | only with another sensor: 1 | most turn of one u16, 1/256 of 1/32 rad; most change of y's scale u16, 1/256 of 1/16 |
//! | only with means of parts: per class | the distances u32 within which half of the means of two parts lay, and of more; then both limits |
//! | per class | per state: 10 means i16, 1/256; shift; 55 of a triangle i16, and a zero; then 8 limits u32 |
//! | per class | 9 × inverse deviation of x and y u16, 2⁻¹⁶; P × 9 × x and y i16; limit u32 |

use super::path::Paths;
use super::{BLOCKS, FEATURES, PARTS, STAGES, STATES, WEIGHED, Whisked, pose};
use crate::error::ModelError;

/// Most poses between which a path may lie.
pub(crate) const MAX_POSES: usize = 12;
pub(crate) const HEAD_WORDS: usize = 8;
/// Bit 4 of the kind.
pub(crate) const LATE: u8 = 16;
/// Bit 5.
pub(crate) const DEFLECTIONS: u8 = 32;
/// Bit 6.
pub(crate) const MEANS: u8 = 64;
/// Of a class.
const MEAN_WORDS: usize = 2 * (PARTS - 1);
const TRIANGLE_WORDS: usize = (FEATURES * (FEATURES + 1) / 2).div_ceil(2);
pub(crate) const STATE_WORDS: usize = FEATURES / 2 + 1 + TRIANGLE_WORDS;
pub(crate) const TYPICAL_WORDS: usize = STATES.len() * STATE_WORDS + STAGES;

pub(crate) fn begun(blocks: usize) -> usize {
    STATES.iter().filter(|[first, _]| *first < blocks).count()
}

pub(crate) const fn path_words(poses: usize) -> usize {
    BLOCKS * (1 + poses) + 1
}

/// By how much the sensor may be turned, and its scale in y be another, in use; 1/256 of the units of
/// [`super::path`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Bounds {
    pub(crate) turn: i32,
    pub(crate) scale: i32,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Section<'m> {
    words: &'m [u32],
    classes: usize,
}

impl<'m> Section<'m> {
    /// Of words that were checked; of others it says something else, and no more.
    #[inline]
    pub(crate) const fn new(words: &'m [u32], classes: usize) -> Self {
        Self { words, classes }
    }

    /// Whether one of so many words that begins with `head` can be read.
    pub(crate) fn check(head: &[u32], words: usize, classes: usize) -> Result<(), ModelError> {
        let section = Section::new(head, classes);
        let fits = section.byte(0) <= 127
            && (1..=MAX_POSES).contains(&section.poses())
            && (1..=STAGES).contains(&section.stages())
            && (1..=BLOCKS).contains(&section.patience())
            && words == section.length();
        fits.then_some(()).ok_or(ModelError::Opinion)
    }

    /// Words that the counts in its head ask for.
    pub(crate) fn length(self) -> usize {
        let of_classes = self.classes * (TYPICAL_WORDS + path_words(self.poses()));
        self.before_stage(self.stages() + 1)
            + self.pose_words()
            + usize::from(self.has_bounds())
            + self.mean_words()
            + of_classes
    }

    /// Words before the weights of a stage (from 1).
    fn before_stage(self, stage: usize) -> usize {
        let before = (self.first_stage()..stage).map(|stage| self.stage_words(stage));
        HEAD_WORDS + before.sum::<usize>()
    }

    #[inline]
    pub(crate) fn weighed(self) -> usize {
        if self.byte(0) & DEFLECTIONS == 0 {
            FEATURES
        } else {
            WEIGHED
        }
    }

    /// Words of a stage (from 1).
    fn stage_words(self, stage: usize) -> usize {
        1 + self.classes + self.classes * begun(stage) * self.weighed() / 2
    }

    fn pose_words(self) -> usize {
        if !self.has_pose() {
            return 0;
        }
        let of_class: usize = self.pose_stages().map(pose::stage_words).sum();
        pose::LIMIT_WORDS + self.classes * of_class
    }

    fn has_bounds(self) -> bool {
        self.byte(0) & 8 != 0
    }

    /// By how much a sensor may be other than in training.
    pub(crate) fn bounds(self) -> Bounds {
        if !self.has_bounds() {
            return Bounds::default();
        }
        let word = self.word(self.before_stage(self.stages() + 1) + self.pose_words());
        Bounds {
            turn: i32::from(word as u16),
            scale: (word >> 16).cast_signed(),
        }
    }

    /// Whether of a long touch the means over its parts count; otherwise each part alone.
    #[inline]
    pub(crate) fn has_means(self) -> bool {
        self.byte(0) & MEANS != 0
    }

    fn mean_words(self) -> usize {
        usize::from(self.has_means()) * self.classes * MEAN_WORDS
    }

    /// The mean distances from a class within which half of what was trained lay, and nearly all,
    /// of two parts (0) or more (1).
    pub(crate) fn mean_distances(self, class: usize, of: usize) -> Option<[u32; 2]> {
        let behind = self.classes * (TYPICAL_WORDS + path_words(self.poses()));
        let behind = behind + self.classes.saturating_sub(class) * MEAN_WORDS;
        let words = self.words.get(self.words.len().wrapping_sub(behind)..)?;
        Some([*words.get(of)?, *words.get(PARTS - 1 + of)?])
    }

    #[inline]
    pub(crate) fn first_stage(self) -> usize {
        if self.byte(0) & LATE == 0 {
            return 1;
        }
        self.least().min(self.stages())
    }

    pub(crate) fn has_pose(self) -> bool {
        self.byte(0) & 4 != 0
    }

    /// The stages after which a pose is estimated: those in which a decision may fall.
    pub(crate) fn pose_stages(self) -> core::ops::RangeInclusive<usize> {
        self.least().min(self.stages())..=self.stages()
    }

    /// By what the pose of a class is estimated after so many blocks: the limits, the stage, and
    /// its words.
    pub(crate) fn pose(
        self,
        class: usize,
        blocks: usize,
    ) -> Option<([u32; pose::LIMIT_WORDS], usize, &'m [u32])> {
        let stages = self.pose_stages();
        let stage = blocks.min(*stages.end());
        if !self.has_pose() || !stages.contains(&stage) || class >= self.classes {
            return None;
        }
        let words = self.words.get(self.before_stage(self.stages() + 1)..)?;
        let (limits, words) = words.split_first_chunk()?;
        let of_class: usize = stages.clone().map(pose::stage_words).sum();
        let before: usize = (*stages.start()..stage).map(pose::stage_words).sum();
        let words = words.get(class * of_class + before..)?;
        Some((*limits, stage, words.get(..pose::stage_words(stage))?))
    }

    fn byte(self, at: usize) -> u8 {
        let word = self.words.first().copied().unwrap_or(0);
        word.to_le_bytes()[at % 4]
    }

    fn word(self, at: usize) -> u32 {
        self.words.get(at).copied().unwrap_or(0)
    }

    /// Whether the opinion names classes; otherwise it objects to names.
    #[inline]
    pub(crate) fn names(self) -> bool {
        self.byte(0) & 1 != 0
    }

    /// Whether a touch of more than nine blocks is felt again as another; otherwise nothing
    /// more is felt of it.
    #[inline]
    pub(crate) fn begins_again(self) -> bool {
        self.byte(0) & 2 != 0
    }

    /// Poses between which a path may lie.
    pub(crate) fn poses(self) -> usize {
        self.byte(1).into()
    }

    /// Blocks after which there are other weights.
    #[inline]
    pub(crate) fn stages(self) -> usize {
        self.byte(2).into()
    }

    /// Blocks after which what was not named is said.
    #[inline]
    pub(crate) fn patience(self) -> usize {
        self.byte(3).into()
    }

    /// Blocks of a touch before which nothing is decided: by then its way is known.
    #[inline]
    pub(crate) fn least(self) -> usize {
        (2 * self.patience()).div_ceil(3)
    }

    /// Most odds against a leader that it does not object to, 2⁻²⁶.
    pub(crate) fn most_odds(self) -> u32 {
        self.word(1)
    }

    #[inline]
    pub(crate) fn narrow(self) -> super::Narrow {
        super::Narrow {
            centre: self.word(2).cast_signed(),
            shift: self.word(3),
        }
    }

    /// Rest where no air was felt yet.
    pub(crate) fn rest(self) -> [i32; 2] {
        [self.word(4), self.word(5)].map(u32::cast_signed)
    }

    pub(crate) fn whisked(self) -> Whisked {
        let frequency = self.word(6);
        Whisked {
            frequency_mhz: (frequency != 0).then_some(frequency),
            has_rcp: match self.word(7) {
                1 => Some(false),
                2 => Some(true),
                _ => None,
            },
        }
    }

    /// Of a stage, from [the first](Self::first_stage) on: shift, biases and weights of all classes.
    pub(crate) fn stage(self, stage: usize) -> (u32, &'m [u32], &'m [u32]) {
        let words = self.words.get(self.before_stage(stage)..);
        let words = words.unwrap_or_default();
        let words = words.get(..self.stage_words(stage));
        let Some((shift, rest)) = words.and_then(<[u32]>::split_first) else {
            return (0, &[], &[]);
        };
        let (biases, weights) = rest.split_at_checked(self.classes).unwrap_or_default();
        (*shift, biases, weights)
    }

    /// What is typical of a class: its states, and its limits by stage.
    pub(crate) fn typical(self, class: usize) -> (&'m [u32], &'m [u32]) {
        let of_paths = self.classes * path_words(self.poses());
        let of_all = self.classes * TYPICAL_WORDS + of_paths;
        let first = self.words.len().wrapping_sub(of_all) + class * TYPICAL_WORDS;
        let words = self.words.get(first..).unwrap_or_default();
        let words = words.get(..TYPICAL_WORDS).unwrap_or_default();
        words
            .split_at_checked(TYPICAL_WORDS - STAGES)
            .unwrap_or_default()
    }

    pub(crate) fn path(self, class: usize) -> Paths<'m> {
        let one = path_words(self.poses());
        let of_others = self.classes.saturating_sub(class) * one;
        let words = self.words.get(self.words.len().wrapping_sub(of_others)..);
        let words = words.and_then(|words| words.get(..one)).unwrap_or_default();
        let Some((limit, words)) = words.split_last() else {
            return (&[], &[], 0);
        };
        let (inverse, means) = words.split_at_checked(BLOCKS).unwrap_or_default();
        (inverse, means, *limit)
    }
}

/// The two halves of words, the lower one first: models are little-endian, as all targets are.
#[inline]
pub(crate) fn halves(words: &[u32]) -> &[i16] {
    bytemuck::try_cast_slice(words).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    const CLASSES: usize = 3;

    /// Any words behind a head of seven stages, a patience of seven blocks and this kind.
    fn words(kind: u8) -> Vec<u32> {
        let head = u32::from_le_bytes([kind, 2, 7, 7]);
        let length = Section::new(&[head], CLASSES).length();
        core::iter::once(head).chain(1..length as u32).collect()
    }

    #[test]
    fn without_early_weights_all_else_is_where_it_was() {
        let whole = words(4 | 8 | MEANS);
        let early: usize = (1..5)
            .map(|stage| Section::new(&whole, CLASSES).stage_words(stage))
            .sum();
        let mut late = whole.clone();
        late.drain(HEAD_WORDS..HEAD_WORDS + early);
        late[0] |= u32::from(LATE);
        assert_eq!(Section::check(&late, late.len(), CLASSES), Ok(()));
        let [whole, late] = [&whole, &late].map(|words| Section::new(words, CLASSES));
        assert_eq!([whole.first_stage(), late.first_stage()], [1, 5]);
        assert_eq!(late.bounds(), whole.bounds());
        for stage in 5..=7 {
            assert_eq!(late.stage(stage), whole.stage(stage));
        }
        for class in 0..CLASSES {
            assert_eq!(late.pose(class, 6), whole.pose(class, 6));
            assert_eq!(late.typical(class), whole.typical(class));
            assert_eq!(late.path(class), whole.path(class));
            assert_eq!(
                late.mean_distances(class, 1),
                whole.mean_distances(class, 1)
            );
        }
    }
}
