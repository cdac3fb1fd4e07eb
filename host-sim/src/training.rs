//! Training a model from recordings.

use tactile::ModelBuf;
use tactile::train::joint::{self, JointModel, Trial};
use tactile::train::{TrainError, Trainer};

use crate::recording::Stream;

/// The papers' model of `streams`, of the samples whose contact is at least `gate`; classes
/// in the order in which they first appear.
///
/// # Errors
/// What the trainer refuses.
pub fn single<'s>(
    mut trainer: Trainer,
    streams: impl IntoIterator<Item = &'s Stream>,
    gate: f64,
) -> Result<ModelBuf, TrainError> {
    for stream in streams {
        let samples = stream.samples.iter().zip(stream.counts(gate));
        for (sample, _) in samples.filter(|(_, counts)| *counts) {
            trainer.add(&stream.label, sample)?;
        }
    }
    trainer.train()
}

/// The joint model of recordings, each with its name; a stream is a trial.
///
/// # Errors
/// What the trainer refuses.
pub fn joint(
    recordings: &[(String, Vec<Stream>)],
    options: &joint::Options,
) -> Result<JointModel, TrainError> {
    let trials = recordings.iter().flat_map(|(recording, streams)| {
        streams.iter().map(|stream| Trial {
            label: stream.label.clone(),
            recording: recording.clone(),
            samples: stream.samples.clone(),
            touches: stream.touches(options.gate, options.gap).collect(),
        })
    });
    joint::train(&trials.collect::<Vec<_>>(), options)
}
