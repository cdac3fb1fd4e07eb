//! `[sensor]`: what the readings of a whisker's sensor cannot do.

use crate::key::{number, positive};
use crate::keys::keys;

keys! {
    /// What a sensor's readings cannot do.
    #[derive(Copy)]
    pub struct SensorSection {
        /// Longest time for which both words may repeat to the bit; longer: a fault. Nothing
        /// is decided by a reading that has repeated for 7.5 ms.
        frozen_s: f64 = number(0.02..=30.0).unit("s").default("0.25"),

        /// Fastest change of a deflection, of the deflection from mid-scale to full scale; a
        /// frame beyond it is a bad one.
        jump_per_s: f64 = positive(1e6).unit("1/s").default("1500.0"),
    }
}
