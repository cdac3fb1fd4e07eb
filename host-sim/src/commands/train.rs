//! `host-sim train`: recordings to a model.

use std::path::{Path, PathBuf};

use clap::Args;
use scene::Scene;
use tactile::ModelError;
use tactile::train::TrainError;

use super::{channels, picture};
use crate::Error;
use crate::decisions::UNKNOWN;
use crate::files;
use crate::output::{self, Output, write_whole};
use crate::plot;
use crate::recording::Stream;
use crate::report::TrainingReport;
use crate::training::{How, Tables};

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
    /// Samples a second of the recording; the model is to be used at the same rate
    #[arg(long, value_name = "HZ", default_value_t = 2000)]
    pub rate: u32,
    /// A label that is left out: the model does not know it
    #[arg(long, value_name = "LABEL")]
    pub unknown: Option<String>,
    /// The scene whose module was recorded: the model keeps how it whisks, and is refused by one
    /// that whisks otherwise
    #[arg(long, value_name = "SCENE.toml")]
    pub scene: Option<PathBuf>,
    /// Where to write a picture of the calibration of joint tables: stated against found
    #[arg(long, value_name = "FILE.svg", value_parser = picture)]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    /// By what tables, and how.
    pub how: How,
}

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
        unknown,
        scene,
        plot,
        how,
    } = arguments;
    let scene = scene.as_deref().map(|path| of_scene(path, *rate));
    let how = &scene.transpose()?.map_or(*how, |scene| how.like(&scene));
    how.check().map_err(|fault| of_option(&fault))?;
    if *rate == 0 {
        return Err(Error::Input("--rate: found 0, allowed: above 0".to_owned()));
    }
    if plot.is_some() && how.tables == Tables::Single {
        let fault = "--plot: single tables have no report; see host-sim evaluate --plot";
        return Err(Error::Input(fault.to_owned()));
    }
    output::check(out)?;
    plot.as_deref().map_or(Ok(()), output::check)?;
    let mut recordings = read(data, channels)?;
    if let Some(label) = unknown {
        leave_out(&mut recordings, label)?;
    }
    reserved(data, &recordings)?;
    let trained = how
        .train(&recordings, *rate)
        .map_err(|error| refusal(data, channels, &error))?;
    // Opened first: nothing is written where one of them cannot be.
    let picture = plot.as_deref().map(Output::create).transpose()?;
    write_whole(out, trained.model.as_bytes())?;
    let streams = || recordings.iter().flat_map(|(_, streams)| streams);
    let counts = streams().flat_map(|stream| stream.counts(how.least()));
    let samples = counts.filter(|counts| *counts).count();
    let summary = format!(
        "{}: {samples} samples in {} streams, {} bytes",
        out.display(),
        streams().count(),
        trained.model.as_bytes().len()
    );
    let Some(joint) = &trained.joint else {
        return Ok(summary);
    };
    if let Some(picture) = picture {
        let points = joint.report.calibration.iter();
        let points: Vec<_> = points.map(|at| (at.stated, at.found)).collect();
        picture.whole(plot::calibration("trials that were held out", &points)?.as_bytes())?;
    }
    Ok(format!("{summary}\n\n{}", TrainingReport(joint)))
}

/// The scene whose module was recorded.
fn of_scene(path: &Path, rate: u32) -> Result<Scene, Error> {
    let (scene, _) = Scene::load_with(path, &[])?;
    if scene.tick_hz != rate {
        let fault = format!("--rate: found {rate}, the scene has {}", scene.tick_hz);
        return Err(Error::Input(fault));
    }
    Ok(scene)
}

/// Leaves out what is of this label.
fn leave_out(recordings: &mut [(String, Vec<Stream>)], label: &str) -> Result<(), Error> {
    let all = || recordings.iter().flat_map(|(_, streams)| streams);
    if !all().any(|stream| stream.label == label) {
        let mut labels: Vec<&str> = all().map(|stream| stream.label.as_str()).collect();
        labels.sort_unstable();
        labels.dedup();
        let labels = labels.join(", ");
        let fault = format!("--unknown: found {label:?}, allowed: {labels}");
        return Err(Error::Input(fault));
    }
    for (_, streams) in recordings {
        streams.retain(|stream| stream.label != label);
    }
    Ok(())
}

/// No class may be called what a decision for none of them is.
fn reserved(data: &[PathBuf], recordings: &[(String, Vec<Stream>)]) -> Result<(), Error> {
    let is_reserved = |stream: &Stream| stream.label == UNKNOWN;
    let mut named = data.iter().zip(recordings);
    match named.find(|(_, (_, streams))| streams.iter().any(is_reserved)) {
        None => Ok(()),
        Some((path, _)) => Err(Error::file(
            path,
            format!(
                "the label {UNKNOWN:?} is what a decision for none of the classes says; \
                 leave it out with --unknown {UNKNOWN}, or name the class otherwise"
            ),
        )),
    }
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

/// A setting that is refused is called as its option is.
pub(super) fn of_option(fault: &str) -> Error {
    Error::Input(format!("--{fault}"))
}

/// What is wrong: an option, or the data.
fn refusal(data: &[PathBuf], channels: &[String; 2], error: &TrainError) -> Error {
    let first = data.first().map_or(Path::new(""), PathBuf::as_path);
    let option = match error {
        TrainError::Smooth(_) | TrainError::Option { name: "smooth", .. } => "--smooth",
        TrainError::Model(ModelError::Bins(_)) | TrainError::Option { name: "bins", .. } => {
            "--bins"
        }
        TrainError::Model(ModelError::Block(_) | ModelError::BlockTimesChannels(_))
        | TrainError::Option { name: "block", .. } => "--block",
        TrainError::Range { channel } => {
            let name = channels.get(*channel).map_or("", String::as_str);
            return Error::file(
                first,
                format!("{name}: its range is too wide or too narrow"),
            );
        }
        _ => return Error::file(first, error),
    };
    Error::Input(format!("{option}: {error}"))
}
