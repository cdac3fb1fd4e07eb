//! `[rcp]` and `[cia]`: what contact does to the drive.

use whisking::GateSettings;
use whisking::ranges::{GATE_GAIN, GATE_TAU_S};

use crate::key::number;
use crate::keys::keys;

keys! {
    /// Rapid cessation of protraction.
    pub(crate) Rcp fills GateSettings {
        /// Gain σ_z on the contact signal.
        gain: f64 = number(GATE_GAIN),

        /// Time constant τ_z of the recovery.
        tau_s: f64 = number(GATE_TAU_S).unit("s"),
    }
}

keys! {
    /// Contact-induced asymmetry.
    pub(crate) Cia fills GateSettings {
        /// Gain σ_g with which contact excites the gates of all whiskers.
        gain: f64 = number(GATE_GAIN),

        /// Time constant τ_g of the recovery.
        tau_s: f64 = number(GATE_TAU_S).unit("s"),
    }
}
