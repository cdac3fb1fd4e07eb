//! `whisker get`: what a module has beside what its scene says.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::{Error, report};
use scene::key_facts;

use crate::configuration::RunsBy;
use crate::source::SourceChoice;
use crate::tuning::{LIVE, Tuner, Value, live_key};

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
pub(crate) struct Arguments {
    /// Which keys; without any all that can be set
    #[arg(value_name = "KEY")]
    keys: Vec<String>,
    /// Prints the table of all keys that can be set; asks no module
    #[arg(long, group = "source", conflicts_with_all = ["keys", "scene"])]
    list: bool,
    #[command(flatten)]
    which: Which,
}

pub(crate) fn get(arguments: &Arguments) -> Result<(), Error> {
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
        let facts = key_facts(live.key);
        let (allowed, unit) =
            facts.map_or_else(Default::default, |facts| (facts.allowed, facts.unit));
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "| `{}` | {allowed} | {unit} | {} |",
            live.key, live.watch
        );
    }
    text
}

/// `is_same`: but for what was set the module has the file's values; else they are not known.
pub(super) fn table(values: &[(&str, Value, Value)], keys: &[&str], is_same: bool) -> String {
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
