//! `whisker capture`: textures, label by label.

use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::files::load_model;
use host_sim::origin::Origin;
use host_sim::progress::{Progress, Verbosity};
use host_sim::{Error, report};
use jiff::Timestamp;
use scene::file;
use tactile::TouchDetector;
use toml_edit::{DocumentMut, Item};
use wire::Command;

use super::order::SideName;
use crate::capture::{
    CALIBRATION, Checks, Label, Recording, SIDE, Stands, Touches, sampled, stands, token,
};
use crate::conversation::Conversation;
use crate::quoted::quoted;
use crate::source::{Source, SourceChoice, seconds, workspace};
use crate::tally::{Before, SIDES, Tally, side};

/// Poses from which on a model names textures between them.
const POSES: usize = 3;

/// What is captured, how much of it, and where it goes.
#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// A class to capture; give it once for each, in the order in which samples are laid. In a
    /// simulated world the sample is the texture of that name, or TEXTURE
    #[arg(long = "label", value_name = "LABEL[=TEXTURE]", required = true)]
    labels: Vec<Label>,
    /// How many touches of each
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    touches: u32,
    /// The side whose whisker is captured
    #[arg(long, value_enum, default_value = "left")]
    side: SideName,
    /// Goes on with a recording: captures what is missing of each label. Simulated worlds get
    /// another seed then, so that they do not repeat themselves
    #[arg(long)]
    resume: bool,
    /// What this pose of the samples is called; with --resume others can follow in one file
    #[arg(long, value_name = "NAME", value_parser = token)]
    pose: Option<String>,
    /// How the samples stand in this pose: their tilt and how deep they reach, in any units; from six
    /// values of each on a model estimates them
    #[arg(long, value_name = "TILT,DEPTH", requires = "pose", allow_hyphen_values = true, value_parser = stands)]
    stands: Option<Stands>,
    /// For how long nothing may be touched
    #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
    patience: f64,
    /// What whisker calibrate wrote of this whisker; copied into the recording's header
    #[arg(long, value_name = "FILE.toml")]
    calibration: Option<PathBuf>,
    /// The recording to write; an existing file is not overwritten
    #[arg(long, value_name = "FILE.csv")]
    out: PathBuf,
}

/// Captures what is missing; each label is in the file once it is complete.
pub(crate) fn capture(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Error> {
    let (labels, wanted) = (&arguments.labels, arguments.touches as usize);
    let named_twice = |n: usize| labels[..n].iter().any(|label| label.name == labels[n].name);
    if let Some(n) = (0..labels.len()).find(|n| named_twice(*n)) {
        let fault = format!("--label: found {:?} twice, allowed: once", labels[n].name);
        return Err(Error::Input(fault));
    }
    let held = (arguments.pose.as_deref(), arguments.stands);
    let recording = Recording::open(&arguments.out, arguments.resume, held)?;
    let missing = |label: &&Label| recording.touches(&label.name) < wanted;
    let missing: Vec<&Label> = labels.iter().filter(missing).collect();
    if missing.is_empty() {
        report::say(format_args!(
            "{}: has {wanted} touches of each label already",
            arguments.out.display()
        ));
        return Ok(());
    }
    arguments.source.sends_all()?;
    let source = arguments.source.open(recording.all_touches() as u64)?;
    let warnings = complete(recording, &missing, source, arguments, verbosity)?;
    if warnings > 0 {
        report::warn(format_args!(
            "warnings on standard error: {warnings}; look at them before you train"
        ));
    }
    Ok(())
}

/// Captures from `source` what is `missing`; returns how much of it there was to tell about.
fn complete(
    mut recording: Recording,
    missing: &[&Label],
    source: Box<dyn Source>,
    arguments: &Arguments,
    verbosity: Verbosity,
) -> Result<usize, Error> {
    let wanted = arguments.touches as usize;
    let calibration = arguments.calibration.as_deref().map(calibration);
    let calibration = calibration.transpose()?.unwrap_or_default();
    let mut module = Conversation::new(source);
    for label in missing {
        module.source().has(&label.sample)?;
    }
    if let Some(first) = missing.first() {
        module.source().lay(&first.sample)?;
    }
    // From the first tick on: what is felt before a touch is learnt from, too.
    module.ask(Command::Stream(true))?;
    let about = module.about()?;
    let origin = module.origin()?;
    let origin = origin
        .with("scene", &about.scene)
        .with("tick_hz", about.tick_hz)
        .with(SIDE, SIDES[usize::from(arguments.side.number() & 1)]);
    let all = calibration.iter();
    recording.comes_from(all.fold(origin, |origin, (key, value)| origin.with(key, value)))?;

    let already = missing.iter().map(|label| recording.touches(&label.name));
    let total = missing.len() * wanted - already.sum::<usize>();
    let mut capture = Capture {
        arguments,
        module,
        detector: TouchDetector::at(about.tick_hz),
        tally: Tally::default(),
        tick_hz: about.tick_hz,
        progress: Progress::new(verbosity, "touches", total as u64),
        done: 0,
        first: None,
        warnings: 0,
    };
    for (n, label) in missing.iter().enumerate() {
        if n > 0 {
            capture.module.source().lay(&label.sample)?;
        }
        let had = recording.touches(&label.name);
        let touches = Touches::new(&label.name, recording.next_trial(&label.name));
        let touches = capture.label(label, touches, wanted - had)?;
        let felt = touches.felt.len();
        let streams = touches.into_streams();
        let samples: usize = streams.iter().map(|stream| stream.samples.len()).sum();
        if let Some((_, when)) = capture.first
            && !arguments.source.is_simulated()
        {
            recording.begun_at(when);
        }
        recording.add(streams)?;
        let line = format!("{}: {felt} touches, {samples} samples", label.name);
        capture.progress.pause(|| report::say(line));
    }
    capture.module.ask(Command::Stream(false))?;
    let began_s = capture.first.map(|(first_s, _)| first_s);
    let lasted_s = began_s.map_or(0.0, |began_s| capture.module.now_s() - began_s);
    let Tally { lost, records, .. } = capture.tally;
    let out = recording.path().display();
    report::say(format_args!(
        "{out}: {} samples, {} touches; records lost: {} of {}\n\
         from the first touch: {lasted_s:.0} s of the module's time\n{}",
        recording.samples(),
        recording.all_touches(),
        lost,
        records + lost,
        next(
            recording.path(),
            about.tick_hz,
            recording.labels_and_poses(),
            arguments.source.is_simulated()
        )
    ));
    Ok(capture.warnings)
}

/// What comes next, by what is in the recording and what lies beside it: other labels where there
/// is one, training, a model that it can judge, and, where somebody holds the samples, other poses.
fn next(out: &Path, tick_hz: u32, [labels, poses]: [usize; 2], is_simulated: bool) -> String {
    let name = quoted(out);
    // A release has the program, and no cargo.
    let host_sim = workspace().map_or("host-sim", |_| "cargo run -p host-sim --");
    if labels < 2 {
        return "next: another sample, as a model tells samples apart: go on with --resume --label \
                NAME"
            .to_owned();
    }
    let mut lines = vec![format!(
        "next: {host_sim} train --data {name} --rate {tick_hz} --out MODEL"
    )];
    if let Some(model) = model_beside(out, tick_hz) {
        lines.push(format!(
            "or, if it was not trained on these touches: {host_sim} evaluate --model {} --data {name}",
            quoted(&model)
        ));
    }
    if poses < POSES && !is_simulated {
        lines.push(format!(
            "another pose first: hold the samples some degrees otherwise, and go on with --resume \
             --pose NAME; three to five are best, and there is {poses}"
        ));
    }
    lines.join("\n")
}

/// The first model that can judge it.
fn model_beside(recording: &Path, tick_hz: u32) -> Option<PathBuf> {
    let folder = recording.parent().filter(|folder| *folder != Path::new(""));
    let folder = folder.unwrap_or(Path::new("."));
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let can_judge = |path: &PathBuf| {
        let is_model = path.extension().is_some_and(|end| end == "model");
        let model = is_model.then(|| load_model(path).ok()).flatten();
        model.is_some_and(|(_, model)| {
            model.channels() == 2 && model.rate_hz().is_none_or(|hz| hz == tick_hz)
        })
    };
    files.map(|file| file.path()).filter(can_judge).min()
}

/// What a calibration says, as a recording has it in its header.
fn calibration(path: &Path) -> Result<Origin, Error> {
    let wrong = |error: String| Error::file(path, error);
    let text = file::read_text(path).map_err(|error| Error::file(path, error))?;
    let document: DocumentMut = text.parse().map_err(|error| wrong(format!("{error}")))?;
    if !document.contains_key("zero_codes") {
        let fault = "no zero_codes in it, allowed: what whisker calibrate writes";
        return Err(wrong(fault.to_owned()));
    }
    let copied = |origin: Origin, (key, item): (&str, &Item)| {
        origin.with(&format!("{CALIBRATION}{key}"), item.to_string().trim())
    };
    Ok(document.iter().fold(Origin::default(), copied))
}

struct Capture<'a> {
    arguments: &'a Arguments,
    module: Conversation,
    detector: TouchDetector,
    tally: Tally,
    tick_hz: u32,
    progress: Progress,
    done: u64,
    /// When the first ended: by the module's clock, s, and by the PC's.
    first: Option<(f64, Timestamp)>,
    warnings: usize,
}

impl Capture<'_> {
    fn label(&mut self, label: &Label, had: Touches, most: usize) -> Result<Touches, Error> {
        let mut touches = had;
        let mut checks = Checks::new(&label.name, self.tick_hz);
        let mut touched_s = self.module.now_s();
        let is_by_hand = self.module.source().is_laid_by_hand();
        let has_clock = self.module.source().has_clock();
        let mut counts = false;
        while touches.felt.len() < most {
            let incoming = self.module.receive()?;
            if incoming.has_restarted {
                self.tally.restart();
            }
            let now_s = self.module.now_s();
            let is_laid = self.module.source().is_laid()?;
            if is_by_hand && !is_laid {
                // A person takes their time.
                touched_s = now_s;
            }
            for record in incoming.records() {
                if side(record) != usize::from(self.arguments.side.number()) {
                    continue;
                }
                let before = self.tally.take(record);
                let sampled = sampled(&mut self.detector, record, before);
                self.tell(checks.record(record, before));
                if has_clock {
                    self.tell(checks.time(record.sequence, now_s));
                }
                if before != Before::Nothing {
                    touches.interrupt();
                }
                let Some(sampled) = sampled.filter(|_| is_laid) else {
                    touches.interrupt();
                    continue;
                };
                // A touch that goes on as the sample is laid is none of it.
                if !counts && sampled.is_in_the_air() {
                    counts = true;
                    if is_by_hand {
                        let line = format!("{}: counts from now on", label.name);
                        self.progress.pause(|| report::warn(line));
                    }
                }
                // What has come with the last touch is taken too, lest it counts as lost.
                if !counts || touches.felt.len() >= most {
                    continue;
                }
                self.tell(checks.sample(&sampled));
                if touches.take(&sampled) {
                    touched_s = now_s;
                    self.first.get_or_insert_with(|| (now_s, Timestamp::now()));
                    self.done += 1;
                    self.progress.set(self.done);
                }
            }
            if now_s - touched_s > self.arguments.patience {
                return Err(Error::Work(self.nothing(label, &touches)));
            }
        }
        for line in checks.end(&touches) {
            self.tell(Some(line));
        }
        Ok(touches)
    }

    fn tell(&mut self, line: Option<String>) {
        if let Some(line) = line {
            self.warnings += 1;
            self.progress.pause(|| report::warn(line));
        }
    }

    fn nothing(&self, label: &Label, touches: &Touches) -> String {
        let seconds = self.arguments.patience;
        let name = &label.name;
        if self.tally.records == 0 {
            return format!("{name}: no record of that side; has the module a whisker there?");
        }
        if touches.without_contact > 0 {
            return format!(
                "{name}: {} touches have no contact: the module computes none. Its scene needs \
                 [rcp], [cia] or a [classifier]",
                touches.without_contact
            );
        }
        format!(
            "{name}: no touch in {seconds} s; is the sample within reach of the whisker, and the \
             module armed? What is complete is in the file: go on with --resume"
        )
    }
}

#[cfg(test)]
mod tests;
