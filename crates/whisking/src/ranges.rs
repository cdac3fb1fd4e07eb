//! Allowed ranges of the settings, for this crate's checks and for readers of
//! settings files. Both ends are allowed.

use core::ops::RangeInclusive;

use crate::oscillator::PSI_LIMIT;

/// Control rate 1/T, Hz.
pub const TICK_HZ: RangeInclusive<f64> = 200.0..=20_000.0;
/// Whisk frequency f_W, Hz.
pub const FREQUENCY_HZ: RangeInclusive<f64> = 0.05..=25.0;
/// Standard deviation σ_η of the oscillators' noise (eq. 5).
pub const NOISE: RangeInclusive<f64> = 0.0..=1.0;
/// Each state of an oscillator, ψ_1 and ψ_2, at the start and in the tick.
pub const PSI: RangeInclusive<f64> = -PSI_LIMIT..=PSI_LIMIT;
/// Gain g of a whisker, nominal and as CIA raises it (eq. 12).
pub const GAIN: RangeInclusive<f64> = 0.0..=2.0;
/// σ_z of RCP (eq. 10) and σ_g of CIA (eq. 12).
pub const GATE_GAIN: RangeInclusive<f64> = 0.0..=100.0;
/// τ_z of RCP and τ_g of CIA, seconds.
pub const GATE_TAU_S: RangeInclusive<f64> = 1e-6..=1e5;

/// Ranges of the position control.
pub mod pd {
    use core::ops::RangeInclusive;

    /// k_p, duty per degree of error.
    pub const KP: RangeInclusive<f64> = 0.0..=1e6;
    /// k_d, duty per degree per second.
    pub const KD: RangeInclusive<f64> = 0.0..=1e6;
    /// Largest duty.
    pub const LIMIT: RangeInclusive<f64> = 0.0..=1.0;
    /// Largest change of the duty per second.
    pub const SLEW_PER_S: RangeInclusive<f64> = 0.0..=1e12;
    /// Lowest and highest setpoint, degrees θ'.
    pub const ANGLE_DEG: RangeInclusive<f64> = -1e4..=1e4;
    /// Degrees of the whisker per count of the encoder.
    pub const DEGREES_PER_COUNT: RangeInclusive<f64> = 0.0..=360.0;
}
