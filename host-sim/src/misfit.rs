//! Where a recording does not fit a model, and what is odd about it: the file, the line and what
//! is there.

use std::path::{Path, PathBuf};

use scene::file;
use tactile::ModelBuf;

use crate::recording::{self, Stream};
use crate::{classifier, doubts};

/// What does not fit, a line each: samples outside of the model's range, if there are more
/// than a few, and labels that are none of its classes. `path` has the recording of which
/// `streams` were read, from the columns `channels`.
pub fn misfits(
    path: &Path,
    channels: [&str; 2],
    model: &ModelBuf,
    streams: &[Stream],
) -> Vec<String> {
    let mut found = Vec::new();
    let outside = doubts::outside(model, streams, channels);
    found.extend(outside.map(|(sample, said)| (sample, "warning", said)));
    let classes = classifier::names(model);
    let mut unknown: Vec<&str> = Vec::new();
    let mut first = 0;
    for stream in streams {
        let label = stream.label.as_str();
        if !classes.iter().any(|class| class == label) && !unknown.contains(&label) {
            unknown.push(label);
            let classes = classes.join(", ");
            let said = format!("label {label:?} is none of the model's classes: {classes}");
            found.push((first, "note", said));
        }
        first += stream.samples.len();
    }
    placed(path, found)
}

/// What is odd about recordings, a line each; `paths` have them.
pub(crate) fn oddities(
    paths: &[PathBuf],
    channels: [&str; 2],
    recordings: &[(String, Vec<Stream>)],
) -> Vec<String> {
    let doubts = doubts::doubts(recordings, channels);
    let of = |(n, path): (usize, &PathBuf)| {
        let own = doubts.iter().filter(|doubt| doubt.recording == n);
        let own = own.map(|doubt| (doubt.sample, "warning", doubt.said.clone()));
        placed(path, own.collect())
    };
    paths.iter().enumerate().flat_map(of).collect()
}

/// What was found at samples of a recording, with its kind, at the line of the file.
fn placed(path: &Path, found: Vec<(usize, &str, String)>) -> Vec<String> {
    if found.is_empty() {
        return Vec::new();
    }
    // Read again for its lines: few recordings need them.
    let lines = file::read(path, file::TABLE_BYTES).map(|bytes| recording::lines(&bytes));
    let lines = lines.unwrap_or_default();
    let place = |sample: usize| match lines.get(sample) {
        Some(line) => format!("{}:{line}", path.display()),
        None => path.display().to_string(),
    };
    let found = found.into_iter();
    found
        .map(|(sample, kind, said)| format!("{kind}: {}: {said}", place(sample)))
        .collect()
}
