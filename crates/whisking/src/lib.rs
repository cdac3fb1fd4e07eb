//! Rat-like whisking: a pattern generator with its muscles and its modulation by
//! contact, and position control and drivers for the motors.
//!
//! Equation numbers are those of BIOTACT (Sullivan et al. 2011), read with the misprints mended:
//! the mass is m = T_W²/100 (eq. 7), contact lifts the gain above its nominal value (eq. 12) and
//! the gain returns to it exponentially (eq. 13).
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
//! [`Config`] and a [`Start`] in a number format `R`. The tick is [`Config::step`] on a
//! small [`State`]; it cannot fail. A `Config` and a `Start` are plain data, with serde:
//! a PC writes them, a board reads them and checks each constant ([`Bounded`]).
//!
//! # Features
//!
//! `rcp`, `cia`, `noise`, `euler` and `exact`, all on by default, say what a program can
//! compute. A `Config` has the same layout in every program; a part whose feature is
//! off is taken as absent, and an integrator whose feature is off moves nothing.
//! With `array` a microcontroller has room for as many whiskers as a PC.
#![cfg_attr(not(test), no_std)]

mod bounded;
mod error;
pub mod filter;
pub mod gate;
mod linalg;
mod list;
mod math;
pub mod motor;
pub mod muscle;
pub mod noise;
pub mod oscillator;
pub mod pd;
pub mod ranges;
mod real;
mod settings;
mod start;
mod state;
mod step;
mod voted;

pub use bounded::{Bound, Bounded};
pub use error::{Error, Parameter};
pub use real::{Constant, Factor, FactorRow, Factors, FineFactor, Fix, FormatCode, Real};
pub use settings::{GateSettings, Integrator, Settings};
pub use state::{Side, SideStart, Start, State, WhiskerStart, WhiskerState};
pub use step::{Config, Number};
pub use voted::Voted;

/// Most sides of a module: left and right.
pub const MAX_SIDES: usize = 2;
/// Most whiskers of a configuration: 2 on a board that is alone, 24 of a head and in a simulation.
pub const MAX_WHISKERS: usize = if cfg!(target_os = "none") && !cfg!(feature = "array") {
    2
} else {
    24
};
/// Most whiskers of a module: 2 on a board, those of a configuration in a simulation.
pub const MAX_OWN: usize = if cfg!(target_os = "none") {
    2
} else {
    MAX_WHISKERS
};

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
