//! `host-sim classify`: a recording through the fixed-point classifier.

use std::path::Path;

use scene::Rule;

use crate::classifier::Fault;
use crate::decisions::{Columns, Decided, Score};
use crate::misfit::{misfits, oddities};
use crate::output::{Output, check_apart, check_or_stdout};
use crate::progress::{Progress, Verbosity};
use crate::recording::Stream;
use crate::replay::Replay;
use crate::{Error, files, rate, report};

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
    check_apart(out, [model, data])?;
    let (path, model) = files::load_model(model)?;
    let option = match rule {
        Rule::Sequential { threshold } => format!("--threshold {threshold}"),
        Rule::Window { samples } => format!("--window {samples}"),
        Rule::Costs { .. } => "costs".to_owned(),
    };
    let recording = files::whole_recording(data, channels)?;
    let trained = (path.display().to_string(), model.rate_hz());
    let above = files::rate_of(data, &recording);
    let assumed = rate::assumed(&trained, &above).map(|note| format!("note: {note}"));
    rate::agreed([trained, above]).map_err(Error::Input)?;
    let has_pose = model.has_pose();
    let streams = recording.streams;
    let mut misfits = misfits(data, channels, &model, &streams);
    let named = [(data.display().to_string(), streams)];
    misfits.extend(oddities(&[data.to_owned()], channels, &named));
    let [(_, streams)] = named;
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
    let columns = Columns::of_recording(has_pose);
    files::write_decisions(Output::create_or_stdout(out)?, &decided, columns)?;
    let score = Score::new(replay.classes(), &decided);
    let mut lines = vec![report::summary(&score, None)];
    lines.extend(undecided(replay.classes(), &streams, &decided));
    lines.extend(misfits);
    lines.extend(assumed);
    Ok(lines.join("\n"))
}

/// The classes that are in a recording and on which nothing was decided, where something was.
fn undecided(classes: &[String], streams: &[Stream], decided: &[Decided]) -> Option<String> {
    let is_there = |class: &&String| streams.iter().any(|stream| stream.label == **class);
    let is_decided = |class: &&String| decided.iter().any(|one| one.label == **class);
    let silent = classes
        .iter()
        .filter(is_there)
        .filter(|class| !is_decided(class));
    let silent: Vec<&str> = silent.map(String::as_str).collect();
    let is_said = !silent.is_empty() && !decided.is_empty();
    is_said.then(|| format!("left out, nothing was decided on: {}", silent.join(", ")))
}
