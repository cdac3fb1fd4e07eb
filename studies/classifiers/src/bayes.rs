//! Naive Bayes in the forms in which the papers compare it: by x, by y or by
//! both (LEP10, LEP12), by combined or separate classes (BIOTACT).
//!
//! # Glossary
//!
//! - **axis**: one direction of deflection; a whisker has channels x and y.
//! - **combined**: one class for each pair of a texture and a distance.
//! - **separate**: a model of textures, whatever the distance, and one of
//!   distances, whatever the texture.
//!
//! The rules are [`tactile::Sequential`], [`crate::Window`] and
//! [`crate::Stationary`] for all of these: what differs is the training data,
//! which [`train`] arranges. For the stream see [`crate::recogniser`]: a
//! [`crate::recogniser::Picked`] with the same channels.

use std::vec::Vec;

use tactile::ModelBuf;
use tactile::train::{Options, TrainError, Trainer};

/// Which of a whisker's channels are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// Along the whisk.
    X,
    /// Across it.
    Y,
    /// Both, independent given the class.
    Joint,
}

impl Axes {
    /// All three.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Joint];

    /// The channels of so many whiskers, whose samples are x and y of the
    /// first, x and y of the second, and so on.
    pub fn channels(self, whiskers: usize) -> Vec<usize> {
        (0..2 * whiskers)
            .filter(|channel| match self {
                Self::X => channel % 2 == 0,
                Self::Y => channel % 2 == 1,
                Self::Joint => true,
            })
            .collect()
    }
}

/// Pairs of a texture and a distance (or of any two properties) as classes:
/// texture · distances + distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pairs {
    /// How many textures.
    pub textures: usize,
    /// How many distances.
    pub distances: usize,
}

impl Pairs {
    /// How many pairs there are.
    pub fn classes(self) -> usize {
        self.textures.saturating_mul(self.distances)
    }

    /// The class of a pair; `None` if there is no such pair.
    pub fn class(self, texture: usize, distance: usize) -> Option<usize> {
        let there = texture < self.textures && distance < self.distances;
        there.then(|| texture * self.distances + distance)
    }

    /// The texture of a class.
    pub fn texture(self, class: usize) -> usize {
        class.checked_div(self.distances).unwrap_or(0)
    }

    /// The distance of a class.
    pub fn distance(self, class: usize) -> usize {
        class.checked_rem(self.distances).unwrap_or(0)
    }
}

/// Trains a model on some channels of segments. Its classes are numbered as
/// `names` are, whatever the order of the segments; give it
/// `pairs.texture(class)` for a class and it is a separate model of textures.
///
/// # Errors
///
/// As [`Trainer::add`] and [`Trainer::train`]; a class without a name or
/// without a segment; or a picked channel that there is not.
pub fn train<'s>(
    names: &[&str],
    channels: usize,
    picked: &[usize],
    segments: impl IntoIterator<Item = (usize, &'s [f64])>,
    options: Options,
) -> Result<ModelBuf, TrainError> {
    let mut trainer = Trainer::new(picked.len(), options)?;
    let mut by_class: Vec<Vec<&[f64]>> = names.iter().map(|_| Vec::new()).collect();
    for (class, segment) in segments {
        let there = by_class.get_mut(class);
        there.ok_or(TrainError::ClassUnnamed(class))?.push(segment);
    }
    let mut taken = Vec::with_capacity(picked.len());
    for (class, (name, segments)) in names.iter().zip(&by_class).enumerate() {
        for segment in segments {
            for sample in segment.chunks(channels.max(1)) {
                let found = sample.len();
                taken.clear();
                taken.extend(picked.iter().filter_map(|&c| sample.get(c)));
                if found != channels || taken.len() != picked.len() {
                    return Err(TrainError::Channels {
                        expected: channels,
                        found,
                    });
                }
                trainer.add(name, &taken)?;
            }
        }
        // Fewer names: this class had no sample, or another's name.
        if trainer.names().len() != class + 1 {
            return Err(TrainError::ClassEmpty(class));
        }
    }
    trainer.train()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recogniser::{Bayes, Picked, first_outcome};
    use std::vec;
    use tactile::score::Confusion;

    const OPTIONS: Options = Options {
        bins: 50,
        smooth: 2.0,
        block: 1,
    };
    const NAMES: [&str; 4] = ["00", "01", "10", "11"];
    const PAIRS: Pairs = Pairs {
        textures: 2,
        distances: 2,
    };

    /// x tells the texture, y the distance.
    fn segment(class: usize, seed: u32) -> Vec<f64> {
        let mut state = seed.wrapping_mul(2_654_435_761) | 1;
        let mut noise = || {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            f64::from(state) / 4_294_967_296.0
        };
        (0..60)
            .flat_map(|_| {
                let x = 0.5 * PAIRS.texture(class) as f64 + noise();
                let y = 0.5 * PAIRS.distance(class) as f64 + noise();
                [x, y]
            })
            .collect()
    }

    fn hits(axes: Axes) -> Confusion {
        let picked = axes.channels(1);
        // In an order in which the classes do not first appear by number.
        let training: Vec<_> = (0..40)
            .map(|n| (3 - n % 4, segment(3 - n % 4, 7 + n as u32)))
            .collect();
        let segments = training.iter().map(|(class, s)| (*class, s.as_slice()));
        let buf = train(&NAMES, 2, &picked, segments, OPTIONS).unwrap();
        assert!(buf.names().eq(NAMES));
        let mut recogniser = Picked::new(Bayes::stationary(buf.view()).unwrap(), &picked);
        let mut confusion = Confusion::new(4);
        for n in 0..80 {
            let taken = segment(n % 4, 1000 + n as u32);
            let outcome = first_outcome(&mut recogniser, &taken, 2);
            confusion.add(n % 4, outcome.map(|o| o.class)).unwrap();
        }
        confusion
    }

    #[test]
    fn one_axis_tells_half_and_both_tell_all() {
        let texture = |class| PAIRS.texture(class);
        let distance = |class| PAIRS.distance(class);
        let rates = |confusion: &Confusion| {
            let rate = |of: &dyn Fn(usize) -> usize| confusion.grouped(2, of).hit_rate().unwrap();
            (rate(&texture), rate(&distance))
        };
        let (x, y, joint) = (hits(Axes::X), hits(Axes::Y), hits(Axes::Joint));
        let (by_x, by_y) = (rates(&x), rates(&y));
        assert!(by_x.0 == 1.0 && (0.2..0.8).contains(&by_x.1), "{by_x:?}");
        assert!(by_y.1 == 1.0 && (0.2..0.8).contains(&by_y.0), "{by_y:?}");
        assert_eq!(joint.hit_rate(), Some(1.0));
    }

    #[test]
    fn a_separate_model_pools_the_other_property() {
        let training: Vec<_> = (0..40).map(|n| (n % 4, segment(n % 4, n as u32))).collect();
        let textures = training
            .iter()
            .map(|(class, s)| (PAIRS.texture(*class), s.as_slice()));
        let buf = train(&["a", "b"], 2, &[0, 1], textures, OPTIONS).unwrap();
        let mut by_hand = Trainer::new(2, OPTIONS).unwrap();
        for (class, s) in &training {
            let name = ["a", "b"][PAIRS.texture(*class)];
            s.chunks(2).for_each(|s| by_hand.add(name, s).unwrap());
        }
        assert_eq!(buf.as_bytes(), by_hand.train().unwrap().as_bytes());
    }

    #[test]
    fn pairs_are_numbered_by_texture() {
        let pairs = Pairs {
            textures: 2,
            distances: 3,
        };
        assert_eq!((pairs.class(1, 2), pairs.classes()), (Some(5), 6));
        assert_eq!((pairs.texture(5), pairs.distance(5)), (1, 2));
        assert_eq!((pairs.class(2, 0), pairs.class(0, 3)), (None, None));
        let none = Pairs {
            textures: 0,
            distances: 0,
        };
        assert_eq!((none.texture(1), none.distance(1)), (0, 0));
        assert_eq!(Axes::Y.channels(2), [1, 3]);
        assert_eq!(Axes::X.channels(2), [0, 2]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let (a, b) = (vec![0.0, 1.0], vec![5.0, 900.0]);
        let train = |names: &[&str], picked: &[usize], classes: [usize; 2], channels| {
            let segments = classes.into_iter().zip([a.as_slice(), b.as_slice()]);
            train(names, channels, picked, segments, OPTIONS).err()
        };
        assert_eq!(train(&["a", "b"], &[0], [0, 1], 2), None);
        let unnamed = Some(TrainError::ClassUnnamed(2));
        assert_eq!(train(&["a", "b"], &[0], [0, 2], 2), unnamed);
        let empty = |class| Some(TrainError::ClassEmpty(class));
        assert_eq!(train(&["a", "b"], &[0], [1, 1], 2), empty(0));
        assert_eq!(train(&["a", "a"], &[0], [0, 1], 2), empty(1));
        let missing = TrainError::Channels {
            expected: 2,
            found: 2,
        };
        assert_eq!(train(&["a", "b"], &[2], [0, 1], 2), Some(missing));
        let ragged = TrainError::Channels {
            expected: 3,
            found: 2,
        };
        assert_eq!(train(&["a", "b"], &[0], [0, 1], 3), Some(ragged));
        assert!(train(&["a", "b"], &[], [0, 1], 2).is_some());
    }
}
