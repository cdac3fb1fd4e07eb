//! A recording through a model: the classifier that a board runs, fed with
//! recorded samples instead of a sensor's.

use scene::Rule;
use tactile::{AnyRule, ModelBuf, NaiveBayes, Quantiser};

use crate::classifier::{self, Fault};
use crate::decisions::Decided;
use crate::recording::{GATE, Stream};

/// A classifier of recordings. Their samples may be any numbers: the model's
/// quantisers make codes of them.
#[derive(Debug, Clone)]
pub struct Replay {
    bayes: NaiveBayes<AnyRule, Box<[u32]>>,
    /// Of each whisker that has tables of its own, or one for all.
    quantisers: Vec<[Quantiser; 2]>,
    classes: Vec<String>,
    /// Contact from which a sample counts, and samples without it that end a touch.
    gate: f64,
    gap: u32,
    touch: u16,
}

/// Samples without contact that end a touch where the model does not say: 100 ms at 2 kHz.
const GAP: u32 = 200;

impl Replay {
    /// A classifier by a rule.
    ///
    /// # Errors
    /// [`Fault::Model`] for other than two channels a whisker, [`Fault::Rule`] for a window
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
    /// [`Fault::Model`] for a whisker of which the model has no tables.
    pub fn stream(&mut self, stream: &Stream) -> Result<Vec<Decided>, Fault> {
        self.bayes.reset();
        let whisker = (self.quantisers.len() > 1).then(|| stream.whisker() - 1);
        self.bayes.set_whisker(whisker);
        let [x, y] = self.quantisers.get(whisker.unwrap_or(0)).ok_or_else(|| {
            let (found, allowed) = (stream.whisker(), self.quantisers.len());
            Fault::Model(format!(
                "trial {}: whisker {found}; the model has tables of {allowed}",
                stream.trial
            ))
        })?;
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
                self.bayes.pass(&codes).map_err(classifier::of_model)?;
                continue;
            }
            let Some(decision) = self.bayes.push(&codes).map_err(classifier::of_model)? else {
                continue;
            };
            let Stream { label, trial, .. } = stream;
            let pose = decision.class().and_then(|class| self.bayes.pose(class));
            let made = Decided::new(decision, &self.classes, label, trial);
            decided.push(Decided {
                pose,
                // As the recording counts them, if it does.
                touch: stream.touch.as_ref().map_or(made.touch, |_| last),
                ..made
            });
        }
        Ok(decided)
    }
}

#[cfg(test)]
mod tests {
    use scene::Rule;
    use tactile::train::{Options, Trainer};

    use super::{Decided, Replay};
    use crate::recording::Stream;
    use crate::training;

    fn stream(label: &str, whisker: usize, x: f64) -> Stream {
        let samples = (0..400).map(|n| [x + f64::from(n % 7), f64::from(n % 5)]);
        Stream {
            label: label.to_owned(),
            trial: format!("1 whisker {whisker}"),
            samples: samples.collect(),
            ..Stream::default()
        }
    }

    #[test]
    fn whiskers_that_feel_the_opposite_are_each_judged_by_their_own() {
        let streams = [
            ("a", 1, 100.0),
            ("a", 2, -100.0),
            ("b", 1, -100.0),
            ("b", 2, 100.0),
        ];
        let streams = streams.map(|(label, whisker, x)| stream(label, whisker, x));
        let trainer = Trainer::new(4, Options::default()).unwrap();
        let model = training::single(trainer, &streams, 0.0, true).unwrap();
        let mut replay = Replay::new(model, Rule::Sequential { threshold: 0.99 }).unwrap();
        for stream in &streams {
            let decided = replay.stream(stream).unwrap();
            let are_right = decided.iter().all(Decided::is_right);
            assert!(are_right && !decided.is_empty(), "{decided:?}");
        }
        let third = replay.stream(&stream("a", 3, 0.0)).unwrap_err();
        let expected = "trial 1 whisker 3: whisker 3; the model has tables of 2";
        assert_eq!(third.to_string(), expected);
    }
}
