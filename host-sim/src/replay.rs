//! A recording through a model: the classifier that a board runs, fed with
//! recorded samples instead of a sensor's.

use scene::Rule;
use tactile::{AnyRule, ModelBuf, NaiveBayes, Quantiser, WrongChannels};

use crate::classifier::{self, Fault};
use crate::decisions::{self, Decided};
use crate::recording::Stream;

/// A classifier of recordings. Their samples may be any numbers: the model's
/// quantisers make codes of them.
#[derive(Debug, Clone)]
pub struct Replay {
    bayes: NaiveBayes<AnyRule, Box<[u32]>>,
    quantisers: [Quantiser; 2],
    classes: Vec<String>,
}

impl Replay {
    /// A classifier by a rule.
    ///
    /// # Errors
    /// [`Fault::Model`] for other than two channels, [`Fault::Rule`] for a window
    /// that is no multiple of the model's block or a threshold too near to 1.
    pub fn new(model: ModelBuf, rule: Rule) -> Result<Self, Fault> {
        let quantisers = classifier::quantisers(&model)?;
        let classes = classifier::names(&model);
        Ok(Self {
            bayes: classifier::bayes(model, rule)?,
            quantisers,
            classes,
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
        let mut decided = Vec::new();
        for sample in &stream.samples {
            let codes = [x.code_from_f64(sample[0]), y.code_from_f64(sample[1])];
            let Some(decision) = self.bayes.push(&codes)? else {
                continue;
            };
            decided.push(Decided {
                label: stream.label.clone(),
                trial: stream.trial.clone(),
                decision: decisions::name(decision, &self.classes).to_owned(),
                samples: decision.samples(),
                posterior: decision.posterior().to_f64(),
            });
        }
        Ok(decided)
    }
}
