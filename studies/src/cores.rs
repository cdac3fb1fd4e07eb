//! Work that is shared out among all cores, with its progress.

use anyhow::Result;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use host_sim::progress::{Progress, Verbosity};
use rayon::prelude::*;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cores(pub(crate) Verbosity);

impl Cores {
    /// The results are in the order of `items`, and do not depend on the number of cores.
    pub(crate) fn each<T: Sync, U: Send>(
        self,
        message: &'static str,
        items: &[T],
        work: impl Fn(&T) -> Result<U> + Sync,
    ) -> Result<Vec<U>> {
        let bar = Mutex::new(Progress::new(self.0, message, items.len() as u64));
        let done = AtomicU64::new(0);
        let one = |item: &T| {
            let made = work(item)?;
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if let Ok(mut bar) = bar.lock() {
                bar.set(done);
            }
            Ok(made)
        };
        items.par_iter().map(one).collect()
    }
}
