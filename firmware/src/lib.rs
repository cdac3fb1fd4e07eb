//! The whisker module: one tick from the sensor's bytes to the motor's duty
//! and a decision, without a chip in it.
//!
//! # Glossary
//!
//! - *tick*: one pass of the control loop, [`Module::tick`]: sense, filter,
//!   gate, step, position control, classify, in this order.
//! - *frame*: the eight bytes of one sensor reading; the tick uses the one
//!   that was complete before it began.
//! - *fault*: the motor of that whisker is off until a retry succeeds; meanwhile it
//!   feels nothing. Whether the others go on is the scene's choice ([`StopAll`]).
//! - *limit*: something out of the ordinary while the module still runs. Both are listed in
//!   [`faults`].
//! - *armed*: motors may be driven; a module that is not armed computes on.
//! - *event*: what a tick reports; queued, and logged elsewhere.
//! - *servo*: a whisker's motor, angle input and position control.
//! - *link*: to a PC, by the records, requests and answers of the crate `wire`.
//!
//! # Composition
//!
//! A module is generic over what it reads ([`WordSource`], mostly by [`FrameSource`]), how
//! it moves ([`Motion`]: [`Passive`] or [`Active`]), what it decides ([`Perception`]:
//! `()` or [`Classifying`]) and its [`Clock`]. Its constants are one [`Config`],
//! which each tick reads. What a scene leaves out is a type without state and
//! code. Between ticks a [`Command`] changes a whisker's gain or setpoint.
#![cfg_attr(not(test), no_std)]

mod active;
mod button;
pub mod design_parameters;
mod event;
pub mod faults;
mod io;
pub mod lines;
mod module;
mod motion;
mod perception;
mod queue;
mod record;
mod sensing;
mod servo;
mod signals;
mod telemetry;
#[cfg(feature = "tmag5170")]
mod tilt;
mod timing;
mod tunable;
mod tuning;
mod zero;

pub use active::{Active, ActiveConfig, StopAll};
pub use button::{Button, ButtonLimits};
#[cfg(feature = "tmag5170")]
pub use event::TiltFault;
pub use event::{Event, Place, SensorFault};
pub use io::{AngleInput, BusError, Clock, FrameSource, Polled, WordSource};
pub use module::{Config, Module};
pub use motion::{
    Command, Motion, MotionRecord, MotorControl, MotorRecord, NoActiveWhisker, Passive,
};
pub use perception::{
    Classifying, ClassifyingConfig, CodeClassifier, Deployed, ModelLimits, ModelState, NotCodes,
    Perception, Refusal, Sample, SampleClassifier, TakesRule, shifts,
};
pub use queue::Queue;
pub use record::{NotArmed, RECORD_WORDS, RESET_WINDOW_S, RESETS, Record, StartCause, Startup};
pub use sensing::{BAD_WEIGHT, Reading, Sensor, SensorHealth, SensorLimits, Zeroed};
pub use servo::{FAULTS, Retry, Servo, ServoConfig, ServoState};
pub use signals::Signals;
pub use telemetry::{About, Link, Notes, PacketSink, PacketSlot, may_load};
#[cfg(feature = "tmag5170")]
pub use tilt::{TiltScale, TiltSource};
pub use timing::Timing;
pub use tunable::{TUNABLE_COUNT, Tunable, Visitor, number as tunable_number, tunable_name};
pub use tuning::Tuning;
pub use zero::{Zero, ZeroLimits};
