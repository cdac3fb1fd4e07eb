//! Signals that would end the program, where motors are stopped first.

use std::sync::atomic::{AtomicBool, Ordering};

use host_sim::Error;

/// Whether one of them has come since [`heed`].
static HAS_COME: AtomicBool = AtomicBool::new(false);

/// From now on they are only noted, for [`check`].
pub(crate) fn heed() -> Result<(), Error> {
    on_signal(|_| HAS_COME.store(true, Ordering::Relaxed))
}

/// Fails once one has come.
pub(crate) fn check() -> Result<(), Error> {
    if HAS_COME.load(Ordering::Relaxed) {
        let fault = "interrupted; the motors were stopped";
        return Err(Error::Work(fault.to_owned()));
    }
    Ok(())
}

/// Has `act` called with each of them, in place of the end of the program.
#[cfg(unix)]
pub(crate) fn on_signal(mut act: impl FnMut(i32) + Send + 'static) -> Result<(), Error> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    let failed = |error: std::io::Error| Error::Work(format!("interrupts: {error}"));
    let mut signals = Signals::new([SIGHUP, SIGINT, SIGTERM]).map_err(failed)?;
    let thread = std::thread::Builder::new().name("signals".to_owned());
    let started = thread.spawn(move || signals.forever().for_each(&mut act));
    started.map(drop).map_err(failed)
}

/// Elsewhere an interrupt ends the program, and the module's own limits have to do.
#[cfg(not(unix))]
#[allow(clippy::unnecessary_wraps, reason = "on Unix the system may refuse")]
pub(crate) fn on_signal(_: impl FnMut(i32) + Send + 'static) -> Result<(), Error> {
    Ok(())
}
