//! What a rule without probabilities hands back: the class and the samples it
//! took.

use core::num::NonZeroU32;

/// A class chosen. Two words, and no more in an `Option`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    // Never zero.
    samples: NonZeroU32,
    class: u32,
}

impl Choice {
    /// The class, from zero, in the order of training.
    pub fn class(&self) -> usize {
        self.class as usize
    }

    /// How many samples it took.
    pub fn samples(&self) -> u32 {
        self.samples.get()
    }

    /// The first of the least of some errors, after so many samples; `None`
    /// without a sample or an error. What is not a number is never the least.
    #[inline]
    pub(crate) fn least<T: PartialOrd + Copy>(errors: &[T], samples: u32) -> Option<Self> {
        let samples = NonZeroU32::new(samples)?;
        let mut errors = (0_u32..).zip(errors.iter().copied());
        let (mut class, mut least) = errors.next()?;
        for (other, error) in errors {
            // The first may itself be no number: then any that is one is less.
            let replaces = error < least || (least.partial_cmp(&least).is_none());
            if replaces {
                (class, least) = (other, error);
            }
        }
        Some(Self { samples, class })
    }
}

#[cfg(feature = "train")]
impl From<Choice> for crate::recogniser::Outcome {
    fn from(choice: Choice) -> Self {
        Self {
            class: choice.class(),
            samples: choice.samples(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Choice;

    #[test]
    fn the_first_of_the_least() {
        let class = |errors: &[f32]| Choice::least(errors, 5).map(|c| c.class());
        assert_eq!(class(&[3.0, 1.0, 2.0, 1.0]), Some(1));
        assert_eq!(class(&[f32::NAN, 9.0, f32::NAN]), Some(1));
        assert_eq!(class(&[7.0, f32::NAN]), Some(0));
        assert_eq!(class(&[]), None);
        assert_eq!(Choice::least(&[1_u64], 0), None);
        assert_eq!(Choice::least(&[1_u64], 9).unwrap().samples(), 9);
    }
}
