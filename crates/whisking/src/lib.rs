//! Rat-like whisking: a pattern generator with its muscles and its modulation by
//! contact, and position control and drivers for the motors.
//!
//! Equation numbers are those of BIOTACT (Sullivan et al. 2011), read with the
//! misprints mended: the mass is m = T_W²/100 (eq. 7), contact lifts the gain
//! above its nominal value (eq. 12) and the gain returns to it exponentially
//! (eq. 13).
//!
//! # Glossary
//!
//! - *whisk*: one cycle of protraction (forwards) and retraction (backwards).
//! - *side*: left (0) or right (1); each has one oscillator ψ and up to twelve whiskers.
//! - *drive* W: an oscillator's input to the muscles of its side, 0 to 1.
//! - *θ*: protraction of one whisker, 0 at rest, about 1 at most; in degrees θ' = 100 θ + 50.
//! - *contact* π: strength of the contact of a side, 0 to about 1.
//! - *RCP*: rapid cessation of protraction; contact raises z, which weakens that side.
//! - *CIA*: contact-induced asymmetry; contact anywhere raises every gain g.
//! - *v*: velocity of a whisker in units of its natural frequency, (dθ/dt)/(10 f_W).
//! - *lag*: a first-order part of the muscle; θ is a sum of a slow and a fast one.
//! - *tick*: one control step of length T.
//!
//! # Where to look
//!
//! [`Settings`] (physical units, f64) are checked outside the tick, and give a
//! [`Config`] and a [`Start`] in a number format `R`. The tick is
//! [`PatternGenerator::step`] on a small [`State`]; it cannot fail. The parts of a
//! `Config` are types: a board names those of its scene, and its program
//! contains no others. With the feature `bake` a build script writes the type and
//! the value of a configuration as Rust source (`Config::source`).
#![cfg_attr(not(test), no_std)]

#[cfg(feature = "bake")]
mod bake;
mod elementary;
mod error;
pub mod filter;
pub mod gate;
mod integrator;
mod linalg;
mod math;
pub mod motor;
pub mod muscle;
pub mod noise;
mod optional;
pub mod oscillator;
pub mod pd;
pub mod ranges;
mod real;
mod settings;
mod start;
mod state;
mod step;
mod voted;
mod words;

#[cfg(feature = "bake")]
pub use bake::Source;
pub use elementary::Elementary;
pub use error::{Error, Parameter};
pub use integrator::Integrator;
pub use optional::{Absent, Optional, Present};
pub use real::{Constant, Factor, Factors, FineFactor, Fix, FormatCode, Real};
pub use settings::{GateSettings, Settings};
pub use state::{Start, State, Whisker};
pub use step::{Config, PatternGenerator};
pub use voted::Voted;
pub use words::{AsWords, Bound, WordRow};

/// Degrees of the motor per unit of protraction: θ' = 100 θ + 50 (BIOTACT section III-B).
pub const DEGREES_PER_UNIT: f64 = 100.0;
/// Motor angle of a whisker at rest (θ = 0), degrees.
pub const REST_DEG: f64 = 50.0;

/// θ' in degrees from θ.
#[inline]
pub fn degrees(theta: f64) -> f64 {
    DEGREES_PER_UNIT * theta + REST_DEG
}

/// θ from θ' in degrees.
#[inline]
pub fn protraction(degrees: f64) -> f64 {
    (degrees - REST_DEG) / DEGREES_PER_UNIT
}
