//! What is deployed: a scene and its model, made for the module that gets it.

use std::path::Path;

use config::{RunsOn, Target};
use firmware::boards::{BoardFacts, NUCLEO_F446RE};
use firmware::{CodeClassifier, ConfigBytes, ConfigError, ModelLimits, ModelState, decode, encode};
use host_sim::classifier::Classifier;
use host_sim::loaded::Loaded;
use host_sim::{Error, files};
use scene::Scene;
use tactile::ModelBuf;
use whisking::Real;
use wire::{Command, HAS_OPINIONS};

use crate::configuration::{Program, Running, Taken, builds, in_format};
use crate::conversation::Conversation;

#[derive(Debug)]
pub(crate) struct Deployment {
    pub(crate) config: Running,
    pub(crate) model: Option<ModelBuf>,
    pub(crate) loaded: Option<Loaded>,
}

pub(crate) fn model_of(file: &Path, scene: &Scene) -> Result<Option<ModelBuf>, Error> {
    let folder = file.parent().unwrap_or(Path::new("."));
    let model = scene.model_path(folder);
    let model = model.map(|path| files::load_model(&path)).transpose()?;
    Ok(model.map(|(_, model)| model))
}

fn has_room(model: &ModelBuf, board: &BoardFacts, name: &str) -> Result<(), Error> {
    let (bytes, room) = (model.as_bytes().len(), board.flash.slots[0].model.bytes);
    let (classes, most) = (model.classes(), board.max_classes);
    let fault = if classes > most {
        format!("found {classes} classes, allowed on the {name}: 2 to {most}")
    } else if bytes > room as usize {
        format!("found {bytes} bytes, allowed on the {name}: at most {room}")
    } else {
        return Ok(());
    };
    Err(Error::Input(format!("the model: {fault}")))
}

/// The configuration that a module runs by, for another model, which may be trained from a contact
/// on; or why it does not do for that.
fn with_model<R: Real>(
    running: &Running,
    model: &ModelBuf,
    board: &BoardFacts,
) -> Result<ConfigBytes, String> {
    let code = running.program().board;
    let of_config = |fault: ConfigError| fault.to_string();
    let mut config = decode::<R>(running.bytes(), code).map_err(of_config)?;
    if !config.classes.is_empty() {
        return Err("it has priors or thresholds of another model's classes".to_owned());
    }
    let (whiskers, whisked) = (config.head.whiskers(), config.whisked());
    let tick_hz = config.head.tick_hz;
    let classifier = config.classifier.as_mut();
    let Some((classifier, rule)) = classifier.and_then(|of| of.rule.map(|rule| (of, rule))) else {
        return Err("it has no [classifier], and so no use for a model".to_owned());
    };
    let boards = config.head.bus.map_or(1, |bus| usize::from(bus.nodes));
    let deciding = classifier.deciding.heard(whiskers / boards.max(1));
    let limits = ModelLimits {
        classes: board.max_classes,
        poses: board.poses_of_each(deciding),
        contact_min: classifier.contact_min.map(|least| least.to_f64() as f32),
        whisked,
        tick_hz,
    };
    let rule = (rule, classifier.deciding);
    let found = CodeClassifier::at_start(model.as_bytes(), limits, rule, whiskers);
    if let ModelState::Refused(refusal) = found.state() {
        return Err(refusal.text().to_owned());
    }
    if let Some(gate) = found.gate() {
        if config.contact.is_none() {
            return Err("it computes no contact, from which this model was trained".to_owned());
        }
        let gate = R::from_f64(f64::from(gate));
        classifier.contact_min.get_or_insert(gate);
    }
    encode(&config, code).map_err(of_config)
}

impl Deployment {
    pub(crate) fn of(
        file: &Path,
        loaded: Loaded,
        model: Option<ModelBuf>,
        program: Program,
    ) -> Result<Self, Error> {
        let wrong = |fault: &dyn std::fmt::Display| Error::file(file, fault);
        let scene = &loaded.scene;
        let config = if let Some(board) = program.facts() {
            let image = config::image(scene, model.as_ref(), board, "");
            Running::of(image.map_err(|misfit| wrong(&misfit))?.bytes.to_vec())?
        } else {
            if let Some(model) = &model {
                has_room(model, &NUCLEO_F446RE, "simulated board")?;
            }
            let records = model.is_none();
            let classifier = loaded.classifier()?;
            let gate = classifier.as_ref().and_then(Classifier::touch_rule);
            let target = Target {
                runs_on: RunsOn::Simulation { records },
                gate: gate.map(|touch| touch.gate),
                classes: classifier.as_ref().map(Classifier::settings),
                overrides: "",
            };
            Running::of_scene(scene, program.board, target)?
        };
        let found = config.program();
        if program.facts().is_some() && found != program {
            return Err(wrong(&format_args!(
                "whisking.numbers: it comes to {}; the board's program computes in {}, whisker \
                 flash gives it another",
                found.format_name(),
                program.format_name()
            )));
        }
        Ok(Self {
            config,
            model,
            loaded: Some(loaded),
        })
    }

    /// The scene that a module runs, with another model.
    pub(crate) fn again(running: &Running, model: ModelBuf) -> Result<Self, Error> {
        let program = running.program();
        let board = program.facts().unwrap_or(&NUCLEO_F446RE);
        has_room(&model, board, board.name)?;
        let bytes = in_format!(program.format, with_model(running, &model, board));
        let bytes = bytes.map_err(|fault| {
            let scene = format!("the scene {} of the module", running.head.name);
            Error::Input(format!("{scene}: {fault}; --scene FILE deploys both"))
        })?;
        Ok(Self {
            config: Running::of(bytes.to_vec())?,
            model: Some(model),
            loaded: None,
        })
    }

    /// Whether a module whose motors are off can read it: what its image was built without it
    /// refuses by name. Nothing is written. An image that takes no configuration so says it after
    /// its restart, and goes on by the scene before.
    pub(crate) fn try_out(&self, module: &mut Conversation) -> Result<(), Error> {
        if self.model.as_ref().is_some_and(ModelBuf::has_opinion) {
            let [_, flags] = module.ask(Command::Board)?.values;
            if flags & HAS_OPINIONS == 0 {
                let fault = "the model has a second opinion, and the module's image was built \
                             without: cargo xtask firmware --scene SCENE builds one for it";
                return Err(Error::Work(fault.to_owned()));
            }
        }
        let refused = match self.config.send(module)? {
            // Another scene is what a restart is for.
            Taken::Refused(ConfigError::Shape(_) | ConfigError::Armed(_))
            | Taken::Runs
            | Taken::NotBuilt => return Ok(()),
            Taken::Refused(refused) => refused,
        };
        let help = match refused {
            ConfigError::NotBuilt(part) => format!("; {}", builds(part)),
            _ => String::new(),
        };
        Err(Error::Work(format!(
            "the module refuses the scene: {refused}{help}; nothing was written"
        )))
    }

    /// The words of the configuration and of the model, each an even number of them, with zeros
    /// at the end: the flash of some boards is written by two.
    pub(crate) fn words(&self) -> [Vec<u32>; 2] {
        let model = self.model.as_ref();
        let model = model.map_or(&[][..], |model| model.as_bytes());
        [self.config.bytes(), model].map(|bytes| {
            let mut bytes = bytes.to_vec();
            bytes.resize(bytes.len().next_multiple_of(8), 0);
            let (words, _) = bytes.as_chunks();
            words.iter().map(|word| u32::from_le_bytes(*word)).collect()
        })
    }
}

#[cfg(test)]
pub(crate) mod tests;
