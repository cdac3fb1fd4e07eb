//! What a scene says, once it has been read and found to be in order.
//!
//! Every value here is finite and inside the range that the catalogue states
//! for its key; lists have the lengths that the head asks for.

use std::path::{Path, PathBuf};

use crate::choice::choice;

mod shaft;

pub use shaft::{Shaft, ShaftName, ShaftNumbers};

choice! {
    /// Which sides of the head are built.
    Sides {
        /// Left and right.
        Both = "both",
        /// Only the left half of the array.
        Left = "left",
    }
}

impl Sides {
    /// How many sides are built: 2 or 1.
    pub const fn count(self) -> usize {
        match self {
            Self::Both => 2,
            Self::Left => 1,
        }
    }
}

choice! {
    /// How the oscillators and the muscle are stepped in time.
    Integrator {
        /// The accurate integrator, which keeps to the limit cycle.
        Exact = "exact",
        /// Forward Euler, step for step as in BIOTACT (Sullivan et al. 2011).
        Euler = "euler",
    }
}

choice! {
    /// The stage that turns a duty into winding currents.
    Driver {
        /// One H-bridge: a brushed motor.
        HBridge = "h-bridge",
        /// Three half-bridges commutated in six steps: a brushless motor.
        SixStep = "six-step",
    }
}

choice! {
    /// What stands between the motor command and the sensor.
    PlantKind {
        /// The angle is θ′ exactly; contact follows BIOTACT eq. 11.
        Ideal = "ideal",
        /// Simulated motor, whisker and textured surfaces.
        Textured = "textured",
        /// The same with an elastic shaft that sticks, slips and bounces.
        Whisker = "whisker",
    }
}

impl PlantKind {
    /// Whether surfaces with textures are presented.
    pub const fn has_textures(self) -> bool {
        matches!(self, Self::Textured | Self::Whisker)
    }
}

choice! {
    /// Number format in which the tick is simulated.
    Numbers {
        /// `f64` for Euler, whose point is to be the papers', `f32` for exact.
        Auto = "auto",
        /// Single precision, as on a board with an FPU.
        Single = "f32",
        /// Double precision, the reference.
        Double = "f64",
        /// 32-bit fixed point, as on a board without FPU.
        Fixed = "fixed",
    }
}

choice! {
    /// A surface that a whisker is swept over, named after its material or grit.
    Texture {
        /// A smooth surface.
        Smooth = "smooth",
        /// P600 sandpaper, fine.
        P600 = "p600",
        /// P240 sandpaper, coarser.
        P240 = "p240",
        /// Carpet.
        Carpet = "carpet",
    }
}

/// One scene, complete and in range.
///
/// It is made by [`Scene::from_str`] or [`Scene::load`].
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name, safe in file names: 1 to 64 of `A–Z a–z 0–9 - _ .`, not only dots.
    pub name: String,
    /// Control and sampling rate in hertz, 200 to 20000.
    pub tick_hz: u32,
    /// Length of the run in seconds, above 0 and at most 1e5; at least one tick.
    pub duration_s: f64,
    /// Source of all randomness, 0 to 2⁶³ − 1.
    pub seed: u64,
    /// The array of whiskers.
    pub head: Head,
    /// Active whisking; `None`: passive whiskers.
    pub whisking: Option<Whisking>,
    /// Rapid cessation of protraction; `None`: contact gates nothing.
    pub rcp: Option<Gate>,
    /// Contact-induced asymmetry; `None`: the sides have their own drive.
    pub cia: Option<Gate>,
    /// Motor and position control. It is there exactly when `whisking` is.
    pub motor: Option<Motor>,
    /// What the whiskers meet.
    pub plant: Plant,
    /// Perception; `None`: nothing is classified.
    pub classifier: Option<Classifier>,
}

impl Scene {
    /// Ticks in the run: `duration_s · tick_hz`, rounded to the nearest; 1 to 2e9.
    pub fn ticks(&self) -> u64 {
        // The ranges of both factors keep the product far below 2^53.
        (self.duration_s * f64::from(self.tick_hz)).round() as u64
    }

    /// Number of whiskers in the head, 1 to 24.
    pub fn whiskers(&self) -> usize {
        self.head.sides.count() * self.head.whiskers_per_side
    }

    /// Where the likelihood model is: beside the scene, in `scene_dir`, when
    /// something exists there under its name, else as it was written, that is,
    /// from the current directory. `None` without a classifier.
    pub fn model_path(&self, scene_dir: &Path) -> Option<PathBuf> {
        let classifier = self.classifier.as_ref()?;
        let beside = scene_dir.join(&classifier.model);
        Some(if beside.exists() {
            beside
        } else {
            PathBuf::from(&classifier.model)
        })
    }
}

/// The array of whiskers.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// Whiskers on each side, 1 to 12.
    pub whiskers_per_side: usize,
    /// Which sides are built.
    pub sides: Sides,
}

/// Active whisking: oscillators, coupling and muscle (BIOTACT eqs 2 to 9).
#[derive(Debug, Clone, PartialEq)]
pub struct Whisking {
    /// Whisk frequency f_W in hertz, 0.05 to 25.
    pub frequency_hz: f64,
    /// How the model is stepped.
    pub integrator: Integrator,
    /// Whether the sides' oscillators are coupled (BIOTACT eq. 4).
    pub coupling: bool,
    /// Standard deviation σ_η of the oscillator noise, 0 to 1.
    pub noise: f64,
    /// Nominal gain of each whisker, 0 to 2, left side first: one a whisker,
    /// also where the file gives one number for all.
    pub gain: Vec<f64>,
    /// Oscillator state ψ = [ψ₁, ψ₂] at the start, left first: one a side,
    /// each component within ±1.5.
    pub start: Vec<[f64; 2]>,
    /// Number format of the simulated tick, never [`Numbers::Auto`].
    pub numbers: Numbers,
    /// Number format as the file has it, for a board, whose [`Numbers::Auto`]
    /// is another: `f32` with an FPU, else fixed point.
    pub numbers_said: Numbers,
}

/// A contact-driven gate: a gain on contact and an exponential recovery.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gate {
    /// σ_z of RCP (BIOTACT eq. 10) or σ_g of CIA (eq. 12), 0 to 100.
    pub gain: f64,
    /// Time constant of the recovery in seconds, τ_z or τ_g, 1e-6 to 1e5.
    pub tau_s: f64,
}

/// Motor, gear, encoder and the proportional-derivative position control.
#[derive(Debug, Clone, PartialEq)]
pub struct Motor {
    /// Power stage.
    pub driver: Driver,
    /// Proportional gain in duty per degree, 0 to 10.
    pub kp: f64,
    /// Derivative gain in duty per degree a second, 0 to 1.
    pub kd: f64,
    /// Largest magnitude of the duty, 0 to 1.
    pub duty_limit: f64,
    /// Fastest change of the duty, a second; above 0 and at most 1e5.
    pub slew_per_s: f64,
    /// Lower limit of the setpoint in degrees, −360 to 360.
    pub min_deg: f64,
    /// Upper limit of the setpoint in degrees, above `min_deg`, at most 360.
    pub max_deg: f64,
    /// Motor revolutions per whisker revolution, 1 to 1000.
    pub gear: f64,
    /// Encoder counts per motor revolution, 4 to 65536.
    pub counts_per_rev: u32,
}

/// What the whiskers meet.
#[derive(Debug, Clone, PartialEq)]
pub struct Plant {
    /// Whether the physics is ideal or simulated.
    pub kind: PlantKind,
    /// Obstacles; `None`: free whisking. Always there for surfaces with textures.
    pub obstacle: Option<Obstacle>,
    /// Surfaces; there exactly when [`PlantKind::has_textures`].
    pub textured: Option<Textured>,
    /// The shaft; there exactly when `kind` is [`PlantKind::Whisker`].
    pub shaft: Option<Shaft>,
}

/// An obstacle on each side.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Angle of each obstacle in degrees, ±360, left first: one a side.
    pub deg: Vec<f64>,
    /// Stiffness σ_x per degree of overlap (BIOTACT eq. 11), 0 to 100.
    pub stiffness: f64,
}

/// Textured surfaces, presented one after another.
#[derive(Debug, Clone, PartialEq)]
pub struct Textured {
    /// Surfaces in order of presentation: at least one, all distinct.
    pub textures: Vec<Texture>,
    /// How long each is presented, in seconds: at least one tick, at most 1e5.
    pub present_s: f64,
}

/// Perception: which model, and when its evidence becomes a decision.
#[derive(Debug, Clone, PartialEq)]
pub struct Classifier {
    /// When a decision falls.
    pub rule: Rule,
    /// Path of the likelihood model as written; see [`Scene::model_path`].
    pub model: String,
    /// Samples with a contact signal below this, 0 to 1, are not classified;
    /// `None`: all are.
    pub contact_min: Option<f64>,
}

/// When a decision falls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// As soon as a posterior exceeds the threshold (LEP12, Lepora et al. 2012).
    Sequential {
        /// Posterior probability, strictly between 0 and 1.
        threshold: f64,
    },
    /// Maximum likelihood over fixed windows (LEP10, Lepora et al. 2010).
    Window {
        /// Samples in a window, 1 to 1e6.
        samples: u32,
    },
}

impl Rule {
    /// The words that a scene file may use.
    pub const NAMES: &'static [&'static str] = &[Self::SEQUENTIAL, Self::WINDOW];
    pub(crate) const SEQUENTIAL: &'static str = "sequential";
    pub(crate) const WINDOW: &'static str = "window";
}
