//! Whiskers as elastic bodies before textured plates.
//!
//! Glossary:
//!
//! - *shaft*: the whisker itself, a tapered beam; *follicle*: what holds its
//!   base, a spring;
//! - *mode*: a shape in which the shaft rings at one frequency;
//! - *pose*: position and axes of the base, which the caller moves;
//! - *plate*: a flat, textured surface, which may end, or a bar; *relief*: its heights;
//! - *sensor*: a magnet that turns with the base, and a Hall sensor.
//!
//! A [`Shaft`] has [`Modes`]; a [`TouchingWhisker`] is moved along poses
//! ([`Pose`]) before a [`Plate`] with some [`Surface`] and gives what its sensor
//! reads. Closed forms are met within 1 % (see the tests), contact never
//! creates energy. The same settings and seeds give the same bits on every
//! machine.
//! How a shaft bends that is pressed slowly and far, [`elastica`] solves exactly.
//!
//! A whisker that is swung against sandpaper:
//!
//! ```
//! use physics::{
//!     Biotact, Facing, Grit, Material, Plate, Pose, SensorSettings, Shaft, Surface,
//!     TouchingWhisker,
//! };
//!
//! let shaft = Shaft::biotact(Biotact::Middle);
//! let mut whisker = TouchingWhisker::new(&shaft, &SensorSettings::default(), 1)?;
//! // The straight tip would touch at an angle of 1.7 rad.
//! let surface = Surface::of(Material::Sandpaper(Grit::P240));
//! let plate = Plate::in_the_way(1.7, shaft.length_m, &Facing::USUAL, surface);
//! // 5 rad/s for 0.1 s at 2 kHz, from 0.25 rad before the plate to 0.25 rad beyond.
//! for tick in 0..200 {
//!     let pose = Pose::swung(1.45 + 5.0 * 5e-4 * f64::from(tick));
//!     whisker.step(&pose, Some(&plate), 5e-4);
//! }
//! assert!(whisker.contact());
//! let [normal_n, tangential_n] = whisker.force_n();
//! assert!(normal_n > 0.0 && tangential_n > 0.0);
//! // The sensor reads an obstacle in the way of protraction as positive x.
//! assert!(whisker.reading()[0] > 0.0);
//! # Ok::<(), physics::BadSetting>(())
//! ```

mod beam;
mod compliance;
mod contact;
pub mod elastica;
mod error;
mod grid;
mod magnet;
mod modal;
mod noise;
mod outline;
mod pose;
mod relief;
mod resonator;
mod sensor;
mod shaft;
mod shapes;
mod surface;
mod swing;
mod touching;
pub mod vector;
mod whiskers;

pub use beam::{BendingMode, Modes};
pub use error::BadSetting;
pub use magnet::Magnet;
pub use noise::{Noise, box_muller};
pub use outline::Outline;
pub use pose::{Plate, Pose};
pub use resonator::{Propagator, Resonator};
pub use sensor::{SensorSettings, sensor_code};
pub use shaft::{Follicle, Shaft};
pub use surface::{Grit, Material, Surface};
pub use swing::Facing;
pub use touching::{At, Bent, TOUCHING_TAPER, TouchingWhisker};
pub use whiskers::Biotact;
