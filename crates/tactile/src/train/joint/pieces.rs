//! Trials as blocks, and which of them are held out together.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::blocks::Blocks;
use super::trial::Trial;
use crate::format::{MAX_CLASSES, MAX_NAME_BYTES};
use crate::train_error::TrainError;

/// The blocks of a trial, or of half a trial.
pub(super) struct Piece<'t> {
    pub(super) class: usize,
    pub(super) recording: &'t str,
    /// The pieces of a fold are held out together.
    pub(super) fold: usize,
    pub(super) blocks: Blocks,
}

/// Class names, in order of first appearance.
pub(super) fn names(trials: &[Trial]) -> Result<Vec<String>, TrainError> {
    let mut names: Vec<String> = Vec::new();
    for trial in trials {
        if names.contains(&trial.label) {
            continue;
        }
        if trial.label.is_empty() {
            return Err(TrainError::NameEmpty);
        }
        let bytes = trial.label.len();
        if bytes > MAX_NAME_BYTES {
            return Err(TrainError::NameTooLong { bytes });
        }
        if names.len() == MAX_CLASSES {
            return Err(TrainError::TooManyClasses);
        }
        names.push(trial.label.clone());
    }
    match names.len() {
        0 => Err(TrainError::NoSamples),
        1 => Err(TrainError::OneClass),
        _ => Ok(names),
    }
}

/// Says what is held out together, and splits the only trial of a class. Returns
/// the classes that it was done to as well.
pub(super) fn folded<'t>(
    pieces: Vec<Piece<'t>>,
    names: &[String],
) -> Result<(Vec<Piece<'t>>, Vec<usize>), TrainError> {
    let mut recordings: Vec<&str> = pieces.iter().map(|piece| piece.recording).collect();
    recordings.sort_unstable();
    recordings.dedup();
    let of_class = |class| {
        pieces
            .iter()
            .filter(move |piece: &&Piece<'_>| piece.class == class)
    };
    let in_several = |class| {
        let first = of_class(class).next().map(|piece| piece.recording);
        of_class(class).any(|piece| Some(piece.recording) != first)
    };
    let by_recording = (0..names.len()).all(in_several);
    let mut halved = Vec::new();
    for (class, name) in names.iter().enumerate() {
        let trials = of_class(class).count();
        let blocks: usize = of_class(class).map(|piece| piece.blocks.len()).sum();
        if blocks < 2 {
            return Err(TrainError::TooShort { name: name.clone() });
        }
        if trials == 1 {
            halved.push(class);
        }
    }
    let mut seen = vec![0; names.len()];
    let mut folded = Vec::new();
    for mut piece in pieces {
        if by_recording {
            let place = recordings.binary_search(&piece.recording);
            piece.fold = place.unwrap_or_default();
        } else {
            piece.fold = seen[piece.class];
            seen[piece.class] += 1;
        }
        if halved.contains(&piece.class) {
            let rest = piece.blocks.split_off(piece.blocks.len() / 2);
            folded.push(Piece {
                fold: piece.fold + 1,
                blocks: rest,
                ..piece
            });
            let at = folded.len() - 1;
            folded.insert(at, piece);
        } else {
            folded.push(piece);
        }
    }
    Ok((folded, halved))
}
