//! The step that all rules share: look up the log-likelihoods of a sample, add them to
//! the sums of the open block, at its end those of its roughness, and ask the rule.

use core::fmt;

use crate::decision::Decision;
use crate::error::SetupError;
use crate::format::MAX_CLASSES;
use crate::lookup::Lookup;
use crate::model::Model;
use crate::roughness::Roughness;
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
    lookup: Lookup,
    state: State<R::Evidence>,
}

/// What changes as samples come in.
#[derive(Debug, Clone, PartialEq, Eq)]
struct State<E> {
    /// Samples to the end of the open block; not zero.
    left: u32,
    /// Sums of the open block; the check of the model keeps them below 2³¹.
    sums: [u32; MAX_CLASSES],
    evidence: E,
    roughness: Roughness,
    /// By how much each class exceeds its floors since the touch began: in samples,
    /// in roughness. Saturates.
    excess: [[i32; MAX_CLASSES]; 2],
    /// The number of the touch.
    touch: u16,
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
    const fn new(left: u32, evidence: E, roughness: Roughness) -> Self {
        Self {
            left,
            sums: [0; MAX_CLASSES],
            evidence,
            roughness,
            excess: [[0; MAX_CLASSES]; 2],
            touch: 0,
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
        Ok(Self {
            lookup: Lookup::new(model.sample_tables(), model.row_words()),
            state: State::new(rule.interval(), rule.start(), model.roughness()),
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
        self.check(codes)?;
        if self.model.has_roughness() {
            self.state.roughness.push(codes, true);
        }
        self.add(codes);
        if self.state.left > 1 {
            self.state.left -= 1;
            return Ok(None);
        }
        Ok(self.end_of_block())
    }

    /// Takes a sample that does not count, as nothing is touched: it is seen by the
    /// differences of which roughness is made.
    ///
    /// # Errors
    ///
    /// As [`Self::push`].
    #[inline]
    pub fn pass(&mut self, codes: &[i32]) -> Result<(), WrongChannels> {
        self.check(codes)?;
        if self.model.has_roughness() {
            self.state.roughness.push(codes, false);
        }
        Ok(())
    }

    /// A touch begins, whose `number` its decisions bear. Where the model has a
    /// [`TouchRule`](crate::TouchRule), the open block is dropped and what came before
    /// is limited: the surface may have changed.
    pub fn touch(&mut self, number: u16) {
        self.state.touch = number;
        let Some(touch) = self.model.touch_rule() else {
            return;
        };
        let limit = touch.limit.saturating_mul(self.model.block());
        self.rule.limit(&mut self.state.evidence, limit);
        self.state.left = self.rule.interval();
        self.state.sums = [0; MAX_CLASSES];
        self.state.excess = [[0; MAX_CLASSES]; 2];
        self.state.roughness.clear();
    }

    #[inline]
    const fn check(&self, codes: &[i32]) -> Result<(), WrongChannels> {
        let expected = self.model.channels();
        let found = codes.len();
        if found == expected {
            Ok(())
        } else {
            Err(WrongChannels { expected, found })
        }
    }

    /// Adds what each table of samples says of the classes to their sums.
    #[inline]
    fn add(&mut self, codes: &[i32]) {
        let (pairs, _) = self.state.sums.as_chunks_mut::<2>();
        // The sums of three or four classes stay in registers: 48 instructions less
        // on a Cortex-M4F, 7 % of a tick.
        if self.model.row_words() == FEW
            && let Some(pairs) = pairs.first_chunk_mut::<FEW>()
        {
            let mut sums = *pairs;
            for row in self.lookup.rows(codes) {
                add_words(&mut sums, self.model.words_from(row));
            }
            *pairs = sums;
            return;
        }
        let pairs = pairs.get_mut(..self.model.row_words()).unwrap_or_default();
        for row in self.lookup.rows(codes) {
            add_row(pairs, self.model.words_from(row));
        }
    }

    /// Nothing seen yet.
    fn fresh(&self) -> State<R::Evidence> {
        State::new(
            self.rule.interval(),
            self.rule.start(),
            self.model.roughness(),
        )
    }

    #[inline]
    fn end_of_block(&mut self) -> Option<Decision> {
        let State {
            left,
            sums,
            evidence,
            roughness,
            excess,
            touch,
        } = &mut self.state;
        if self.model.has_roughness() || self.model.has_floors() {
            add_roughness(&self.model, roughness, sums, excess);
        }
        let sums = sums.get_mut(..self.model.classes()).unwrap_or_default();
        let decision = self.rule.end_of_block(sums, evidence);
        *left = self.rule.interval();
        let decision = decision?;
        let below =
            |excess: &[i32; MAX_CLASSES]| excess.get(decision.leader()).is_some_and(|e| *e < 0);
        Some(decision.in_touch(*touch, excess.iter().any(below)))
    }

    /// The end of a whisk or of a recording: rules that wait for it decide here
    /// (None if there was no sample), the others drop what they have. All
    /// evidence is then forgotten.
    pub fn finish(&mut self) -> Option<Decision> {
        let fresh = self.fresh();
        let state = core::mem::replace(&mut self.state, fresh);
        let samples = self.rule.interval().saturating_sub(state.left);
        let sums = state.sums.get(..self.model.classes()).unwrap_or_default();
        self.rule.finish(sums, samples, state.evidence)
    }

    /// Forgets all evidence.
    pub fn reset(&mut self) {
        self.state = self.fresh();
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

/// Adds the entries of a row of a table to the sums of their classes.
// A function of its own: within the tick it would be unrolled for many classes.
#[inline(never)]
fn add_row(sums: &mut [[u32; 2]], row: &[u32]) {
    add_words(sums, row);
}

/// The same, where it is called.
#[inline]
fn add_words(sums: &mut [[u32; 2]], row: &[u32]) {
    for ([even, odd], word) in sums.iter_mut().zip(row) {
        // No sum wraps: the check of the model sees to that.
        *even = even.wrapping_add(word & 0xffff);
        *odd = odd.wrapping_add(word >> 16);
    }
}

/// Compares the sums of a block with their floors, adds what its roughness says of the
/// classes, which weighs as much as the mean of its samples, and begins another.
#[inline(never)]
fn add_roughness<W: AsRef<[u32]>>(
    model: &Model<W>,
    roughness: &mut Roughness,
    sums: &mut [u32; MAX_CLASSES],
    excess: &mut [[i32; MAX_CLASSES]; 2],
) {
    let [of_samples, of_roughness] = excess;
    let (floors, block) = (model.all_floors(), model.block());
    for ((excess, sum), floors) in of_samples.iter_mut().zip(&*sums).zip(floors) {
        let floor = (floors & 0xffff) * block;
        *excess = excess.saturating_add(sum.wrapping_sub(floor).cast_signed());
    }
    let mut place = 0;
    let mut entries = [0; MAX_CLASSES];
    let (pairs, _) = entries.as_chunks_mut::<2>();
    let pairs = pairs.get_mut(..model.row_words()).unwrap_or_default();
    for table in model.rough_tables() {
        let cell = table.cell(|axis, _| roughness.code(place + axis));
        add_words(pairs, model.row(table, cell));
        place += usize::from(table.axes);
    }
    for ((excess, entry), floors) in of_roughness.iter_mut().zip(entries).zip(floors) {
        let floor = floors >> 16;
        *excess = excess.saturating_add(entry.wrapping_sub(floor).cast_signed());
    }
    for (sum, entry) in sums.iter_mut().zip(entries).take(model.classes()) {
        *sum = sum.wrapping_add(entry.wrapping_mul(block));
    }
    roughness.clear();
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
    use crate::model_buf::{Axis, ModelBuf, ModelParts, TableParts};
    use crate::quantiser::Quantiser;
    use crate::window::WindowRule;

    /// Channels of codes 0 to 999; entries `[bin][channel][class]`.
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
        let axis = |channel| Axis {
            channel,
            bins,
            low: 0,
            high: 1000,
        };
        let axes: Vec<Axis> = (0..channels).map(axis).collect();
        let rows = |channel| entries.chunks(classes).skip(channel).step_by(channels);
        let of_channels: Vec<Vec<u16>> = (0..channels)
            .map(|c| rows(c).flatten().copied().collect())
            .collect();
        let tables: Vec<TableParts<'_>> = axes
            .iter()
            .zip(&of_channels)
            .map(|(axis, entries)| TableParts::of_channel(axis, entries))
            .collect();
        ModelBuf::new(&ModelParts {
            names: &names,
            block,
            channels: &std::vec![quantiser; channels],
            tables: &tables,
            floors: None,
            touch: None,
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
        assert_eq!((decision.class(), decision.samples()), (Some(0), block));
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
