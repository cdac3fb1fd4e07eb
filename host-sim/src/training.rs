//! Training a model from a recording.

use tactile::ModelBuf;
use tactile::train::{TrainError, Trainer};

use crate::recording::Stream;

/// The model of `streams`; classes in the order in which they first appear.
///
/// # Errors
/// What the trainer refuses.
pub fn train(mut trainer: Trainer, streams: &[Stream]) -> Result<ModelBuf, TrainError> {
    for stream in streams {
        for sample in &stream.samples {
            trainer.add(&stream.label, sample)?;
        }
    }
    trainer.train()
}
