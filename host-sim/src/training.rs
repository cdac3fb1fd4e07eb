//! Training a model from a recording.

use tactile::ModelBuf;
use tactile::train::{TrainError, Trainer};

use crate::recording::{GATE, Stream};

/// The model of `streams`; classes in the order in which they first appear.
///
/// # Errors
/// What the trainer refuses.
pub fn train(mut trainer: Trainer, streams: &[Stream]) -> Result<ModelBuf, TrainError> {
    for stream in streams {
        let samples = stream.samples.iter().zip(stream.counts(GATE));
        for (sample, _) in samples.filter(|(_, counts)| *counts) {
            trainer.add(&stream.label, sample)?;
        }
    }
    trainer.train()
}
