//! Pages of the seeds of one rig, each evaluated by itself.

use crate::page::Page;

/// Pages of the seeds: as it is, and of placebos.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    pub(super) pages: Vec<Page>,
    pub(super) placebos: Vec<Page>,
}

impl Bodies {
    pub(super) const fn of(&mut self, is_placebo: bool) -> &mut Vec<Page> {
        if is_placebo {
            &mut self.placebos
        } else {
            &mut self.pages
        }
    }
}
