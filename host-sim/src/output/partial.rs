//! Files that are not complete yet: removed by whoever drops them, and by an interrupt.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// All that there are. Whoever holds it decides what is on the disk.
static THERE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn there() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of names is whole after every step.
    THERE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file beside its target, until it is renamed.
#[derive(Debug)]
pub(super) struct Partial(PathBuf);

impl Partial {
    /// Makes one for `target`, which has a file name.
    pub(super) fn create(target: &Path) -> io::Result<(File, Self)> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let mut name = target.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.{count}.partial", std::process::id()));
        let path = target.with_file_name(name);
        let mut there = there();
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&path)?;
        there.insert(path.clone());
        Ok((file, Self(path)))
    }

    pub(super) fn rename(self, target: &Path) -> io::Result<()> {
        let mut there = there();
        fs::rename(&self.0, target)?;
        there.remove(&self.0);
        Ok(())
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        let mut there = there();
        if there.remove(&self.0) {
            // Nothing can be done here about a file that cannot be removed.
            let _ = fs::remove_file(&self.0);
        }
    }
}

/// From here on an interrupt (SIGINT, SIGTERM, and SIGHUP where it ends programs) removes what is not complete before it ends
/// the program, as it would have without this. To be called once, at the start of a program.
///
/// # Errors
/// If the system does not let signals be handled, or no thread be made.
#[cfg(unix)]
pub fn remove_on_interrupt() -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    if !is_ignored(SIGHUP) {
        signals.add_signal(SIGHUP)?;
    }
    let wait = move || {
        for signal in signals.forever() {
            // Held to the end: no file comes or is renamed after this.
            let there = there();
            for path in there.iter() {
                let _ = fs::remove_file(path);
            }
            // Whoever started the program sees that a signal ended it.
            if emulate_default_handler(signal).is_err() {
                std::process::exit(1);
            }
        }
    };
    let thread = std::thread::Builder::new().name("interrupt".to_owned());
    thread.spawn(wait).map(drop)
}

/// Whether whoever started the program has it ignore a signal, as `nohup` does; so too where
/// the system does not say.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Elsewhere an interrupt leaves what is not complete.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn remove_on_interrupt() -> io::Result<()> {
    Ok(())
}
