//! `host-sim train`: recordings to a model.

use std::path::{Path, PathBuf};

use clap::Args;
use scene::Scene;
use tactile::train::TrainError;
use tactile::{MAX_STREAMS, ModelError};

use super::{channels, picture, rate as rate_option};
use crate::decisions::UNKNOWN;
use crate::misfit::oddities;
use crate::output::{self, Output, write_whole};
use crate::rate::{self, Said};
use crate::recording::Stream;
use crate::training::{Expected, How, Tables};
use crate::{Error, doubts, files, plot, report};

/// What to train from, and how.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The recording: label,trial,x,y, and contact where samples are of the air too; given
    /// several times, each is held out in turn, to say what to expect of another one
    #[arg(long, value_name = "FILE.csv", required = true)]
    pub data: Vec<PathBuf>,
    /// Two other columns in place of x,y
    #[arg(long, value_name = "A,B", default_value = "x,y", value_parser = channels)]
    pub channels: [String; 2],
    /// Where to write the model
    #[arg(long, value_name = "MODEL")]
    pub out: PathBuf,
    /// Samples a second of the recordings [default: what stands above them as tick_hz, or those of
    /// the scene, or 2000]; the model keeps them, and is refused at another rate
    #[arg(long, value_name = "HZ", value_parser = rate_option)]
    pub rate: Option<u32>,
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

/// Trains a model from recordings and writes it. Returns what it was made of, and what it is worth.
///
/// # Errors
/// [`Error::Input`] for a recording or an option that is wrong, [`Error::Write`].
pub fn train(asked: &Arguments) -> Result<String, Error> {
    let scene = asked.scene.as_deref().map(Scene::load).transpose()?;
    let mut said = vec![("--rate".to_owned(), asked.rate)];
    let of_scene = scene.as_ref().map(|scene| scene.tick_hz);
    said.push(("the scene".to_owned(), of_scene));
    rate::agreed(said.clone()).map_err(Error::Input)?;
    let ahead = said.len();
    let how = &scene.map_or(asked.how, |scene| asked.how.like(&scene));
    how.check().map_err(|fault| of_option(&fault))?;
    if asked.plot.is_some() && how.tables == Tables::Single {
        let fault = "--plot: single tables have no report; see host-sim evaluate --plot";
        return Err(Error::Input(fault.to_owned()));
    }
    let (data, out, plot) = (&asked.data, &asked.out, asked.plot.as_deref());
    output::check(out)?;
    let inputs = || data.iter().chain(&asked.scene).map(PathBuf::as_path);
    output::check_apart(out, inputs())?;
    if let Some(plot) = plot {
        output::check(plot)?;
        output::check_apart(plot, inputs().chain([out.as_path()]))?;
    }
    let mut odd = Vec::new();
    let mut recordings = read(data, &asked.channels, &mut said, &mut odd)?;
    let [ahead, of_data] = [&said[..ahead], &said[ahead..]];
    if ahead.iter().all(|(_, hz)| hz.is_none()) {
        rate::complete(of_data).map_err(Error::Input)?;
    }
    let rate = rate::agreed(said).map_err(Error::Input)?;
    let rate = rate.unwrap_or(rate::USUAL_HZ);
    if let Some(label) = &asked.unknown {
        leave_out(&mut recordings, label)?;
    }
    reserved(data, &recordings)?;
    if how.each_whisker {
        whiskers(data, &recordings)?;
    }
    let channels = &asked.channels;
    let names = channels.each_ref().map(String::as_str);
    odd.extend(oddities(data, names, &recordings));
    let trained = how.train(&recordings, rate).map_err(|error| {
        let mut lines = vec![refusal(data, channels, &error).to_string()];
        if matches!(error, TrainError::TooShort { .. }) {
            lines.push(doubts::short(&recordings));
        }
        lines.extend_from_slice(&odd);
        Error::Input(lines.join("\n"))
    })?;
    // Opened first: nothing is written where one of them cannot be.
    let picture = plot.map(Output::create).transpose()?;
    write_whole(out, trained.model.as_bytes())?;
    let streams = || recordings.iter().flat_map(|(_, streams)| streams);
    let learns_none = how.tables == Tables::Single || how.expect == Expected::Same;
    if learns_none && streams().any(|stream| stream.stands.is_some()) {
        let said = "warning: no poses are estimated, as by single tables or with --expect same";
        odd.push(said.to_owned());
    }
    let counts = streams().flat_map(|stream| stream.counts(how.least()));
    let samples = counts.filter(|counts| *counts).count();
    let odd = odd.iter().flat_map(|line| ["\n", line]).collect::<String>();
    let summary = format!(
        "{}: {samples} samples in {} streams, {} bytes",
        out.display(),
        streams().count(),
        trained.model.as_bytes().len()
    );
    let Some(joint) = &trained.joint else {
        return Ok(summary + &odd);
    };
    if let Some(picture) = picture {
        let points = joint.report.calibration.iter();
        let points: Vec<_> = points.map(|at| (at.stated, at.found)).collect();
        picture.whole(plot::calibration("trials that were held out", &points)?.as_bytes())?;
    }
    Ok(format!("{summary}\n\n{}{odd}", report::training(joint)))
}

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

/// The numbers of whiskers are those that a module has.
fn whiskers(data: &[PathBuf], recordings: &[(String, Vec<Stream>)]) -> Result<(), Error> {
    let is_none = |stream: &&Stream| stream.numbered().is_some_and(|n| n != stream.whisker());
    let found = data
        .iter()
        .zip(recordings)
        .find_map(|(path, (_, streams))| {
            let stream = streams.iter().find(is_none)?;
            Some((path, &stream.trial))
        });
    found.map_or(Ok(()), |(path, trial)| {
        let fault = format!("found trial {trial:?}, allowed: whiskers from 1 to {MAX_STREAMS}");
        Err(Error::file(path, fault))
    })
}

/// Recordings, each with its name, what they say of the samples a second, and what is `odd`.
fn read(
    data: &[PathBuf],
    channels: &[String; 2],
    said: &mut Vec<Said>,
    odd: &mut Vec<String>,
) -> Result<Vec<(String, Vec<Stream>)>, Error> {
    let channels = channels.each_ref().map(String::as_str);
    let read = |path: &PathBuf| {
        let recording = files::whole_recording(path, channels)?;
        said.push(files::rate_of(path, &recording));
        let name = path.display().to_string();
        odd.extend(recording.alone.map(|column| {
            format!("warning: {name}: {column} alone: poses need tilt_deg and depth_deg")
        }));
        Ok((name, recording.streams))
    };
    data.iter().map(read).collect()
}

pub(super) fn of_option(fault: &str) -> Error {
    Error::Input(format!("--{fault}"))
}

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
            let name = &channels[channel % 2];
            let whisker = match channel / 2 {
                0 => String::new(),
                before => format!(" of whisker {}", before + 1),
            };
            let fault = format!("{name}{whisker}: its range is too wide or too narrow");
            return Error::file(first, fault);
        }
        TrainError::Unfelt { channel, class } => {
            let [whisker, class] = [channel / 2 + 1, class + 1];
            let fault = format!(
                "whisker {whisker} has no sample of the label that is number {class} in the recording"
            );
            return Error::file(first, fault);
        }
        _ => return Error::file(first, error),
    };
    Error::Input(format!("{option}: {error}"))
}
