//! `host-sim evaluate`: what a model is worth on a recording.

use std::path::{Path, PathBuf};

use clap::Args;
use tactile::ModelBuf;

use super::{channels, picture, rate as rate_option};
use crate::classifier::{self, Fault};
use crate::evaluation::{self, Evaluation, Suggestion, THRESHOLDS};
use crate::misfit::{misfits, oddities};
use crate::output::{self, write_whole};
use crate::progress::{Progress, Verbosity};
use crate::rate::{self, Said};
use crate::{Error, files, plot, report};

#[derive(Debug, Args)]
pub(super) struct Arguments {
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
    /// Suggests the lowest threshold from which on at most this share of decisions is wrong
    #[arg(long, value_name = "E")]
    error_rate: Option<f64>,
    /// Suggests the highest threshold up to which decisions take at most this many seconds of
    /// contact in the mean
    #[arg(long, value_name = "S")]
    time: Option<f64>,
    /// Samples a second of the recording [default: what stands above it as tick_hz, or those that
    /// the model was trained at, or 2000]; the model's own must have been the same
    #[arg(long, value_name = "HZ", value_parser = rate_option)]
    rate: Option<u32>,
    /// Where to write a picture of the calibration: stated against found
    #[arg(long, value_name = "FILE.svg", value_parser = picture)]
    plot: Option<PathBuf>,
}

pub(super) fn evaluate(asked: &Arguments, verbosity: Verbosity) -> Result<String, Error> {
    let Arguments { data, plot, .. } = asked;
    let threshold = asked.threshold;
    wanted("--error-rate", asked.error_rate, 1.0)?;
    wanted("--time", asked.time, 1e6)?;
    if let Some(plot) = plot.as_deref() {
        output::check(plot)?;
        output::check_apart(plot, [asked.model.as_path(), data])?;
    }
    let (path, model) = files::load_model(&asked.model)?;
    let channels = asked.channels.each_ref().map(String::as_str);
    let recording = files::whole_recording(data, channels)?;
    let (tick_hz, otherwise) =
        rate_hz(asked.rate, &path, &model, files::rate_of(data, &recording))?;
    let named = [(data.display().to_string(), recording.streams)];
    let odd = oddities(std::slice::from_ref(data), channels, &named);
    let [(_, streams)] = named;
    let wrong = |fault| match fault {
        Fault::Model(fault) => Error::file(&path, fault),
        Fault::Rule(fault) => Error::Input(format!("--threshold {threshold}: {fault}")),
    };
    let presented = evaluation::presentations(&model, threshold, &streams).map_err(wrong)?;
    let classes = classifier::names(&model);
    let evaluation = Evaluation::new(&classes, &presented);
    if let Some(plot) = plot {
        let bins = evaluation.calibration.bins.iter();
        let points: Vec<_> = bins.map(|bin| (bin.stated, bin.found)).collect();
        let svg = plot::calibration(&data.display().to_string(), &points)?;
        write_whole(plot, svg.as_bytes())?;
    }
    let misfits = [misfits(data, channels, &model, &streams), odd].concat();
    let figures = report::figures(&evaluation, tick_hz);
    let mut sections = vec![format!(
        "{figures}\n{}",
        report::of_model(&model, &evaluation)
    )];
    if let Some(same) = model.without_opinion() {
        let presented = evaluation::presentations(&same, threshold, &streams).map_err(wrong)?;
        let same = Evaluation::new(&classes, &presented);
        sections.push(format!("\n{}", report::second_opinion(&evaluation, &same)));
    }
    sections.push("\n".to_owned() + &report::doubts(&classes, &evaluation, &misfits));
    sections.extend(otherwise.map(|note| format!("\nnote: {note}")));
    if asked.error_rate.is_none() && asked.time.is_none() {
        return Ok(sections.concat());
    }

    let mut progress = Progress::new(verbosity, "thresholds", THRESHOLDS.len() as u64);
    let scan = evaluation::scan(&model, &streams, |done| progress.set(done)).map_err(wrong)?;
    drop(progress);
    sections.push(format!("\n\n{}\n", report::thresholds(&scan, tick_hz)));
    if let Some(rate) = asked.error_rate {
        let found = evaluation::for_error(&scan, rate);
        // As the option has it: 0.07 times 100 is not 7.
        let percent = (1e12 * rate).round() / 1e10;
        let wanted = format!("at most {percent} % of decisions wrong");
        sections.push(suggestion(found, &wanted));
        if evaluation.strange.count > 0 {
            let strange = "; decisions on what the model does not know are not among them";
            sections.push(strange.to_owned());
        }
    }
    if let Some(seconds) = asked.time {
        let found = evaluation::for_samples(&scan, seconds * tick_hz);
        let wanted = format!("decisions within {seconds} s in the mean");
        sections.push(suggestion(found, &wanted));
    }
    Ok(sections.concat())
}

/// The samples a second of a recording, and what is to be known of them: the model was trained at
/// others, which only an option says.
fn rate_hz(
    option: Option<u32>,
    path: &Path,
    model: &ModelBuf,
    above: Said,
) -> Result<(f64, Option<String>), Error> {
    let trained = (path.display().to_string(), model.rate_hz());
    rate::agreed([trained.clone(), above.clone()]).map_err(Error::Input)?;
    let assumed = rate::assumed(&trained, &above).filter(|_| option.is_none());
    let found = rate::agreed([("--rate".to_owned(), option), above]).map_err(Error::Input)?;
    let note = rate::agreed([("--rate".to_owned(), found), trained.clone()])
        .err()
        .or(assumed);
    let hz = found.or(trained.1).unwrap_or(rate::USUAL_HZ);
    Ok((f64::from(hz), note))
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

fn suggestion(found: Suggestion<'_>, wanted: &str) -> String {
    match found {
        Suggestion::Backed(at) => format!("\nfor {wanted}: --threshold {}", at.threshold),
        Suggestion::Chance(at) => {
            let [low, high] = at.wrong_interval().map(|share| 100.0 * share);
            let count = at.evaluation.calibration.found.count;
            format!(
                "\nfor {wanted}: no threshold, as of decisions at {} {low:.1} to {high:.1} % may be \
                 wrong by these {count}; record more",
                at.threshold
            )
        }
        Suggestion::None => format!("\nfor {wanted}: no threshold of these"),
    }
}
