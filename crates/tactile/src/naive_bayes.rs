//! The step that all rules share: look up each channel's log-likelihoods, add
//! them to the sums of the open block, and at its end ask the rule.

use core::fmt;

use crate::decision::Decision;
use crate::error::SetupError;
use crate::format::{MAX_CHANNELS, MAX_CLASSES};
use crate::model::Model;
use crate::quantiser::Binner;
use crate::rule::DecisionRule;

/// Words of a row of three or four classes.
const FEW: usize = 2;

/// A likelihood model under a rule, with the evidence so far. Reads how many
/// channels and classes there are from the model; `W` says where that lies
/// (see [`Model`]).
#[derive(Debug, Clone)]
pub struct NaiveBayes<R: DecisionRule, W = &'static [u32]> {
    model: Model<W>,
    rule: R,
    /// Of the model's channels; the others are not used.
    binners: [Binner; MAX_CHANNELS],
    state: State<R::Evidence>,
}

/// What changes as samples come in.
#[derive(Debug, Clone, PartialEq, Eq)]
struct State<E> {
    /// Samples to the end of the open block; not zero.
    left: u32,
    /// Sums of the open block. At most [`crate::MAX_SAMPLES_TIMES_CHANNELS`]
    /// entries are in one, which stays below 2³¹.
    sums: [u32; MAX_CLASSES],
    evidence: E,
}

/// A sample with another number of channels than the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WrongChannels {
    /// Of the model.
    pub expected: usize,
    /// Of the sample.
    pub found: usize,
}

impl fmt::Display for WrongChannels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { expected, found } = self;
        write!(f, "a sample of {found} channels; the model has {expected}")
    }
}

impl core::error::Error for WrongChannels {}

impl<E> State<E> {
    const fn new(left: u32, evidence: E) -> Self {
        Self {
            left,
            sums: [0; MAX_CLASSES],
            evidence,
        }
    }
}

impl<R: DecisionRule, W: AsRef<[u32]>> NaiveBayes<R, W> {
    /// Bytes that change as samples come in.
    pub const STATE_BYTES: usize = size_of::<State<R::Evidence>>();

    /// Joins a model and a rule; nothing is seen yet, all classes are equal.
    ///
    /// # Errors
    ///
    /// The rule's settings do not fit the model.
    pub fn new(model: Model<W>, settings: R::Settings) -> Result<Self, SetupError> {
        let rule = R::new(&model, settings)?;
        // The model's check has made sure that each channel has one.
        let binner = |channel| model.quantiser(channel)?.binner(model.bins()).ok();
        Ok(Self {
            binners: core::array::from_fn(|channel| binner(channel).unwrap_or_default()),
            state: State::new(rule.interval(), rule.start()),
            model,
            rule,
        })
    }

    /// The model.
    pub const fn model(&self) -> &Model<W> {
        &self.model
    }

    /// Takes one sample of all channels, as codes of the model's quantisers.
    /// A decision may fall with the last sample of a block.
    ///
    /// # Errors
    ///
    /// The number of codes is not the model's number of channels; the sample
    /// is then not taken.
    #[inline]
    pub fn push(&mut self, codes: &[i32]) -> Result<Option<Decision>, WrongChannels> {
        let expected = self.model.channels();
        let found = codes.len();
        if found != expected {
            return Err(WrongChannels { expected, found });
        }
        self.add(codes);
        if self.state.left > 1 {
            self.state.left -= 1;
            return Ok(None);
        }
        Ok(self.end_of_block())
    }

    /// Adds what each channel's code says of the classes to their sums.
    #[inline]
    fn add(&mut self, codes: &[i32]) {
        // The sums of three or four classes stay in registers: 48 instructions less
        // on a Cortex-M4F, 7 % of a tick.
        if self.model.row_words() == FEW {
            self.add_few(codes);
            return;
        }
        let (pairs, _) = self.state.sums.as_chunks_mut::<2>();
        let pairs = pairs.get_mut(..self.model.row_words()).unwrap_or_default();
        for (channel, (binner, &code)) in self.binners.iter().zip(codes).enumerate() {
            let bin = binner.bin(code, self.model.last_bin());
            add_row(pairs, self.model.row(bin, channel));
        }
    }

    /// The same for rows of [`FEW`] words.
    #[inline]
    fn add_few(&mut self, codes: &[i32]) {
        let (pairs, _) = self.state.sums.as_chunks_mut::<2>();
        let Some(pairs) = pairs.first_chunk_mut::<FEW>() else {
            return;
        };
        let mut sums = *pairs;
        for (channel, (binner, &code)) in self.binners.iter().zip(codes).enumerate() {
            let bin = binner.bin(code, self.model.last_bin());
            add_words(&mut sums, self.model.row(bin, channel));
        }
        *pairs = sums;
    }

    #[inline]
    fn end_of_block(&mut self) -> Option<Decision> {
        let State { sums, evidence, .. } = &mut self.state;
        let sums = sums.get_mut(..self.model.classes()).unwrap_or_default();
        let decision = self.rule.end_of_block(sums, evidence);
        self.state.left = self.rule.interval();
        decision
    }

    /// The end of a whisk or of a recording: rules that wait for it decide here
    /// (None if there was no sample), the others drop what they have. All
    /// evidence is then forgotten.
    pub fn finish(&mut self) -> Option<Decision> {
        let fresh = State::new(self.rule.interval(), self.rule.start());
        let state = core::mem::replace(&mut self.state, fresh);
        let samples = self.rule.interval().saturating_sub(state.left);
        let sums = state.sums.get(..self.model.classes()).unwrap_or_default();
        self.rule.finish(sums, samples, state.evidence)
    }

    /// Forgets all evidence.
    pub fn reset(&mut self) {
        self.state = State::new(self.rule.interval(), self.rule.start());
    }

    /// Posterior of each class after the last full block. For display: costs
    /// an exponential a class and a division.
    pub fn posteriors(&self) -> Posteriors {
        let mut posteriors = Posteriors {
            q32: [0; MAX_CLASSES],
            classes: self.model.classes(),
        };
        let values = posteriors.q32.get_mut(..posteriors.classes);
        let values = values.unwrap_or_default();
        self.rule.deficits(&self.state.evidence, values);
        self.rule.scale().posteriors(values);
        posteriors
    }
}

/// Adds the entries of a row of the table to the sums of their classes.
// A function of its own: within the tick it would be unrolled for many classes.
#[inline(never)]
fn add_row(sums: &mut [[u32; 2]], row: &[u32]) {
    add_words(sums, row);
}

/// The same, where it is called.
#[inline]
fn add_words(sums: &mut [[u32; 2]], row: &[u32]) {
    for ([even, odd], word) in sums.iter_mut().zip(row) {
        // See `MAX_SAMPLES_TIMES_CHANNELS`: no sum wraps.
        *even = even.wrapping_add(word & 0xffff);
        *odd = odd.wrapping_add(word >> 16);
    }
}

/// Posterior probability of each class of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    use crate::format::{ENTRY_MAX, MAX_SAMPLES_TIMES_CHANNELS};
    use crate::model_buf::{ModelBuf, ModelParts};
    use crate::quantiser::Quantiser;
    use crate::window::WindowRule;

    fn model(
        classes: usize,
        channels: usize,
        block: u32,
        bins: usize,
        entries: &[u16],
    ) -> ModelBuf {
        let names: Vec<String> = (0..classes).map(|k| std::format!("class {k}")).collect();
        let quantiser = Quantiser {
            origin: 0.0,
            exponent: 0,
            low: 0,
            high: 1000,
        };
        ModelBuf::new(&ModelParts {
            names: &names,
            block,
            bins,
            quantisers: &std::vec![quantiser; channels],
            entries,
        })
        .unwrap()
    }

    #[test]
    fn sums_are_exact_at_the_limit() {
        // 9362 samples of seven channels: one short of the most.
        let row = [ENTRY_MAX, ENTRY_MAX, 0, ENTRY_MAX, 3];
        let block = MAX_SAMPLES_TIMES_CHANNELS / 7;
        let buf = model(5, 7, block, 1, &row.repeat(7));
        let mut c = NaiveBayes::<WindowRule, _>::new(buf, block).unwrap();
        for _ in 1..block {
            assert_eq!(c.push(&[1; 7]), Ok(None));
        }
        let samples = 7 * (block - 1);
        let full = samples * u32::from(ENTRY_MAX);
        assert_eq!(c.state.sums[..5], [full, full, 0, full, samples * 3]);
        assert_eq!(c.state.sums[5..], [0; 27]);
        let decision = c.push(&[1; 7]).unwrap().unwrap();
        assert_eq!((decision.class(), decision.samples()), (0, block));
        assert_eq!(c.state.sums, [0; MAX_CLASSES]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Sums of the open block against entries taken one by one.
        #[test]
        fn rows_of_all_channels_add_up(
            entries in prop::collection::vec(0..=ENTRY_MAX, 8 * 12 * 9),
            codes in prop::collection::vec(prop::array::uniform12(-100_i32..1100), 59),
        ) {
            for channels in [1, 2, 7, 12] {
                let buf = model(9, channels, 60, 8, &entries[..8 * channels * 9]);
                let mut c = NaiveBayes::<WindowRule, _>::new(buf, 60).unwrap();
                let mut expected = [0; 9];
                for sample in &codes {
                    let sample = &sample[..channels];
                    c.push(sample).unwrap();
                    prop_assert!(c.push(&sample[1..]).is_err());
                    for (channel, &code) in sample.iter().enumerate() {
                        let bin = (code * 8).div_euclid(1000).clamp(0, 7) as usize;
                        let row = (bin * channels + channel) * 9;
                        for (sum, &entry) in expected.iter_mut().zip(&entries[row..row + 9]) {
                            *sum += u32::from(entry);
                        }
                    }
                }
                prop_assert_eq!(&c.state.sums[..9], &expected);
            }
        }
    }
}
