//! Which held-out touches say how sure an opinion that names may be.

use std::vec::Vec;

use super::linear::HeldOut;
use super::paths::Paths;
use super::typical::Typical;
use super::{Felt, LEAST_TOUCHES};

impl Felt {
    /// Of touches that were held out those that would be named, by rules that have not felt the
    /// recording either: only of these a posterior is said, and beyond the outermost poses it
    /// would be another. All, where that leaves too few.
    pub(super) fn named<'t>(
        &self,
        held_out: Vec<HeldOut<'t>>,
        recordings: usize,
    ) -> Vec<HeldOut<'t>> {
        let rules: Vec<Vec<(Typical, Paths)>> = (0..recordings)
            .map(|recording| self.without(recording).of_classes(true))
            .collect();
        let is_named = |held_out: &&HeldOut<'_>| {
            let HeldOut { touch, blocks, .. } = **held_out;
            let (typical, paths) = &rules[touch.recording][held_out.leader()];
            paths.has(touch, blocks) && typical.has(touch, blocks)
        };
        let named: Vec<_> = held_out.iter().filter(is_named).cloned().collect();
        let [least, _] = LEAST_TOUCHES;
        if named.len() < least * self.classes {
            held_out
        } else {
            named
        }
    }

    /// Without a recording, and without copies.
    fn without(&self, recording: usize) -> Self {
        let touches = self.touches.iter().filter(|t| t.recording != recording);
        let poses = self.poses.iter().filter(|pose| **pose != recording);
        Self {
            touches: touches.cloned().collect(),
            with_copies: Vec::new(),
            poses: poses.copied().collect(),
            ..*self
        }
    }
}
