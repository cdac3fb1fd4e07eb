//! The whisker module: one tick from the sensor's bytes to the motor's duty
//! and a decision, without a chip in it.
//!
//! # Glossary
//!
//! - *tick*: one pass of the control loop, [`Module::tick`]: sense, filter,
//!   gate, step, follow, classify, in this order.
//! - *frame*: the eight bytes of one sensor reading; the tick uses the one
//!   that was complete before it began.
//! - *fault*: the motor of that whisker is off until a retry succeeds.
//! - *limit*: something out of the ordinary while the module still runs.
//! - *event*: what the tick has to say; queued, and logged elsewhere.
//!
//! # Composition
//!
//! A module is generic over what it reads ([`FrameSource`]), how it moves
//! ([`Motion`]: [`Passive`] or [`Active`]), what it decides ([`Perception`]:
//! `()` or [`Classifying`]) and its [`Clock`]. What a scene leaves out is a type
//! without state and code, or a `None` in a constant [`Config`].
#![cfg_attr(not(test), no_std)]

mod active;
pub mod design_parameters;
mod event;
mod io;
mod module;
mod perception;
mod sensing;
mod timing;

pub use active::{Active, ActiveConfig, Motion, Passive, Servo};
pub use event::{Event, Place, SensorFault};
pub use io::{AngleInput, BusError, Clock, FrameSource, Polled};
pub use module::{Config, Module};
pub use perception::{
    Classifying, ClassifyingConfig, CodeClassifier, NotCodes, Perception, SampleClassifier, shifts,
};
pub use sensing::{HoldLimits, Reading, Sensor};
pub use timing::Timing;
