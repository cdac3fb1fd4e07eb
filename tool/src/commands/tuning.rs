//! `whisker get`, `set` and `save`: keys of the scene in a module that runs, and in its file.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use config::{Mismatch, RunsOn, Target};
use host_sim::{Error, output, report};
use scene::{Override, Scene, file, key_facts};
use similar::TextDiff;

use crate::configuration::RunsBy;
use crate::quoted::quoted;
use crate::scene_file;
use crate::source::{SourceChoice, seconds};
use crate::tuning::{LIVE, LiveKey, Tuner, Value, live_key, named};

#[derive(Debug, Args)]
pub(crate) struct Which {
    #[command(flatten)]
    pub(super) source: SourceChoice,
    /// The file of the module's scene; without it that of the module's option
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
}

impl Which {
    pub(super) fn scene_file(&self) -> Result<&Path, Error> {
        let file = self.scene.as_deref().or(self.source.scene());
        file.ok_or_else(|| {
            let fault = "which scene does the module run? allowed: --scene FILE";
            Error::Input(fault.to_owned())
        })
    }

    pub(super) fn tuner(&self) -> Result<Tuner, Error> {
        Tuner::open(self.scene_file()?, &self.source)
    }
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct GetArguments {
    /// Which keys; without any all that can be set
    #[arg(value_name = "KEY")]
    keys: Vec<String>,
    /// Prints the table of all keys that can be set; asks no module
    #[arg(long, group = "source", conflicts_with_all = ["keys", "scene"])]
    list: bool,
    #[command(flatten)]
    which: Which,
}

pub(crate) fn get(arguments: &GetArguments) -> Result<(), Error> {
    if arguments.list {
        report::say(list().trim_end());
        return Ok(());
    }
    let tuner = arguments.which.tuner()?;
    for key in &arguments.keys {
        live_key(key, tuner.scene()).map_err(Error::Input)?;
    }
    let mut module = arguments.which.source.module()?;
    let has = tuner.look(&mut module)?;
    let values = has.values(tuner.scene());
    let keys: Vec<&str> = arguments.keys.iter().map(String::as_str).collect();
    for key in &keys {
        if !values.iter().any(|(known, ..)| known == key) {
            let fault = format!("{key}: its part is not in the module's scene");
            return Err(Error::Input(fault));
        }
    }
    if keys.is_empty() {
        report::say(format_args!("the module {}", RunsBy::ask(&mut module)?));
    }
    report::say(table(&values, &keys, has.other.is_none()));
    if let Some(other) = &has.other {
        report::say(other);
    }
    Ok(())
}

fn list() -> String {
    let mut text = String::from("| key | value | unit | what to watch |\n|---|---|---|---|\n");
    for live in LIVE {
        let LiveKey { key, watch, .. } = live;
        let facts = key_facts(key);
        let (allowed, unit) =
            facts.map_or_else(Default::default, |facts| (facts.allowed, facts.unit));
        // Writing to a string does not fail.
        let _ = writeln!(text, "| `{key}` | {allowed} | {unit} | {watch} |");
    }
    text
}

/// `is_same`: but for what was set the module has the file's values; else they are not known.
fn table(values: &[(&str, Value, Value)], keys: &[&str], is_same: bool) -> String {
    let mut text = format!("{:<26}{:>12}{:>12}", "key", "scene", "module");
    for (key, file, module) in values {
        if !keys.is_empty() && !keys.contains(key) {
            continue;
        }
        let unit = key_facts(key).map_or("", |facts| facts.unit);
        let differs = if file == module { "" } else { "differs" };
        let is_known = is_same || file != module;
        let [file, module] = [file, module].map(Value::to_string);
        let module = if is_known { &*module } else { "?" };
        let line = format!("{key:<26}{file:>12} {module:>11}  {differs:<8}{unit}");
        // Writing to a string does not fail.
        let _ = write!(text, "\n{}", line.trim_end());
    }
    text
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct SetArguments {
    /// Keys and values as a scene file has them, such as motor.kp=0.07; docs/calibrating.md lists
    /// those that can be set
    #[arg(required = true, value_name = "KEY=VALUE")]
    set: Vec<Override>,
    #[command(flatten)]
    which: Which,
    /// For how long to print what the module logs then
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
}

pub(crate) fn set(arguments: &SetArguments) -> Result<(), Error> {
    let tuner = arguments.which.tuner()?;
    let mut module = arguments.which.source.module()?;
    let has = tuner
        .set(&mut module, &arguments.set)?
        .map_err(Error::Work)?;
    let keys: Vec<&str> = arguments.set.iter().map(Override::key).collect();
    report::say(table(&has.values(tuner.scene()), &keys, true));
    if !has.differing.is_empty() {
        report::say("to keep it: whisker save; a reset brings the scene's back");
    }
    module.print_log(arguments.seconds.unwrap_or(0.0))
}

#[derive(Debug, Args)]
pub(crate) struct SaveArguments {
    /// Keys whose values the module has, or keys with their values (KEY=VALUE), which need no
    /// module
    #[arg(value_name = "KEY[=VALUE]", required_unless_present = "all")]
    keys: Vec<String>,
    /// All keys whose values in the module differ from the scene's
    #[arg(long, conflicts_with = "keys")]
    all: bool,
    #[command(flatten)]
    which: Which,
    /// Prints what would change, and changes nothing
    #[arg(long)]
    dry_run: bool,
}

pub(crate) fn save(arguments: &SaveArguments) -> Result<(), Error> {
    let path = arguments.which.scene_file()?;
    output::check(path)?;
    let wrong = |error: std::io::Error| Error::file(path, error);
    let text = file::read_text(path).map_err(wrong)?;
    let values = values(arguments)?;
    if values.is_empty() {
        report::say("the module has what the scene says; nothing to save");
        return Ok(());
    }
    let name = path.display().to_string();
    let edited = scene_file::edit(&name, &text, &values)?;
    if let Ok(scene) = Scene::from_str(&name, &edited)
        && let Err(fault) = config::build::<f32>(&scene, Target::of(RunsOn::Board))
        && matches!(fault, Mismatch::Unsettled(_) | Mismatch::Unprotected(_))
    {
        report::warn(format_args!("warning: no board takes it: {fault}"));
    }
    let diff = TextDiff::from_lines(&text, &edited);
    let mut diff = diff.unified_diff();
    let diff = diff.context_radius(1).header(&name, &name).to_string();
    report::say(diff.trim_end());
    if arguments.dry_run {
        return Ok(());
    }
    // Another may have written it meanwhile, by an editor.
    if file::read_text(path).map_err(wrong)? != text {
        let fault = "it has changed meanwhile; nothing was saved";
        return Err(Error::Work(format!("{name}: {fault}")));
    }
    output::write_whole(path, edited.as_bytes())?;
    report::say(format_args!(
        "{name}: saved; whisker deploy --scene {} has the module start with it, with --model where \
         it names none",
        quoted(path)
    ));
    Ok(())
}

fn values(arguments: &SaveArguments) -> Result<Vec<Override>, Error> {
    let keys = arguments.keys.iter();
    let (given, asked): (Vec<&String>, Vec<&String>) = keys.partition(|key| key.contains('='));
    let given = given.into_iter().filter_map(|key| key.split_once('='));
    let given = given.map(|(key, value)| named(key, value));
    if !arguments.all && asked.is_empty() {
        return Ok(given.collect());
    }
    let tuner = arguments.which.tuner()?;
    for key in &asked {
        live_key(key, tuner.scene()).map_err(Error::Input)?;
    }
    let mut module = arguments.which.source.module()?;
    let has = tuner.look(&mut module)?;
    if let Some(other) = &has.other {
        report::warn(other);
    }
    let is_asked = |key: &str| arguments.all || asked.iter().any(|asked| *asked == key);
    let differing = has.differing.iter().filter(|(key, _)| is_asked(key));
    let found = differing.map(|(key, value)| named(key, &format!("{value:#}")));
    let values: Vec<_> = found.chain(given).collect();
    match has.other {
        // What the module has in place of the file's values is not known.
        Some(other) if values.is_empty() => Err(Error::Work(other)),
        _ => Ok(values),
    }
}
