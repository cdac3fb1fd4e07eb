//! Training a model from recordings.

use scene::Scene;
pub use tactile::train::Expect as Expected;
use tactile::train::joint::{self, JointModel, Trial};
use tactile::train::{Options, TrainError, Trainer};
use tactile::{ModelBuf, Whisked};

use crate::doubts::outliers;
use crate::recording::{GATE, Stream};

/// What a model is made of.
#[derive(Debug, Clone, Copy, Default)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct How {
    /// Which tables
    #[cfg_attr(feature = "cli", arg(long, value_enum, default_value_t = Tables::Joint))]
    pub tables: Tables,
    /// Bins over each channel's range [default: 24; of single tables 100]
    #[cfg_attr(feature = "cli", arg(long))]
    pub bins: Option<usize>,
    /// Standard deviation of the smoothing, in bins; 0: none [default: 0.7; of single tables 5]
    #[cfg_attr(feature = "cli", arg(long))]
    pub smooth: Option<f64>,
    /// Samples of a block, after each of which a decision may fall [default: 40; of single
    /// tables 20]
    #[cfg_attr(feature = "cli", arg(long))]
    pub block: Option<u32>,
    /// Contact from which a sample counts, 0 to 1 [default: as the scene says, or 0.05];
    /// joint tables keep it, and the module gates by it
    #[cfg_attr(feature = "cli", arg(long, value_name = "PI"))]
    pub gate: Option<f64>,
    /// Seconds without contact after which a touch has ended, of joint tables: above 0, up
    /// to 10 [default: 0.1]
    #[cfg_attr(feature = "cli", arg(long, value_name = "S"))]
    pub gap: Option<f64>,
    /// Tables of their own for each whisker of the recording, of single tables: the model is for
    /// as many whiskers that decide
    #[cfg_attr(feature = "cli", arg(long))]
    pub each_whisker: bool,
    /// How much may differ between training and use, of joint tables
    #[cfg_attr(feature = "cli", arg(long, value_parser = expected(), default_value = "bench"))]
    pub expect: Expected,
    /// How it was whisked, which the model keeps.
    #[cfg_attr(feature = "cli", arg(skip))]
    pub whisked: Whisked,
}

/// How much may differ between training and use: its words, and what they mean to a user.
pub const EXPECTED: [(&str, Expected, &str); 3] = [
    (
        "same",
        Expected::Same,
        "Nothing: what is stated holds in the pose of training only",
    ),
    (
        "bench",
        Expected::Bench,
        "What a hand on a bench makes: some degrees of tilt and place, a fifth of scale",
    ),
    (
        "other",
        Expected::Other,
        "Another mounting: half to twice of scale",
    ),
];

#[cfg(feature = "cli")]
fn expected() -> impl clap::builder::TypedValueParser<Value = Expected> {
    use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

    let values = EXPECTED.map(|(word, _, help)| PossibleValue::new(word).help(help));
    PossibleValuesParser::new(values).map(|found| {
        let meant = EXPECTED.iter().find(|(word, ..)| *word == found);
        meant.map_or_else(Expected::default, |(_, meant, _)| *meant)
    })
}

/// The tables of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Tables {
    /// Of both channels together and of their roughness, weighted so that a posterior is
    /// what it says; only contact counts, a touch limits what came before it, and what
    /// is like no class is unknown
    #[default]
    Joint,
    /// Of each channel alone, as the papers have it
    Single,
}

/// A trained model.
#[derive(Debug)]
pub struct TrainedModel {
    /// The model.
    pub model: ModelBuf,
    /// How it was made, and its report; none of single tables.
    pub joint: Option<JointModel>,
}

impl How {
    /// With the defaults of these tables.
    pub fn of(tables: Tables) -> Self {
        let usual = Self::default();
        Self { tables, ..usual }
    }

    /// The same for recordings of `scene`: it says how was whisked, and from what contact on
    /// samples count, unless that is said already.
    #[must_use]
    pub fn like(self, scene: &Scene) -> Self {
        let contact_min = scene.classifier.as_ref().and_then(|c| c.contact_min);
        Self {
            gate: self.gate.or(contact_min),
            whisked: config::whisked(scene),
            ..self
        }
    }

    /// Contact from which a sample counts.
    pub fn least(&self) -> f64 {
        self.gate.unwrap_or(GATE)
    }

    /// Whether gate and gap are in their ranges, and of use to these tables.
    ///
    /// # Errors
    /// Names the setting, what was found and what is allowed.
    pub fn check(&self) -> Result<(), String> {
        let (gate, gap) = (self.least(), self.gap.unwrap_or(GAP_S));
        // Not a number is outside, too.
        if !(0.0..=1.0).contains(&gate) {
            return Err(format!("gate: found {gate}, allowed: 0 to 1"));
        }
        if !(gap > 0.0 && gap <= 10.0) {
            return Err(format!("gap: found {gap}, allowed: above 0, up to 10 s"));
        }
        let fault = match self.tables {
            Tables::Joint if self.each_whisker => {
                "each-whisker: joint tables are one set; allowed: with single tables"
            }
            Tables::Single if self.gap.is_some() => {
                "gap: single tables know no touches; allowed: with joint tables"
            }
            Tables::Single if self.expect == Expected::Other => {
                "expect: single tables hold in the pose of training; allowed: with joint tables"
            }
            _ => return Ok(()),
        };
        Err(fault.to_owned())
    }

    /// Trains from recordings of `tick_hz` samples a second, which the model keeps. A value that
    /// stands apart from all others counts as the nearest that does not: one must not make the
    /// scale.
    ///
    /// # Errors
    /// What the trainer refuses.
    pub fn train(
        &self,
        recordings: &[(String, Vec<Stream>)],
        tick_hz: u32,
    ) -> Result<TrainedModel, TrainError> {
        let tamed = outliers::tamed(recordings);
        let recordings = tamed.as_deref().unwrap_or(recordings);
        match self.tables {
            Tables::Joint => {
                let default = joint::Options::default();
                let gap = self.gap.unwrap_or(GAP_S) * f64::from(tick_hz);
                let options = joint::Options {
                    bins: self.bins.unwrap_or(default.bins),
                    smooth: self.smooth.unwrap_or(default.smooth),
                    block: self.block.unwrap_or(default.block),
                    gate: self.least(),
                    gap: (gap.round() as u32).max(1),
                    expect: self.expect,
                    whisked: self.whisked,
                };
                let joint = joint(recordings, &options)?;
                let model = joint.model()?.at_rate(tick_hz);
                let joint = Some(joint);
                Ok(TrainedModel { model, joint })
            }
            Tables::Single => {
                let default = Options::default();
                let options = Options {
                    bins: self.bins.unwrap_or(default.bins),
                    smooth: self.smooth.unwrap_or(default.smooth),
                    block: self.block.unwrap_or(default.block),
                };
                let streams = || recordings.iter().flat_map(|(_, streams)| streams);
                let whiskers = streams().map(Stream::whisker).max();
                let whiskers = whiskers.filter(|_| self.each_whisker).unwrap_or(1);
                let trainer = Trainer::new(2 * whiskers, options)?;
                let model = single(trainer, streams(), self.least(), whiskers > 1)?;
                let (model, joint) = (model.at_rate(tick_hz), None);
                Ok(TrainedModel { model, joint })
            }
        }
    }
}

/// After how long without contact another touch begins, s.
const GAP_S: f64 = 0.1;

/// The papers' model of `streams`, of the samples whose contact is at least `gate`; classes
/// in the order in which they first appear. Each whisker has tables of its own (BIOTACT eq. 15),
/// or all have one set.
pub(crate) fn single<'s>(
    mut trainer: Trainer,
    streams: impl IntoIterator<Item = &'s Stream>,
    gate: f64,
    each_whisker: bool,
) -> Result<ModelBuf, TrainError> {
    for stream in streams {
        let whisker = if each_whisker { stream.whisker() } else { 1 };
        let samples = stream.samples.iter().zip(stream.counts(gate));
        for (sample, _) in samples.filter(|(_, counts)| *counts) {
            trainer.add_from(&stream.label, 2 * (whisker - 1), sample)?;
        }
    }
    trainer.train()
}

/// The joint model of recordings, each with its name; a stream is a trial.
///
/// # Errors
/// What the trainer refuses.
pub fn joint(
    recordings: &[(String, Vec<Stream>)],
    options: &joint::Options,
) -> Result<JointModel, TrainError> {
    let trials = recordings.iter().flat_map(|(recording, streams)| {
        streams.iter().map(|stream| Trial {
            label: stream.label.clone(),
            recording: recording.clone(),
            pose: stream.pose.clone(),
            stands: stream.stands,
            samples: stream.samples.clone(),
            touches: stream.touches(options.gate, options.gap).collect(),
        })
    });
    joint::train(&trials.collect::<Vec<_>>(), options)
}
