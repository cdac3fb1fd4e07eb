//! `[telemetry]`: what a PC is told of every tick, and what it may ask for.

use crate::key::yes_or_no;
use crate::keys::keys;

keys! {
    /// What a PC is told of every tick, and what it may ask for.
    #[derive(Copy)]
    pub struct TelemetrySection {
        /// A board has records of every tick for a probe, and carries out its commands. Left
        /// out, that takes no time and no memory; a simulation has nothing to leave out.
        rtt: bool = yes_or_no().default("true"),
    }
}
