//! `host-sim train`: a likelihood model from a recording.

use std::path::Path;

use tactile::ModelError;
use tactile::train::{Options, TrainError, Trainer};

use crate::Error;
use crate::files;
use crate::output::write_whole;
use crate::recording::GATE;
use crate::training;

/// Trains a model from the columns `channels` of the recording `data` and writes it to `out`.
/// Returns what it was made of.
///
/// # Errors
/// [`Error::Input`] for a recording or an option that is wrong, [`Error::Write`].
pub fn train(
    data: &Path,
    channels: [&str; 2],
    out: &Path,
    bins: usize,
    smooth: f64,
    block: u32,
) -> Result<String, Error> {
    let trainer = Trainer::new(
        2,
        Options {
            bins,
            smooth,
            block,
        },
    )
    .map_err(|error| Error::Input(format!("{}{error}", option(&error))))?;
    let streams = files::read_recording(data, channels)?;
    let model = training::train(trainer, &streams).map_err(|error| Error::file(data, error))?;
    write_whole(out, model.as_bytes())?;
    let counts = streams.iter().flat_map(|stream| stream.counts(GATE));
    let samples = counts.filter(|counts| *counts).count();
    Ok(format!(
        "{}: {samples} samples in {} streams, {} bytes",
        out.display(),
        streams.len(),
        model.as_bytes().len()
    ))
}

/// The option that an error is about.
fn option(error: &TrainError) -> &'static str {
    match error {
        TrainError::Smooth(_) => "--smooth: ",
        TrainError::Model(ModelError::Bins(_)) => "--bins: ",
        TrainError::Model(ModelError::Block(_) | ModelError::BlockTimesChannels(_)) => "--block: ",
        _ => "",
    }
}
