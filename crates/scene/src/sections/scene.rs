//! A whole scene: the keys at the top of the file, and its tables.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use whisking::{GateSettings, ranges};

use super::classifier::ClassifierSection;
use super::gates::{Cia, Rcp};
use super::head::HeadSection;
use super::motor::MotorSection;
use super::plant::PlantSection;
use super::sensor::SensorSection;
use super::telemetry::TelemetrySection;
use super::whisking::WhiskingSection;
use crate::key::{integer, name, positive};
use crate::keys::keys;
use crate::table::{by_default, implied, optional, or_default, required};

/// Tick rates of the module, all whole.
const TICK_HZ: RangeInclusive<u64> =
    *ranges::TICK_HZ.start() as u64..=*ranges::TICK_HZ.end() as u64;

keys! {
    /// One scene, complete and in range: every number is finite and in the
    /// range of its key, every list has the length that the head asks for.
    ///
    /// It is made by [`Scene::from_str`] or [`Scene::load`].
    pub struct Scene {
        /// Name of the scene; output files are called after it.
        name: String = name(64),

        /// Control and sampling rate.
        tick_hz: u32 = integer(TICK_HZ).unit("Hz"),

        /// Length of the run; at least one tick.
        duration_s: f64 = positive(1e5).unit("s"),

        /// Source of all randomness: the same seed gives the same bytes.
        seed: u64 = integer(0..=i64::MAX as u64),

        /// The array of whiskers.
        [head]: HeadSection = required::<HeadSection>(),

        /// How the whiskers' sensors are read, and what their readings cannot do.
        [sensor]: SensorSection = by_default::<SensorSection>("the defaults below hold"),

        /// Active whisking: oscillators, their coupling, and muscle (BIOTACT section III).
        [whisking]: Option<WhiskingSection> = optional::<WhiskingSection>(
            "the whiskers are passive: no oscillator, muscle, motor or position control"
        ),

        /// Rapid cessation of protraction: contact takes drive from its own side (BIOTACT eq. 10).
        [rcp]: Option<GateSettings> = optional::<Rcp>(
            "contact does not gate the drive (no rapid cessation of protraction)"
        ).needs("whisking"),

        /// Contact-induced asymmetry: contact on either side excites the whiskers of both (BIOTACT
        /// eqs 12 and 13); with `[rcp]`, which takes drive from its own side, the other side's
        /// protract more.
        [cia]: Option<GateSettings> = optional::<Cia>(
            "contact excites no whisker (no contact-induced asymmetry)"
        ).needs("whisking"),

        /// Motor, gear, encoder and position control.
        [motor]: Option<MotorSection> = implied::<MotorSection>(
            "whisking", "where there is `[whisking]`, the defaults below hold"
        ),

        /// What a module reports to a PC in every tick, and what the PC may ask for.
        [telemetry]: TelemetrySection = by_default::<TelemetrySection>("the default below holds"),

        /// What the whiskers meet in a simulation; a board meets what there is.
        [plant]: PlantSection = or_default::<PlantSection>(
            "simulated motors and whiskers in free air, unless `--world` says what they meet"
        ),

        /// Texture perception by naive Bayes (LEP10, LEP12).
        /// The threshold may stand beside the window: the rule says which is used.
        [classifier]: Option<ClassifierSection> = optional::<ClassifierSection>(
            "no perception: nothing is classified"
        ),
    }
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
    /// from the current directory. `None` where it names none.
    pub fn model_path(&self, scene_dir: &Path) -> Option<PathBuf> {
        let classifier = self.classifier.as_ref()?;
        let model = classifier.model.as_ref()?;
        let beside = scene_dir.join(model);
        Some(if beside.exists() {
            beside
        } else {
            PathBuf::from(model)
        })
    }

    /// Whether it has a classifier whose model is deployed apart from its program.
    pub fn awaits_model(&self) -> bool {
        let classifier = self.classifier.as_ref();
        classifier.is_some_and(|classifier| classifier.model.is_none())
    }
}
