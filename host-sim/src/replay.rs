//! A recording through a model: the classifier that a board runs, fed with
//! recorded samples instead of a sensor's.

use scene::Rule;
use tactile::{AnyRule, ModelBuf, NaiveBayes, Quantiser, WrongChannels};

use crate::classifier::{self, Fault};
use crate::decisions::Decided;
use crate::recording::{GATE, Stream};

/// A classifier of recordings. Their samples may be any numbers: the model's
/// quantisers make codes of them.
#[derive(Debug, Clone)]
pub struct Replay {
    bayes: NaiveBayes<AnyRule, Box<[u32]>>,
    quantisers: [Quantiser; 2],
    classes: Vec<String>,
    /// Contact from which a sample counts, and samples without it that end a touch.
    gate: f64,
    gap: u32,
    /// The number of the last touch.
    touch: u16,
}

/// Samples without contact that end a touch where the model does not say: 100 ms at
/// 2 kHz.
const GAP: u32 = 200;

impl Replay {
    /// A classifier by a rule.
    ///
    /// # Errors
    /// [`Fault::Model`] for other than two channels, [`Fault::Rule`] for a window
    /// that is no multiple of the model's block or a threshold too near to 1.
    pub fn new(model: ModelBuf, rule: Rule) -> Result<Self, Fault> {
        let quantisers = classifier::quantisers(&model)?;
        let classes = classifier::names(&model);
        let touch = model.touch_rule();
        Ok(Self {
            bayes: classifier::bayes(model, rule)?,
            quantisers,
            classes,
            gate: touch.map_or(GATE, |touch| touch.gate.into()),
            gap: touch.map_or(GAP, |touch| touch.gap),
            touch: 0,
        })
    }

    /// The names of its classes.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }

    /// The decisions of one stream; evidence is dropped at its end.
    ///
    /// # Errors
    /// None: the model has the two channels of a recording.
    pub fn stream(&mut self, stream: &Stream) -> Result<Vec<Decided>, WrongChannels> {
        self.bayes.reset();
        let [x, y] = &self.quantisers;
        let (mut decided, mut last) = (Vec::new(), 0);
        let needs_touch = self.bayes.model().touch_rule().is_some();
        let touches = stream.touches(self.gate, self.gap);
        let counts = stream.counts(self.gate).zip(touches);
        for (sample, (counts, touch)) in stream.samples.iter().zip(counts) {
            let codes = [x.code_from_f64(sample[0]), y.code_from_f64(sample[1])];
            if touch != 0 && touch != last {
                last = touch;
                self.touch = self.touch.checked_add(1).unwrap_or(1);
                self.bayes.touch(self.touch);
            }
            if !counts || (needs_touch && touch == 0) {
                self.bayes.pass(&codes)?;
                continue;
            }
            let Some(decision) = self.bayes.push(&codes)? else {
                continue;
            };
            let Stream { label, trial, .. } = stream;
            let pose = decision.class().and_then(|class| self.bayes.pose(class));
            decided.push(Decided {
                pose,
                ..Decided::new(decision, &self.classes, label, trial)
            });
        }
        Ok(decided)
    }
}
