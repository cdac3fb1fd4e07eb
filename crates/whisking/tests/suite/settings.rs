//! Settings that the tests share.

use whisking::{Integrator, Settings};

/// A pattern generator alone: no coupling, noise or modulation by contact.
pub(crate) const fn plain(integrator: Integrator, tick_hz: f64, frequency_hz: f64) -> Settings {
    Settings {
        tick_hz,
        frequency_hz,
        integrator,
        coupling: false,
        noise: 0.0,
        rcp: None,
        cia: None,
    }
}
