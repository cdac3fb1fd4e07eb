//! `host-sim evaluate`: what a model is worth on a recording.

use std::path::PathBuf;

use clap::Args;

use super::{channels, picture};
use crate::Error;
use crate::classifier::{self, Fault};
use crate::evaluation::{self, Candidate, Evaluation, THRESHOLDS};
use crate::files;
use crate::misfit::misfits;
use crate::output::{self, write_whole};
use crate::plot;
use crate::progress::{Progress, Verbosity};
use crate::report::{self, Doubts, Figures, Thresholds};

/// What to evaluate.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The model
    #[arg(long)]
    model: PathBuf,
    /// A recording that the model was not trained on: label,trial,x,y, and contact where
    /// samples are of the air too
    #[arg(long, value_name = "FILE.csv")]
    data: PathBuf,
    /// Two other columns in place of x,y
    #[arg(long, value_name = "A,B", default_value = "x,y", value_parser = channels)]
    channels: [String; 2],
    /// Decide when a posterior probability exceeds this
    #[arg(long, value_name = "P", default_value_t = 0.99)]
    threshold: f64,
    /// Suggests the lowest threshold from which on no larger share of decisions is wrong
    #[arg(long, value_name = "E")]
    error_rate: Option<f64>,
    /// Suggests the highest threshold up to which a decision takes no more seconds of
    /// contact in the mean
    #[arg(long, value_name = "S")]
    time: Option<f64>,
    /// Samples a second of the recording; the model's own must have been the same
    #[arg(long, value_name = "HZ", default_value_t = 2000)]
    rate: u32,
    /// Where to write a picture of the calibration: stated against found
    #[arg(long, value_name = "FILE.svg", value_parser = picture)]
    plot: Option<PathBuf>,
}

/// The figures of a model on a recording, and the thresholds that were asked for.
///
/// # Errors
/// [`Error::Input`] for a model, recording or option that is wrong.
pub fn evaluate(arguments: &Arguments, verbosity: Verbosity) -> Result<String, Error> {
    let Arguments {
        data,
        channels,
        threshold,
        error_rate,
        time,
        rate,
        plot,
        ..
    } = arguments;
    wanted("--error-rate", *error_rate, 1.0)?;
    wanted("--time", *time, 1e6)?;
    if *rate == 0 {
        return Err(Error::Input("--rate: found 0, allowed: above 0".to_owned()));
    }
    plot.as_deref().map_or(Ok(()), output::check)?;
    let tick_hz = f64::from(*rate);
    let (path, model) = files::load_model(&arguments.model)?;
    let channels = channels.each_ref().map(String::as_str);
    let streams = files::read_recording(data, channels)?;
    let wrong = |fault| match fault {
        Fault::Model(fault) => Error::file(&path, fault),
        Fault::Rule(fault) => Error::Input(format!("--threshold {threshold}: {fault}")),
    };
    let presented = evaluation::presentations(&model, *threshold, &streams).map_err(wrong)?;
    let classes = classifier::names(&model);
    let evaluation = Evaluation::new(&classes, &presented);
    if let Some(plot) = plot {
        let bins = evaluation.calibration.bins.iter();
        let points: Vec<_> = bins.map(|bin| (bin.stated, bin.found)).collect();
        let svg = plot::calibration(&data.display().to_string(), &points)?;
        write_whole(plot, svg.as_bytes())?;
    }
    let doubts = Doubts {
        classes: &classes,
        evaluation: &evaluation,
        misfits: misfits(data, channels, &model, &streams),
    };
    let figures = Figures(&evaluation, tick_hz);
    let mut sections = vec![format!("{figures}\n{}\n{doubts}", report::of_model(&model))];
    if error_rate.is_none() && time.is_none() {
        return Ok(sections.concat());
    }

    let mut progress = Progress::new(verbosity, "thresholds", THRESHOLDS.len() as u64);
    let scan = evaluation::scan(&model, &streams, |done| progress.set(done)).map_err(wrong)?;
    drop(progress);
    sections.push(format!("\n\n{}\n", Thresholds(&scan, tick_hz)));
    if let Some(rate) = error_rate {
        let found = evaluation::for_error(&scan, *rate);
        let percent = 100.0 * rate;
        let wanted = format!("at most {percent} % of decisions wrong");
        sections.push(suggestion(found, &wanted));
    }
    if let Some(seconds) = time {
        let found = evaluation::for_samples(&scan, seconds * tick_hz);
        let wanted = format!("decisions within {seconds} s in the mean");
        sections.push(suggestion(found, &wanted));
    }
    Ok(sections.concat())
}

fn wanted(option: &str, value: Option<f64>, most: f64) -> Result<(), Error> {
    match value {
        // Not a number is outside, too.
        Some(value) if !(value > 0.0 && value <= most) => Err(Error::Input(format!(
            "{option}: found {value}, allowed: above 0, up to {most}"
        ))),
        _ => Ok(()),
    }
}

fn suggestion(found: Option<&Candidate>, wanted: &str) -> String {
    match found {
        Some(at) => format!("\nfor {wanted}: --threshold {}", at.threshold),
        None => format!("\nfor {wanted}: no threshold of these"),
    }
}
