//! Keys of a scene, set in a module that runs: what it has, and what is sent to it.

mod live;

use std::path::{Path, PathBuf};

use firmware::{ConfigError, OVERRIDES_BYTES, Part};
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::{Override, Scene, file};
use tactile::ClassList;
use wire::Command;

use crate::configuration::{Running, Taken, not_built};
use crate::conversation::Conversation;
use crate::quoted::quoted;
use crate::source::SourceChoice;

pub(crate) use live::{LIVE, LiveKey, Value, is_of_classes, live_key};

#[derive(Debug)]
pub(crate) struct Tuner {
    path: PathBuf,
    text: String,
    source: SourceChoice,
    scene: Scene,
}

pub(crate) struct Has {
    running: Running,
    scene: Scene,
    /// The keys whose values differ from the scene file's, with the module's.
    pub(crate) differing: Vec<(&'static str, Value)>,
    /// Why the module's configuration is not that of the scene file with these values.
    pub(crate) other: Option<String>,
}

impl Has {
    pub(crate) fn values(&self, file: &Scene) -> Vec<(&'static str, Value, Value)> {
        values(file, &self.scene)
    }
}

impl Tuner {
    pub(crate) fn open(path: &Path, source: &SourceChoice) -> Result<Self, Error> {
        let loaded = Loaded::new(path)?;
        loaded.classifier()?;
        let text = file::read_text(path).map_err(|error| Error::file(path, error))?;
        Ok(Self {
            path: path.to_owned(),
            text,
            source: source.clone(),
            scene: source.of_module(loaded)?.scene,
        })
    }

    pub(crate) const fn scene(&self) -> &Scene {
        &self.scene
    }

    fn with(&self, set: &[Override]) -> Result<Loaded, Error> {
        let folder = self.path.parent().unwrap_or(Path::new("."));
        let name = self.path.display().to_string();
        let loaded = Loaded::from_text(&name, &self.text, set, |model| {
            let bytes = file::read(&folder.join(model), file::BINARY_BYTES);
            bytes.map_err(|error| error.to_string())
        })?;
        self.source.of_module(loaded)
    }

    fn remedy(&self) -> String {
        format!("whisker deploy --scene {}", quoted(&self.path))
    }

    pub(crate) fn look(&self, module: &mut Conversation) -> Result<Has, Error> {
        let running = Running::ask(module)?;
        let (name, file) = (&running.head.name, self.path.display());
        if *name != *self.scene.name {
            return Err(Error::Work(format!(
                "the module runs the scene {name}, {file} is of {}; {} gives it that",
                self.scene.name,
                self.remedy()
            )));
        }
        Ok(self.held(running))
    }

    /// A configuration, held against that of the scene's file with what was set.
    fn held(&self, running: Running) -> Has {
        let overrides = &running.head.overrides;
        let found = overrides.split_whitespace().map(str::parse::<Override>);
        let found = found.collect::<Result<Vec<_>, _>>().map_err(Error::Input);
        let remade = found.and_then(|found| {
            let scene = self.with(&found)?.scene;
            let remade = running.remade(&scene, overrides, &running.classes)?;
            Ok((scene, found, running.differs_in(&remade)))
        });
        let (scene, keys, why) = match remade {
            Ok((scene, keys, names)) => {
                let why = format!("it differs in {}", names.join(", "));
                (scene, keys, (!names.is_empty()).then_some(why))
            }
            // The file does not take what was set any more.
            Err(fault) => (self.scene.clone(), Vec::new(), Some(fault.to_string())),
        };
        let keys: Vec<&str> = keys.iter().map(Override::key).collect();
        Has {
            differing: differing(&self.scene, &scene, &keys),
            other: why.map(|why| {
                format!(
                    "the module's scene {} is of another version than {}, {why}; {} renews it",
                    self.scene.name,
                    self.path.display(),
                    self.remedy()
                )
            }),
            scene,
            running,
        }
    }

    /// The configuration of what a module has, and of `set` in place of that.
    fn wanted(
        &self,
        module: &mut Conversation,
        has: &Has,
        set: &[Override],
    ) -> Result<Running, Error> {
        for one in set {
            let live = live_key(one.key(), &self.scene).map_err(Error::Input)?;
            if (live.value)(&self.scene).is_none() {
                let key = one.key();
                let why = match key {
                    "classifier.cost_error" | "classifier.cost_delay_per_s" => {
                        "the module's scene decides by thresholds: write costs in their place in"
                    }
                    "motor.stop_deg" => {
                        "the module's scene does not search for its stop: write rest = \"find\" to"
                    }
                    _ => "its part is not in the module's scene: add it to",
                };
                return Err(Error::Input(format!(
                    "{key}: {why} {}, then {}",
                    self.path.display(),
                    self.remedy()
                )));
            }
        }
        let found = has.differing.iter();
        let found = found.map(|(key, value)| named(key, &value.to_string()));
        let given = set.iter().map(|one| named(one.key(), one.value()));
        let loaded = self.with(&found.chain(given).collect::<Vec<_>>())?;
        loaded.classifier()?;
        let found = has.differing.iter().map(|(key, _)| *key);
        let keys: Vec<&str> = found.chain(set.iter().map(Override::key)).collect();
        let differing = differing(&self.scene, &loaded.scene, &keys);
        let differing = differing.into_iter();
        let differing = differing.map(|(key, value)| format!("{key}={value}"));
        let overrides = differing.collect::<Vec<_>>().join(" ");
        if overrides.len() > OVERRIDES_BYTES {
            return Err(Error::Input(format!(
                "the keys that differ from the scene file take {} bytes, allowed: {OVERRIDES_BYTES}; \
                 whisker save --all writes them into it, {} brings it to the module",
                overrides.len(),
                self.remedy()
            )));
        }
        let is_of_classes = set.iter().any(|one| is_of_classes(one.key()));
        let classes = is_of_classes.then(|| self.classes(module, has, &loaded));
        let classes = classes.transpose()?;
        let classes = classes.as_ref().unwrap_or(&has.running.classes);
        has.running.remade(&loaded.scene, &overrides, classes)
    }

    /// The priors and thresholds of the classes of a module's model, by a scene that is wanted.
    fn classes(
        &self,
        module: &mut Conversation,
        has: &Has,
        wanted: &Loaded,
    ) -> Result<ClassList, Error> {
        let names = module.classes()?;
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        if names.is_empty() {
            let fault = "the module decides by no model, and so has no classes";
            return Err(Error::Work(fault.to_owned()));
        }
        let [crc, _] = module.ask(Command::Model)?.values;
        let model = wanted.model();
        let model = model.filter(|model| model.crc() == crc.cast_unsigned());
        let of = |scene| {
            let classes = config::classes_of(scene, &names, model);
            classes.map_err(|fault| Error::Input(fault.to_string()))
        };
        if of(&has.scene)? != has.running.classes {
            return Err(Error::Work(format!(
                "the module has other priors or thresholds of classes than {}; {} renews them",
                self.path.display(),
                self.remedy()
            )));
        }
        of(&wanted.scene)
    }

    /// All between the same two ticks; where it fails or is refused, nothing has changed. What the
    /// module has then, or why it refuses them.
    pub(crate) fn set(
        &self,
        module: &mut Conversation,
        set: &[Override],
    ) -> Result<Result<Has, String>, Error> {
        let has = self.look(module)?;
        if let Some(other) = has.other {
            return Ok(Err(other));
        }
        let wanted = self.wanted(module, &has, set)?;
        if wanted == has.running {
            return Ok(Ok(has));
        }
        if let Err(refused) = has.running.may_become(&wanted) {
            let keys: Vec<_> = set.iter().map(Override::key).collect();
            let (keys, remedy) = (keys.join(", "), self.remedy());
            return Err(Error::Input(format!("{keys}: {refused}: {remedy}")));
        }
        let refused = match wanted.send(module)? {
            Taken::Runs => return Ok(Ok(self.held(wanted))),
            Taken::NotBuilt => return Err(not_built(Part::Set)),
            Taken::Refused(refused) => refused,
        };
        let help = match refused {
            ConfigError::Armed(_) => "; whisker stop switches them off",
            _ => "",
        };
        let why = format!("the module refuses {refused}{help}; nothing has changed");
        Ok(Err(why))
    }
}

/// A key and its value, which messages name as they are.
pub(crate) fn named(key: &str, value: &str) -> Override {
    Override::new(format!("{key}={value}"), key, value)
}

fn differing(file: &Scene, module: &Scene, keys: &[&str]) -> Vec<(&'static str, Value)> {
    let values = values(file, module).into_iter();
    let values = values.filter(|(key, own, has)| own != has && keys.contains(key));
    values.map(|(key, _, has)| (key, has)).collect()
}

/// Keys in their order: with the values of the file and of the module; none where the scene has
/// no part for it.
fn values(file: &Scene, module: &Scene) -> Vec<(&'static str, Value, Value)> {
    let values = LIVE.iter().filter_map(|live| {
        let (own, has) = ((live.value)(file)?, (live.value)(module)?);
        Some((live.key, own, has))
    });
    values.collect()
}
