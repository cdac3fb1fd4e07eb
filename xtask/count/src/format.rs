//! Number formats and the constants that their kernels need, made by the build
//! script. A kernel takes them by [`in_memory`], as the tick of a board reads
//! them from its settings.

use whisking::motor::GuardConfig;
use whisking::{Absent, Present, Real, Start, filter, gate, muscle, noise, oscillator, pd};

/// Made by the build script.
#[allow(clippy::unreadable_literal, reason = "numbers as they print")]
mod constants {
    use super::{Format, Generator, GuardConfig};
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
    const H50: &'static filter::Config<Self>;
    /// Suppression.
    const RCP: &'static gate::Rcp<Self>;
    /// Excitation.
    const CIA: &'static gate::Cia<Self>;
    /// Noise of the oscillators.
    const NOISE: &'static noise::Config<Self>;
    /// The papers' oscillators.
    const EULER_OSCILLATORS: &'static oscillator::Euler<Self>;
    /// The papers' muscle.
    const EULER_MUSCLE: &'static muscle::Euler<Self>;
    /// Where both sides of the papers' start.
    const EULER_START: Start<Self, 2, 1>;
    /// The structure-preserving oscillators.
    const OSCILLATORS: &'static oscillator::Exact<Self>;
    /// The fourth-order muscle.
    const MUSCLE: &'static muscle::Exact<Self>;
    /// One side with a whisker.
    const START_1: Start<Self, 1, 1>;
    /// Two sides with a whisker each.
    const START_2: Start<Self, 2, 1>;
    /// Two sides with twelve whiskers each.
    const START_24: Start<Self, 2, 12>;
    /// Position control.
    const PD: &'static pd::Config<Self>;
    /// What is a fault of a motor's motion.
    const GUARDS: &'static GuardConfig<Self>;

    /// A whole pattern generator with the structure-preserving integrators.
    const WHISKING: &'static Generator<Self, oscillator::Exact<Self>, muscle::Exact<Self>>;
    /// The same with the papers' integrators.
    const EULER_WHISKING: &'static Generator<Self, oscillator::Euler<Self>, muscle::Euler<Self>>;
}

/// A pattern generator with RCP and CIA, without noise, which few scenes have.
pub type Generator<R, Oscillators, Muscle> =
    whisking::Config<R, Oscillators, Muscle, Present<gate::Rcp<R>>, Present<gate::Cia<R>>, Absent>;

/// A constant that the compiler must read from memory.
#[inline]
pub fn in_memory<T>(constant: &T) -> &T {
    core::hint::black_box(constant)
}
