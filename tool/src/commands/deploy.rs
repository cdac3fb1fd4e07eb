//! `whisker deploy`: a scene, a model, or both to a module, whose program stays.

use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::loaded::Loaded;
use host_sim::recording::CHANNELS;
use host_sim::{Error, files, misfit, report};
use jiff::Timestamp;
use tactile::ModelBuf;

use crate::capture::{FIRST_TOUCH, origin_of};
use crate::configuration::{Decides, Program, Running, RunsBy};
use crate::conversation::Conversation;
use crate::deployment::{Deployment, model_of};
use crate::loading;
use crate::resting::{let_go, rest};
use crate::source::{SourceChoice, seconds};

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
#[command(group(clap::ArgGroup::new("what").required(true).multiple(true).args(["scene", "model"])))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// The scene; without it the module keeps its own
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// The model, as host-sim train writes it; without it that which the scene names, if any
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// A recording from this bench: says where it is out of the model's range, or has labels
    /// that the model does not know
    #[arg(long, value_name = "FILE", requires = "model")]
    data: Option<PathBuf>,
    /// For how long to print the log afterwards
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
}

/// A scene's file, the scene with the model, and the model.
type Chosen = (PathBuf, Loaded, Option<ModelBuf>);

impl Arguments {
    fn chosen(&self, model: Option<&(PathBuf, ModelBuf)>) -> Result<Option<Chosen>, Error> {
        let Some(file) = self.scene.as_deref().or(self.source.scene()) else {
            return Ok(None);
        };
        let mut loaded = Loaded::new(file)?;
        if let Some((path, model)) = model {
            if loaded.scene.classifier.is_none() || self.source.is_simulated() {
                loaded.takes_model()?;
            }
            loaded = loaded.with_deployed(path, Some(model.clone()));
        }
        loaded = self.source.of_module(loaded)?;
        loaded.classifier()?;
        let model = match model {
            Some((_, model)) => Some(model.clone()),
            None => model_of(file, &loaded.scene)?,
        };
        Ok(Some((file.to_owned(), loaded, model)))
    }

    fn deployment(
        &self,
        module: &mut Conversation,
        chosen: Option<Chosen>,
        model: Option<&(PathBuf, ModelBuf)>,
    ) -> Result<Deployment, Error> {
        let runs_by = RunsBy::ask(module)?;
        let is_its_own = |scene: &str| match &runs_by {
            RunsBy::Scene { name, .. } => name == scene,
            RunsBy::Nothing(_) => true,
        };
        let what = match (chosen, model) {
            (Some((file, loaded, model)), _)
                if self.scene.is_some() || is_its_own(&loaded.scene.name) =>
            {
                Deployment::of(&file, loaded, model, Program::ask(module)?)
            }
            (_, Some((_, model))) => Deployment::again(&Running::ask(module)?, model.clone()),
            (_, None) => Err(Error::Input("--scene or --model is missing".to_owned())),
        }?;
        if module.node().is_none() {
            module.source().would_answer(what.config.links)?;
        }
        if let (Some(node), Some(loaded)) = (module.node(), &what.loaded)
            && loaded.scene.head.nodes.is_none_or(|nodes| nodes <= node)
        {
            let fault = format!(
                "--node {node}: found a scene without such a board; allowed: one whose head has \
                 it, or else it could not be asked any more"
            );
            return Err(Error::Input(fault));
        }
        Ok(what)
    }
}

/// Deploys it, once it fits, and says what the module then runs and decides by.
pub(crate) fn deploy(arguments: &Arguments) -> Result<(), Error> {
    let model = arguments.model.as_deref().map(files::load_model);
    let model = model.transpose()?;
    let chosen = arguments.chosen(model.as_ref())?;
    let mut begun = None;
    if let (Some(data), Some((_, model))) = (&arguments.data, &model) {
        begun = first_touch(data)?;
        let streams = files::read_recording(data, CHANNELS)?;
        for line in misfit::misfits(data, CHANNELS, model, &streams) {
            report::warn(line);
        }
    }
    let mut module = arguments.source.module()?;
    let what = arguments.deployment(&mut module, chosen, model.as_ref())?;
    if let Some((path, model)) = &model {
        report::say(format_args!(
            "{}: model {:08x}, {} bytes, {} classes: {}",
            path.display(),
            model.crc(),
            model.as_bytes().len(),
            model.classes(),
            model.names().collect::<Vec<_>>().join(", ")
        ));
    }
    let before = RunsBy::ask(&mut module)?;
    report::say(format_args!("before, the module {before}"));
    if let Ok(before) = Decides::ask(&mut module) {
        report::say(format_args!("before, the module {before}"));
    }
    let done = rest(&mut module)
        .and_then(|()| what.try_out(&mut module))
        .and_then(|()| loading::deploy(&mut module, &what));
    if done.is_err() {
        // It may not answer any more.
        let _ = let_go(&mut module);
    }
    done?;
    let after = RunsBy::ask(&mut module)?;
    report::say(format_args!("now it {after}"));
    after.is(&what.config)?;
    if what.config.decides {
        let after = Decides::ask(&mut module)?;
        report::say(format_args!("now it {after}"));
        if let Some(model) = &what.model {
            after.is(model)?;
        }
    }
    if let Some((of, begun)) = begun {
        let took = Timestamp::now().duration_since(begun).as_secs();
        report::say(format_args!(
            "{} min {} s since the first touch of {of}",
            took / 60,
            took % 60
        ));
    }
    module.print_log(arguments.seconds.unwrap_or(0.0))
}

fn first_touch(data: &Path) -> Result<Option<(String, Timestamp)>, Error> {
    let origin = origin_of(data)?;
    let when = origin.get(FIRST_TOUCH).and_then(|when| when.parse().ok());
    Ok(when.map(|when| (data.display().to_string(), when)))
}
