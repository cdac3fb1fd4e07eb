//! `host-sim classify`: a recording through the fixed-point classifier.

use std::path::Path;

use scene::Rule;
use tactile::{AnyRule, AnyRuleSettings, Model, NaiveBayes, Quantiser, Threshold};

use crate::Error;
use crate::classifier::{self, Fault};
use crate::decisions::{Decided, Score};
use crate::files;
use crate::progress::{Progress, Verbosity};
use crate::recording::Stream;

/// Streams the recording `data` through the classifier of `model` and writes
/// its decisions to `out`. Returns their score.
///
/// # Errors
/// [`Error::Input`] for a model, recording or rule that is wrong, [`Error::Write`].
pub fn classify(
    model: &Path,
    data: &Path,
    rule: Rule,
    out: &Path,
    verbosity: Verbosity,
) -> Result<String, Error> {
    let (path, model) = files::load_model(model)?;
    let mut classifier = Streamed::new(model.view(), rule).map_err(|fault| match fault {
        Fault::Model(fault) => Error::file(&path, fault),
        Fault::Rule(fault) => Error::Input(fault),
    })?;
    let streams = files::read_recording(data)?;
    let mut progress = Progress::new(verbosity, "classifying", streams.len() as u64);
    let mut decided = Vec::new();
    for (n, stream) in streams.iter().enumerate() {
        let told = classifier.stream(stream, &mut decided);
        told.map_err(|fault| Error::file(&path, fault))?;
        progress.set(n as u64);
    }
    drop(progress);
    files::write_decisions(out, &decided)?;
    let score = Score::new(&classifier::names(&model), &decided);
    Ok(match (score.hit_rate(), score.mean_samples()) {
        (Some(hits), Some(samples)) => format!(
            "{score}{} decisions, hit rate {:.1} % (mean over classes), mean {samples:.0} samples",
            score.decisions(),
            100.0 * hits
        ),
        _ => "no decision".to_owned(),
    })
}

/// A classifier with the names and quantisers of its model.
struct Streamed<'m> {
    classifier: NaiveBayes<AnyRule, &'m [u32]>,
    quantisers: [Quantiser; 2],
    names: Vec<String>,
}

impl<'m> Streamed<'m> {
    fn new(model: Model<&'m [u32]>, rule: Rule) -> Result<Self, Fault> {
        let (Some(x), Some(y), 2) = (model.quantiser(0), model.quantiser(1), model.channels())
        else {
            let fault = format!("the model has {} channels, not x and y", model.channels());
            return Err(Fault::Model(fault));
        };
        let settings = match rule {
            Rule::Sequential { threshold } => AnyRuleSettings::Sequential(
                Threshold::new(threshold)
                    .map_err(|error| Fault::Rule(format!("--threshold {threshold}: {error}")))?,
            ),
            Rule::Window { samples } => AnyRuleSettings::Window(samples),
        };
        let classifier = NaiveBayes::new(model, settings).map_err(|error| match rule {
            Rule::Sequential { .. } => Fault::Rule(error.to_string()),
            Rule::Window { samples } => Fault::Rule(format!("--window {samples}: {error}")),
        })?;
        Ok(Self {
            classifier,
            quantisers: [x, y],
            names: classifier::names(&model),
        })
    }

    /// Appends the decisions of one stream; evidence does not outlive it.
    fn stream(&mut self, stream: &Stream, decided: &mut Vec<Decided>) -> Result<(), String> {
        self.classifier.reset();
        let [x, y] = &self.quantisers;
        for sample in &stream.samples {
            let codes = [x.code_from_f64(sample[0]), y.code_from_f64(sample[1])];
            let pushed = self
                .classifier
                .push(&codes)
                .map_err(|error| error.to_string())?;
            decided.extend(pushed.map(|decision| {
                Decided {
                    label: stream.label.clone(),
                    trial: stream.trial.clone(),
                    decision: self
                        .names
                        .get(decision.class())
                        .cloned()
                        .unwrap_or_default(),
                    samples: decision.samples(),
                    posterior: decision.posterior().to_f64(),
                }
            }));
        }
        Ok(())
    }
}
