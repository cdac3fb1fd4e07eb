//! The scene file: what a module is and what happens to it.
//!
//! A scene is one TOML file. The simulator runs it on a PC and the firmware
//! build takes the same file for a board; this crate is the only reader, so
//! both mean the same by it. What a scene does not name is left out.
//!
//! - **section**: a TOML table of the file, such as `[whisking]`; the keys
//!   above the first table form the top section.
//! - **catalogue**: the one list of all sections and keys, with type, range,
//!   unit, default and meaning (`src/sections`). The structs of a [`Scene`], the
//!   reader and the reference page ([`reference()`]) are all written from it.
//! - **problem**: one thing wrong with a file, with its line, its key, what was
//!   found and what is allowed. A file is read to its end, so that
//!   [`Problems`] holds all of them.
//! - **RCP**: rapid cessation of protraction, the gate that contact closes.
//! - **CIA**: contact-induced asymmetry, the excitation of all whiskers by
//!   contact.
//!
//! ```
//! let text = "
//!     name = 'still'
//!     tick_hz = 2000
//!     duration_s = 1
//!     seed = 1
//!     head.whiskers_per_side = 13
//!     plant.kind = 'ideal'
//! ";
//! let problems = scene::Scene::from_str("still.toml", text).unwrap_err();
//! assert_eq!(
//!     problems.to_string(),
//!     "still.toml:6: head.whiskers_per_side: found 13; \
//!      allowed: a whole number from 1 to 12"
//! );
//! ```

mod choice;
mod facts;
pub mod file;
mod key;
mod keys;
mod kind;
mod load;
mod overriding;
mod places;
mod presence;
mod problem;
mod read;
mod reference;
mod rules;
mod section;
mod sections;
mod suggest;
mod table;
mod text;
mod value;
mod values;
mod world;

pub use choice::Choice;
pub use facts::{KeyFacts, key_facts};
pub use overriding::Override;
pub use places::Places;
pub use problem::{Problem, Problems};
pub use reference::reference;
pub use sections::{
    Arm, ClassifierSection, Exchanged, FacingChoice, HeadSection, MotorSection, Numbers, Obstacles,
    OnFault, OwnSurfaces, PlantKind, PlantSection, PoseSpread, Presentation, Rest, Rule, Scene,
    SensorMode, SensorModel, SensorSection, ShaftChoice, ShaftName, ShaftNumbers, Sides,
    TelemetrySection, Texture, WhiskingSection,
};
pub use tactile::Deciding;
pub use whisking::motor::Driver;
pub use whisking::{GateSettings, Integrator};
