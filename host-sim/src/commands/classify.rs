//! `host-sim classify`: a recording through the fixed-point classifier.

use std::path::Path;

use scene::Rule;

use crate::Error;
use crate::classifier::Fault;
use crate::decisions::{Columns, Score};
use crate::files;
use crate::misfit::misfits;
use crate::output::{Output, check_or_stdout};
use crate::progress::{Progress, Verbosity};
use crate::replay::Replay;
use crate::report::Summary;

/// Streams the columns `channels` of the recording `data` through the classifier of `model` and writes
/// its decisions to `out`, `-` being standard output. Returns their score.
///
/// # Errors
/// [`Error::Input`] for a model, recording or rule that is wrong, [`Error::Write`].
pub fn classify(
    model: &Path,
    data: &Path,
    channels: [&str; 2],
    rule: Rule,
    out: &Path,
    verbosity: Verbosity,
) -> Result<String, Error> {
    check_or_stdout(out)?;
    let (path, model) = files::load_model(model)?;
    let option = match rule {
        Rule::Sequential { threshold } => format!("--threshold {threshold}"),
        Rule::Window { samples } => format!("--window {samples}"),
    };
    let streams = files::read_recording(data, channels)?;
    let misfits = misfits(data, channels, &model, &streams);
    let mut replay = Replay::new(model, rule).map_err(|fault| match fault {
        Fault::Model(fault) => Error::file(&path, fault),
        Fault::Rule(fault) => Error::Input(format!("{option}: {fault}")),
    })?;
    let mut progress = Progress::new(verbosity, "classifying", streams.len() as u64);
    let mut decided = Vec::new();
    for (n, stream) in streams.iter().enumerate() {
        let made = replay.stream(stream);
        decided.extend(made.map_err(|fault| Error::file(&path, fault))?);
        progress.set(n as u64);
    }
    drop(progress);
    files::write_decisions(
        Output::create_or_stdout(out)?,
        &decided,
        Columns::OfRecording,
    )?;
    let score = Score::new(replay.classes(), &decided);
    let mut lines = vec![Summary(&score, None).to_string()];
    lines.extend(misfits);
    Ok(lines.join("\n"))
}
