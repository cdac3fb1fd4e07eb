//! `whisker save`: what a module has, into its scene file.

use clap::Args;
use host_sim::{Error, output, report};
use scene::{Override, file};
use similar::TextDiff;

use super::get::Which;
use crate::scene_file;
use crate::tuning::live_key;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
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

pub(crate) fn save(arguments: &Arguments) -> Result<(), Error> {
    let path = arguments.which.scene_file()?;
    output::check(path)?;
    let wrong = |error: std::io::Error| Error::file(path, error);
    let text = file::read_text(path).map_err(wrong)?;
    let values = values(arguments)?;
    if values.is_empty() {
        report::say("the module has what the scene says; nothing to save");
        return Ok(());
    }
    let edited = scene_file::edit(&path.display().to_string(), &text, &values)?;
    let name = path.display().to_string();
    let diff = TextDiff::from_lines(&text, &edited);
    let diff = diff
        .unified_diff()
        .context_radius(1)
        .header(&name, &name)
        .to_string();
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
        "{name}: saved; whisker deploy --scene {name} has the module start with it"
    ));
    Ok(())
}

fn values(arguments: &Arguments) -> Result<Vec<Override>, Error> {
    let given: Vec<Option<Override>> = arguments
        .keys
        .iter()
        .map(|key| {
            let (key, value) = key.split_once('=')?;
            Some(Override::new(format!("{key}={value}"), key, value))
        })
        .collect();
    if !arguments.all && given.iter().all(Option::is_some) {
        return Ok(given.into_iter().flatten().collect());
    }
    let tuner = arguments.which.tuner()?;
    for (key, _) in arguments
        .keys
        .iter()
        .zip(&given)
        .filter(|(_, given)| given.is_none())
    {
        live_key(key, tuner.scene()).map_err(Error::Input)?;
    }
    let mut module = arguments.which.source.module()?;
    let has = tuner.look(&mut module)?;
    if let Some(other) = &has.other {
        report::warn(other);
    }
    let other = has.other;
    let is_asked = |key: &str| arguments.all || arguments.keys.iter().any(|asked| asked == key);
    let differing = has.differing.iter().filter(|(key, _)| is_asked(key));
    let found = differing.map(|(key, value)| {
        let value = format!("{value:#}");
        Override::new(format!("{key}={value}"), key, &value)
    });
    let values: Vec<_> = found.chain(given.into_iter().flatten()).collect();
    match other {
        // What the module has in place of the file's values is not known.
        Some(other) if values.is_empty() => Err(Error::Work(other)),
        _ => Ok(values),
    }
}
