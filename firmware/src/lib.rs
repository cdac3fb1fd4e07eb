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
//!   feels nothing. Whether the others go on is the scene's choice
//!   ([`MotionConfig::stops_all`]).
//! - *limit*: something out of the ordinary while the module still runs. Both are listed in
//!   [`faults`].
//! - *armed*: motors may be driven; a module that is not armed computes on.
//! - *event*: what a tick reports; queued, and logged elsewhere.
//! - *servo*: a whisker's motor, angle input and position control.
//! - *link*: to a PC, by the records, requests and answers of the crate `wire`.
//!
//! # Composition
//!
//! A [`Module`] is generic over its number format and its [`Hardware`], nothing else. All else
//! is data: one [`Config`], which a scene comes to, which is checked once, and which each tick
//! reads. What a scene leaves out is `None` there, and is not computed; what an image is built
//! without ([`Part`]) is not linked. Between ticks a [`Command`] changes a whisker's gain or
//! setpoint, and another configuration may take the place of the first ([`take_over`]).
#![cfg_attr(not(test), no_std)]

pub mod boards;
mod button;
mod config;
pub mod design_parameters;
mod event;
pub mod faults;
mod io;
pub mod lines;
mod module;
mod motion;
#[cfg(feature = "bus")]
mod node;
mod numbered;
mod packet;
mod perception;
mod record;
mod relay;
mod self_test;
mod sensing;
mod servo;
mod telemetry;
#[cfg(feature = "tmag5170")]
mod tilt;
mod timing;
mod tuning;
mod zero;

pub use button::{Button, ButtonLimits};
pub use config::{
    BoardCode, BusConfig, CONFIG_BYTES, Config, ConfigBytes, ConfigError, Field, HEADER_BYTES,
    HeadConfig, Header, Links, MotionConfig, NAME_BYTES, OVERRIDES_BYTES, Part, SensingConfig,
    SensorKind, VERSION, allowed, decode, decode_into, encode,
};
#[cfg(feature = "tmag5170")]
pub use event::TiltFault;
pub use event::{Event, Health, NodeEvent, Place, SensorFault};
pub use io::{AngleInput, BusError, Clock, FrameSource, Polled, WordSource};
pub use module::{Hardware, Module, Whisker, WhiskerParts};
pub use motion::{Command, Motion, NoActiveWhisker, NotDone};
#[cfg(feature = "bus")]
pub use node::Node;
pub use packet::{EventRecord, Packet};
pub use perception::{
    ClassifierConfig, CodeClassifier, ModelLimits, ModelState, NotCodes, Perception, Refusal,
    Sample, SampleClassifier,
};
pub use record::{
    NotArmed, RECORD_WORDS, RESET_WINDOW_S, RESETS, Record, StartCause, Started, Startup,
};
pub use relay::{Frames, Heard, RELAYED_HZ, Relay};
pub use self_test::{READINGS, SelfTest};
pub use sensing::{BAD_WEIGHT, Reading, Sensor, SensorHealth, SensorLimits, SwingLimits};
pub use servo::{FAULTS, HELD, MotorRecord, Retry, Servo, ServoConfig, ServoState, TooManyFaults};
pub use telemetry::{About, Link, letters, may_load};
#[cfg(feature = "tmag5170")]
pub use tilt::{FULL_SCALE, TiltScale, TiltSource};
pub use timing::Timing;
pub use tuning::{Prepared, Tuning, answer, applied, refusal_code, refusal_of, take_over};
pub use whisking::motor::Driver;
pub use zero::{Zero, ZeroLimits};
