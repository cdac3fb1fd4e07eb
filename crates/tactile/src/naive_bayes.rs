//! The classifier of one whisker: a model, a rule, and the evidence so far.

use crate::class_setting::ClassSettings;
use crate::constants::Constants;
use crate::decision::Decision;
use crate::error::SetupError;
use crate::format::MAX_CLASSES;
use crate::model::Model;
use crate::opinion::Pose;
use crate::rule::DecisionRule;
use crate::stream::{StreamState, WrongChannels};
use crate::words::Words;

/// A likelihood model under a rule, with the evidence so far. Reads how many
/// channels and classes there are from the model; `W` says where that lies
/// (see [`Model`]).
#[derive(Debug, Clone)]
pub struct NaiveBayes<R: DecisionRule, W = &'static [u32]> {
    constants: Constants<R, W>,
    stream: StreamState<R>,
    /// Whose tables, where each whisker has its own.
    whisker: Option<usize>,
}

impl<R: DecisionRule, W: Words> NaiveBayes<R, W> {
    /// Joins a model and a rule; nothing is seen yet, all classes are equal.
    ///
    /// # Errors
    /// The rule's settings do not fit the model.
    pub fn new(model: Model<W>, settings: R::Settings) -> Result<Self, SetupError> {
        let constants = Constants::new(model, settings)?;
        Ok(Self {
            stream: StreamState::new(&constants.model, &constants.rule),
            constants,
            whisker: None,
        })
    }

    /// Whose samples come next, from 0, where each whisker has tables of its own: a sample then has
    /// that one's two channels. `None`: it has those of all.
    pub const fn set_whisker(&mut self, whisker: Option<usize>) {
        self.whisker = whisker;
    }

    /// Priors and thresholds of classes take effect; all evidence is forgotten.
    pub fn set_classes(&mut self, classes: &ClassSettings) {
        self.constants.rule.set_classes(classes);
        self.reset();
    }

    /// The model.
    pub const fn model(&self) -> &Model<W> {
        &self.constants.model
    }

    /// Takes one sample of all channels, as codes of the model's quantisers.
    /// A decision may fall with the last sample of a block.
    ///
    /// # Errors
    /// The number of codes is not the model's number of channels; the sample
    /// is then not taken.
    #[inline]
    pub fn push(&mut self, codes: &[i32]) -> Result<Option<Decision>, WrongChannels> {
        let Constants { model, rule } = &self.constants;
        if self.stream.push(model, codes, self.whisker)? {
            return Ok(self.stream.end_of_block(model, rule));
        }
        Ok(None)
    }

    /// Takes a sample that does not count, as nothing is touched: it is seen by the
    /// differences of which roughness is made.
    ///
    /// # Errors
    /// As [`Self::push`].
    #[inline]
    pub fn pass(&mut self, codes: &[i32]) -> Result<(), WrongChannels> {
        let whisker = self.whisker;
        self.stream.pass(&self.constants.model, codes, whisker)
    }

    /// A touch begins, whose `number` its decisions bear. Where the model has a
    /// [`TouchRule`](crate::TouchRule), the open block is dropped and what came before
    /// is limited: the surface may have changed.
    pub fn touch(&mut self, number: u16) {
        let Constants { model, rule } = &self.constants;
        self.stream.begin_touch(model, rule, number);
    }

    /// Samples are missing before the next: the differences of which roughness is made
    /// begin again.
    pub const fn interrupt(&mut self) {
        self.stream.interrupt();
    }

    /// As [`StreamClassifier::pose`](crate::StreamClassifier::pose).
    pub fn pose(&self, class: usize) -> Option<Pose> {
        self.stream.pose(self.model().opinion()?, class)
    }

    /// Forgets all evidence.
    pub fn reset(&mut self) {
        self.stream = StreamState::new(&self.constants.model, &self.constants.rule);
    }

    /// Posterior of each class after the last full block. For display: costs
    /// an exponential a class and a division.
    pub fn posteriors(&self) -> Posteriors {
        let Constants { model, rule } = &self.constants;
        posteriors(model, rule, &self.stream.evidence)
    }
}

pub(crate) fn posteriors<R: DecisionRule, W: Words>(
    model: &Model<W>,
    rule: &R,
    evidence: &R::Evidence,
) -> Posteriors {
    let mut posteriors = Posteriors {
        q32: [0; MAX_CLASSES],
        classes: model.classes(),
    };
    let values = posteriors.q32.get_mut(..posteriors.classes);
    let values = values.unwrap_or_default();
    rule.deficits(evidence, values);
    rule.scale().posteriors(values);
    posteriors
}

/// Posterior probability of each class of a model; by default of no class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Posteriors {
    q32: [u32; MAX_CLASSES],
    classes: usize,
}

impl Posteriors {
    /// In units of 2⁻³², at most 2³² − 1.
    pub fn as_q32(&self) -> &[u32] {
        self.q32.get(..self.classes).unwrap_or_default()
    }

    /// In double precision.
    pub fn to_f64(&self) -> impl Iterator<Item = f64> {
        let unit = 1.0 / 4_294_967_296.0;
        self.as_q32().iter().map(move |&p| f64::from(p) * unit)
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use std::string::String;
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;
    use crate::WindowRule;
    use crate::format::{ENTRY_MAX, MAX_SAMPLES_TIMES_CHANNELS};
    use crate::model_buf::{Axis, ModelBuf, ModelParts, TableParts};
    use crate::quantiser::Quantiser;

    /// Channels of codes 0 to 999, of which each has its entries `[bin][class]`.
    fn model(classes: usize, block: u32, bins: usize, entries: &[Vec<u16>]) -> ModelBuf {
        let names: Vec<String> = (0..classes).map(|k| std::format!("class {k}")).collect();
        let channels = entries.len();
        let axis = |channel| Axis::new(channel, bins, [0, 1000]);
        let axes: Vec<Axis> = (0..channels).map(axis).collect();
        let tables = axes.iter().zip(entries);
        let tables: Vec<TableParts<'_>> = tables
            .map(|(axis, entries)| TableParts::of_channel(axis, entries))
            .collect();
        ModelBuf::new(&ModelParts {
            names: &names,
            block,
            channels: &std::vec![Quantiser::of_codes(0, 1000); channels],
            tables: &tables,
            ..ModelParts::default()
        })
        .unwrap()
    }

    #[test]
    fn sums_are_exact_at_the_limit() {
        // 9362 samples of seven channels: one short of the most.
        let row = std::vec![ENTRY_MAX, ENTRY_MAX, 0, ENTRY_MAX, 3];
        let block = MAX_SAMPLES_TIMES_CHANNELS / 7;
        let buf = model(5, block, 1, &std::vec![row; 7]);
        let mut c = NaiveBayes::<WindowRule, _>::new(buf, block).unwrap();
        for _ in 1..block {
            assert_eq!(c.push(&[1; 7]), Ok(None));
        }
        let samples = 7 * (block - 1);
        let full = samples * u32::from(ENTRY_MAX);
        assert_eq!(
            c.stream.sums.classes[..5],
            [full, full, 0, full, samples * 3]
        );
        assert_eq!(c.stream.sums.classes[5..], [0; 27]);
        let decision = c.push(&[1; 7]).unwrap().unwrap();
        assert_eq!((decision.class(), decision.samples()), (Some(0), block));
        assert_eq!(c.stream.sums.classes, [0; MAX_CLASSES]);
    }

    /// Whatever bits the counter of a block has, the block ends within its length, and the
    /// next has it.
    #[test]
    fn a_spoilt_counter_costs_a_block() {
        let buf = model(2, 60, 1, &[std::vec![3, 5]]);
        for bit in 0..32 {
            let mut c = NaiveBayes::<WindowRule, _>::new(buf.clone(), 60).unwrap();
            for _ in 0..25 {
                c.push(&[1]).unwrap();
            }
            c.stream.sums.left ^= 1 << bit;
            let mut ends = (0..240).filter(|_| c.push(&[1]).unwrap().is_some());
            let (first, second) = (ends.next().unwrap(), ends.next().unwrap());
            assert!(first <= 60, "{bit}: {first}");
            assert_eq!(second - first, 60, "{bit}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Sums of the open block against entries taken one by one.
        #[test]
        fn rows_of_all_channels_add_up(
            classes in 2..=MAX_CLASSES,
            entries in prop::collection::vec(prop::collection::vec(0..=ENTRY_MAX, 8 * MAX_CLASSES), 12),
            codes in prop::collection::vec(prop::array::uniform12(-100_i32..1100), 59),
        ) {
            let cut = |entries: &Vec<u16>| entries[..8 * classes].to_vec();
            let entries: Vec<Vec<u16>> = entries.iter().map(cut).collect();
            for channels in [1, 2, 3, 7, 12] {
                let buf = model(classes, 60, 8, &entries[..channels]);
                let mut c = NaiveBayes::<WindowRule, _>::new(buf, 60).unwrap();
                let mut expected = [0; MAX_CLASSES];
                for sample in &codes {
                    let sample = &sample[..channels];
                    c.push(sample).unwrap();
                    for other in [&sample[1..], &[sample, &[0]].concat()] {
                        let (expected, found) = (channels, other.len());
                        prop_assert_eq!(c.push(other), Err(WrongChannels { expected, found }));
                    }
                    for (code, entries) in sample.iter().zip(&entries) {
                        let bin = (code * 8).div_euclid(1000).clamp(0, 7) as usize;
                        let row = entries.chunks(classes).nth(bin).unwrap();
                        for (sum, entry) in expected.iter_mut().zip(row) {
                            *sum += u32::from(*entry);
                        }
                    }
                }
                prop_assert_eq!(c.stream.sums.classes, expected);
            }
        }
    }
}
