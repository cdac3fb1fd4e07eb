//! Whiskers as elastic bodies before textured plates.
//!
//! Glossary:
//!
//! - *shaft*: the whisker itself, a tapered beam; *follicle*: what holds its
//!   base, a spring;
//! - *mode*: a shape in which the shaft rings at one frequency;
//! - *plate*: a flat, textured surface; *relief*: its heights;
//! - *sensor*: a magnet that turns with the base, and a Hall sensor.
//!
//! A [`Shaft`] has [`Modes`]; a [`TouchingWhisker`] is carried along poses
//! ([`Pose`]) before a [`Plate`] of some [`Surface`] and says what its sensor
//! reads. Closed forms are met within 1 % (see the tests), contact never
//! creates energy.

mod beam;
mod compliance;
mod contact;
mod error;
mod modal;
mod noise;
mod pose;
mod relief;
mod resonator;
mod sensor;
mod shaft;
mod surface;
mod swing;
mod touching;
pub mod vector;
mod whiskers;

pub use beam::{BendingMode, Modes};
pub use error::BadSetting;
pub use noise::{Noise, box_muller};
pub use pose::{Plate, Pose};
pub use resonator::{Propagator, Resonator};
pub use sensor::{SensorSettings, sensor_code};
pub use shaft::{Follicle, Shaft};
pub use surface::{Grit, Material, Surface};
pub use swing::Facing;
pub use touching::TouchingWhisker;
pub use whiskers::Biotact;
