//! Number formats and the constants that their kernels need, made by the build
//! script: constants, so that the optimiser sees them as in the firmware.

use whisking::{Real, Start, filter, gate, muscle, noise, oscillator, pd};

/// Made by the build script.
#[allow(clippy::unreadable_literal, reason = "numbers as they print")]
mod constants {
    use super::Format;
    use whisking::{Fix, Start, filter, gate, muscle, noise, oscillator, pd};

    include!(concat!(env!("OUT_DIR"), "/constants.rs"));
}

pub use constants::SECTIONS;

/// A number format to be measured; both integrators at 2 kHz, 2 whisks a
/// second, both sides coupled, RCP and CIA.
pub trait Format: Real {
    /// Its name in the table.
    const NAME: &'static str;
    /// The contact filter.
    const H50: filter::Config<Self>;
    /// Suppression.
    const RCP: gate::Rcp<Self>;
    /// Excitation.
    const CIA: gate::Cia<Self>;
    /// Noise of the oscillators.
    const NOISE: noise::Config<Self>;
    /// 1.45.
    const PEAK_GAIN: Self;
    /// The papers' oscillators.
    const EULER_OSCILLATORS: oscillator::Config<Self>;
    /// The papers' muscle.
    const EULER_MUSCLE: muscle::Config<Self>;
    /// Where both sides of the papers' start.
    const EULER_START: Start<Self, 2, 1>;
    /// The structure-preserving oscillators.
    const OSCILLATORS: oscillator::Config<Self>;
    /// The fourth-order muscle.
    const MUSCLE: muscle::Config<Self>;
    /// One side with a whisker.
    const START_1: Start<Self, 1, 1>;
    /// Two sides with a whisker each.
    const START_2: Start<Self, 2, 1>;
    /// Two sides with twelve whiskers each.
    const START_24: Start<Self, 2, 12>;
    /// Position control.
    const PD: pd::Config<Self>;

    /// A whole pattern generator with the structure-preserving integrators.
    const WHISKING: whisking::Config<Self> = whisking::Config {
        oscillators: Self::OSCILLATORS,
        muscle: Self::MUSCLE,
        peak_gain: Self::PEAK_GAIN,
        rcp: Some(Self::RCP),
        cia: Some(Self::CIA),
        noise: None,
    };
    /// The same with the papers' integrators.
    const EULER_WHISKING: whisking::Config<Self> = whisking::Config {
        oscillators: Self::EULER_OSCILLATORS,
        muscle: Self::EULER_MUSCLE,
        ..Self::WHISKING
    };
}
