//! Trials as blocks, and which of them are held out together.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::blocks::Blocks;
use crate::train_error::TrainError;

/// The blocks of a trial, or of half a trial.
pub(super) struct Piece<'t> {
    pub(super) class: usize,
    pub(super) recording: &'t str,
    /// The pieces of a fold are held out together.
    pub(super) fold: usize,
    pub(super) blocks: Blocks,
}

pub(super) struct Folded<'t> {
    /// In the order in which they were felt.
    pub(super) pieces: Vec<Piece<'t>>,
    /// Whether recordings are held out, not trials.
    pub(super) by_recording: bool,
    /// The classes whose only trial was cut in halves.
    pub(super) halved: Vec<usize>,
}

impl<'t> Folded<'t> {
    /// Says what is held out together, and splits the only trial of a class.
    pub(super) fn new(pieces: Vec<Piece<'t>>, names: &[String]) -> Result<Self, TrainError> {
        let of_class = |class| pieces.iter().filter(move |p: &&Piece<'_>| p.class == class);
        for (class, name) in names.iter().enumerate() {
            let blocks: usize = of_class(class).map(|piece| piece.blocks.len()).sum();
            if blocks < 2 {
                return Err(TrainError::TooShort { name: name.clone() });
            }
        }
        let in_several = |class| {
            let first = of_class(class).next().map(|piece| piece.recording);
            of_class(class).any(|piece| Some(piece.recording) != first)
        };
        let by_recording = (0..names.len()).all(in_several);
        let halved = (0..names.len()).filter(|&class| of_class(class).count() == 1);
        let mut folded = Self {
            by_recording,
            halved: halved.collect(),
            pieces: Vec::new(),
        };
        let mut recordings: Vec<&str> = pieces.iter().map(|piece| piece.recording).collect();
        recordings.sort_unstable();
        recordings.dedup();
        let mut seen = vec![0; names.len()];
        for piece in pieces {
            let fold = if by_recording {
                recordings
                    .binary_search(&piece.recording)
                    .unwrap_or_default()
            } else {
                seen[piece.class] += 1;
                seen[piece.class] - 1
            };
            folded.push(Piece { fold, ..piece });
        }
        Ok(folded)
    }

    fn push(&mut self, mut piece: Piece<'t>) {
        if !self.halved.contains(&piece.class) {
            self.pieces.push(piece);
            return;
        }
        let second = Piece {
            fold: piece.fold + 1,
            blocks: piece.blocks.split_off(piece.blocks.len() / 2),
            ..piece
        };
        self.pieces.extend([piece, second]);
    }
}
