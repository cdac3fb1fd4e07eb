//! `host-sim train`: recordings to a model.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use tactile::train::joint::{self, JointModel};
use tactile::train::{Options, TrainError, Trainer};
use tactile::{ModelBuf, ModelError};

use super::channels;
use crate::Error;
use crate::files;
use crate::output::write_whole;
use crate::recording::{GATE, Stream};
use crate::report::TrainingReport;
use crate::training;

/// What to train from, and how.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The recording: label,trial,x,y, and contact where samples are of the air too; given
    /// several times, each is held out to tell what is to be expected of another one
    #[arg(long, value_name = "FILE.csv", required = true)]
    pub data: Vec<PathBuf>,
    /// Two other columns in place of x,y
    #[arg(long, value_name = "A,B", default_value = "x,y", value_parser = channels)]
    pub channels: [String; 2],
    /// Where to write the model
    #[arg(long, value_name = "MODEL")]
    pub out: PathBuf,
    /// Samples a second of the recording
    #[arg(long, value_name = "HZ", default_value_t = 2000)]
    pub rate: u32,
    #[command(flatten)]
    /// By what tables, and how.
    pub how: How,
}

/// What a model is made of.
#[derive(Debug, Clone, Copy, Args)]
pub struct How {
    /// Which tables
    #[arg(long, value_enum, default_value_t = Tables::Joint)]
    pub tables: Tables,
    /// Bins over each channel's range [default: 32; of single tables 100]
    #[arg(long)]
    pub bins: Option<usize>,
    /// Standard deviation of the smoothing, in bins; 0: none [default: 0.7; of single
    /// tables 5]
    #[arg(long)]
    pub smooth: Option<f64>,
    /// Samples of a block, after each of which a decision may fall
    #[arg(long, default_value_t = 20)]
    pub block: u32,
}

/// The tables of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Tables {
    /// Of both channels together and of their roughness, weighted so that a posterior is
    /// what it says; only contact counts, a touch limits what came before it, and what
    /// is like no class is unknown
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
    pub const fn of(tables: Tables) -> Self {
        Self {
            tables,
            bins: None,
            smooth: None,
            block: 20,
        }
    }

    /// Trains from recordings of `tick_hz` samples a second.
    ///
    /// # Errors
    /// What the trainer refuses.
    pub fn train(
        &self,
        recordings: &[(String, Vec<Stream>)],
        tick_hz: u32,
    ) -> Result<TrainedModel, TrainError> {
        match self.tables {
            Tables::Joint => {
                let default = joint::Options::default();
                let options = joint::Options {
                    bins: self.bins.unwrap_or(default.bins),
                    smooth: self.smooth.unwrap_or(default.smooth),
                    block: self.block,
                    gap: (GAP_S * f64::from(tick_hz)).round() as u32,
                    ..default
                };
                let joint = training::joint(recordings, &options)?;
                Ok(TrainedModel {
                    model: joint.model()?,
                    joint: Some(joint),
                })
            }
            Tables::Single => {
                let default = Options::default();
                let options = Options {
                    bins: self.bins.unwrap_or(default.bins),
                    smooth: self.smooth.unwrap_or(default.smooth),
                    block: self.block,
                };
                let streams = recordings.iter().flat_map(|(_, streams)| streams);
                let model = training::single(Trainer::new(2, options)?, streams)?;
                Ok(TrainedModel { model, joint: None })
            }
        }
    }
}

/// After how long without contact another touch begins, s.
const GAP_S: f64 = 0.1;

/// Trains a model from recordings and writes it. Returns what it was made of, and what
/// it is worth.
///
/// # Errors
/// [`Error::Input`] for a recording or an option that is wrong, [`Error::Write`].
pub fn train(arguments: &Arguments) -> Result<String, Error> {
    let Arguments {
        data,
        channels,
        out,
        rate,
        how,
    } = arguments;
    let recordings = read(data, channels)?;
    let trained = how
        .train(&recordings, *rate)
        .map_err(|error| refusal(data, &error))?;
    write_whole(out, trained.model.as_bytes())?;
    let streams = || recordings.iter().flat_map(|(_, streams)| streams);
    let counts = streams().flat_map(|stream| stream.counts(GATE));
    let samples = counts.filter(|counts| *counts).count();
    let told = format!(
        "{}: {samples} samples in {} streams, {} bytes",
        out.display(),
        streams().count(),
        trained.model.as_bytes().len()
    );
    Ok(match &trained.joint {
        Some(joint) => format!("{told}\n\n{}", TrainingReport(joint)),
        None => told,
    })
}

/// Recordings, each with its name.
fn read(data: &[PathBuf], channels: &[String; 2]) -> Result<Vec<(String, Vec<Stream>)>, Error> {
    let channels = channels.each_ref().map(String::as_str);
    let read = |path: &PathBuf| {
        let streams = files::read_recording(path, channels)?;
        Ok((path.display().to_string(), streams))
    };
    data.iter().map(read).collect()
}

/// What is wrong: an option, or the data.
fn refusal(data: &[PathBuf], error: &TrainError) -> Error {
    let option = match error {
        TrainError::Smooth(_) | TrainError::Option { name: "smooth", .. } => "--smooth",
        TrainError::Model(ModelError::Bins(_)) | TrainError::Option { name: "bins", .. } => {
            "--bins"
        }
        TrainError::Model(ModelError::Block(_) | ModelError::BlockTimesChannels(_))
        | TrainError::Option { name: "block", .. } => "--block",
        _ => {
            let first = data.first().map_or(Path::new(""), PathBuf::as_path);
            return Error::file(first, error);
        }
    };
    Error::Input(format!("{option}: {error}"))
}
