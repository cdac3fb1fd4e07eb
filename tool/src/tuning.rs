//! Keys of a scene, set in a module that runs: what it has, and what is sent to it.

mod infer;
mod live;

use std::path::{Path, PathBuf};

use firmware::tunable_name;
use host_sim::Error;
use host_sim::bench::{ConstantWords, RunsOn, TunableConstants, tunable_constants};
use host_sim::classifier::Classifier;
use host_sim::commands::choice::SceneChoice;
use host_sim::loaded::Loaded;
use plan::NumberFormat;
use scene::{Override, Scene};
use wire::{Command, CommandStatus, SECOND_WORD, word_sum};

use crate::conversation::Conversation;

pub(crate) use infer::Found;
pub(crate) use live::{LIVE, live_key};

/// Who sets keys of a scene.
#[derive(Debug)]
pub(crate) struct Tuner {
    path: PathBuf,
    scene: Scene,
    /// The contact of its model.
    gate: Option<f32>,
    runs_on: RunsOn,
}

/// What a module has.
pub(crate) struct Has {
    /// Its constants in its number format.
    constants: ConstantWords,
    format: NumberFormat,
    /// The scene with the module's values.
    pub(crate) scene: Scene,
    /// The keys whose values differ from the scene file's.
    pub(crate) differing: Vec<Found>,
    /// Constants that differ and that no key explains.
    unexplained: Vec<u8>,
}

/// The constants of scenes, as they are held against a module's.
struct Held<'t> {
    tuner: &'t Tuner,
    format: NumberFormat,
    module: &'t TunableConstants,
}

impl infer::Constants for Held<'_> {
    fn of(&self, scene: &Scene, number: u8) -> Option<f64> {
        let constants = self.tuner.constants(scene, self.format).ok()?;
        constants.get(&number).map(|constant| constant.value)
    }

    fn found(&self, number: u8) -> Option<f64> {
        self.module.get(&number).map(|constant| constant.value)
    }
}

impl Tuner {
    /// Of the scene in `path`, whose module is simulated or not.
    pub(crate) fn open(path: &Path, is_simulated: bool) -> Result<Self, Error> {
        let loaded = Loaded::new(path)?;
        let classifier = loaded.classifier()?;
        let touch = classifier.as_ref().and_then(Classifier::touch_rule);
        Ok(Self {
            path: path.to_owned(),
            gate: touch.map(|touch| touch.gate),
            runs_on: if is_simulated {
                let records = classifier.is_none();
                RunsOn::Simulation { records }
            } else {
                RunsOn::Board
            },
            scene: loaded.scene,
        })
    }

    /// The scene as its file has it.
    pub(crate) const fn scene(&self) -> &Scene {
        &self.scene
    }

    fn constants(&self, scene: &Scene, format: NumberFormat) -> Result<TunableConstants, Error> {
        tunable_constants(
            scene,
            self.gate,
            format,
            self.runs_on,
            &ConstantWords::new(),
        )
    }

    /// Asks a module for all constants that it should have.
    ///
    /// # Errors
    /// [`Error::Work`] if it is of another scene.
    pub(crate) fn look(&self, module: &mut Conversation) -> Result<Has, Error> {
        let about = module.about()?;
        if about.scene != self.scene.name {
            return Err(Error::Work(format!(
                "the module's program is of the scene {}, {} is of {}",
                about.scene,
                self.path.display(),
                self.scene.name
            )));
        }
        let [format, _] = module.ask(Command::Constant(0))?.values;
        let format = match format & 0xFF {
            1 => NumberFormat::Single,
            2 => NumberFormat::Double,
            3 => NumberFormat::Fixed,
            other => {
                let fault = format!("the module has number format {other}; known are 1 to 3");
                return Err(Error::Work(fault));
            }
        };
        let own = self.constants(&self.scene, format)?;
        let mut constants = ConstantWords::new();
        for number in own.keys() {
            let answer = module.answer(Command::Constant(*number))?;
            if answer.status != CommandStatus::Done {
                return Err(Error::Work(format!(
                    "the module has no constant {number} ({}): {}. Its program is of another \
                     version of {}; whisker flash renews it",
                    tunable_name(*number),
                    answer.status,
                    self.path.display()
                )));
            }
            constants.insert(*number, answer.values.map(i32::cast_unsigned));
        }
        self.known(constants, format)
    }

    /// What constants mean.
    fn known(&self, constants: ConstantWords, format: NumberFormat) -> Result<Has, Error> {
        let decoded = tunable_constants(&self.scene, self.gate, format, self.runs_on, &constants)?;
        let held = Held {
            tuner: self,
            format,
            module: &decoded,
        };
        let mut scene = self.scene.clone();
        let differing = infer::infer(&mut scene, &held);
        let own = self.constants(&scene, format)?;
        let differs = |number: &&u8| own.get(number).map(|own| &own.words) != constants.get(number);
        let unexplained = constants.keys().filter(differs).copied().collect();
        Ok(Has {
            constants,
            format,
            scene,
            differing,
            unexplained,
        })
    }

    /// The scene's file with the module's values, and with `set` in place of those.
    ///
    /// # Errors
    /// [`Error::Input`] for a key that cannot be set, or a value that the scene refuses.
    fn with(&self, has: &Has, set: &[Override]) -> Result<Scene, Error> {
        let own = self.constants(&self.scene, has.format)?;
        for one in set {
            let live = live_key(one.key(), &self.scene).map_err(Error::Input)?;
            let is_there = (live.place)(&mut self.scene.clone()).is_some();
            if !is_there || !own.contains_key(&live.lead_in(&self.scene)) {
                return Err(Error::Input(format!(
                    "{}: its part is not in the program; it needs a rebuild: add it to {}, then \
                     whisker flash",
                    one.key(),
                    self.path.display()
                )));
            }
        }
        let found = has.differing.iter().map(|found| {
            let value = found.value.to_string();
            named(found.key, &value)
        });
        let given = set.iter().map(|one| named(one.key(), one.value()));
        let file = self.path.clone();
        let set = found.chain(given).collect();
        let loaded = Loaded::with(&SceneChoice { file, set })?;
        loaded.classifier()?;
        Ok(loaded.scene)
    }

    /// Sets keys in a module, all between the same two ticks; returns what it has then.
    ///
    /// # Errors
    /// [`Error::Input`] for a key that cannot be set or a value that the scene refuses,
    /// [`Error::Work`] for a module of another scene, or one that refuses: nothing has changed.
    pub(crate) fn set(&self, module: &mut Conversation, set: &[Override]) -> Result<Has, Error> {
        let has = self.look(module)?;
        if let Some(number) = has.unexplained.first() {
            return Err(Error::Work(format!(
                "constant {number} of the module ({}) is none of {} with any key set: its program \
                 is of another version of the scene; whisker flash renews it",
                tunable_name(*number),
                self.path.display()
            )));
        }
        let scene = self.with(&has, set)?;
        let wanted = self.constants(&scene, has.format)?;
        if !wanted.keys().eq(has.constants.keys()) {
            let keys: Vec<_> = set.iter().map(Override::key).collect();
            return Err(Error::Input(format!(
                "{}: a part of the program would come or go with this value; it needs a rebuild: \
                 whisker flash",
                keys.join(", ")
            )));
        }
        let words = staged(&has.constants, &wanted);
        if words.is_empty() {
            return Ok(has);
        }
        module.ask(Command::Forget)?;
        for (number, word) in &words {
            module.ask(Command::Stage(*number, *word))?;
        }
        let answer = module.answer(Command::Apply(word_sum(words.into_iter())))?;
        if answer.status != CommandStatus::Done {
            let [number, _] = answer.values;
            let name = u8::try_from(number).map_or("", tunable_name);
            return Err(Error::Work(format!(
                "the module refuses constant {number} ({name}): {}; nothing has changed",
                answer.status
            )));
        }
        self.look(module)
    }
}

/// A key and its value, which messages name as they are.
fn named(key: &str, value: &str) -> Override {
    Override::new(format!("{key}={value}"), key, value)
}

/// The words that differ, in the order in which they are summed.
fn staged(has: &ConstantWords, wanted: &TunableConstants) -> Vec<(u8, u32)> {
    let both = has
        .iter()
        .filter_map(|(n, has)| Some((*n, has, wanted.get(n)?.words)));
    let halves = both.flat_map(|(number, has, wanted)| {
        let halves = [
            (number, has[0], wanted[0]),
            (number | SECOND_WORD, has[1], wanted[1]),
        ];
        halves.into_iter().filter(|(_, has, wanted)| has != wanted)
    });
    halves.map(|(number, _, wanted)| (number, wanted)).collect()
}

impl Has {
    /// Keys in their order: with the values of the file and of the module; none where the
    /// program has no part for it.
    pub(crate) fn values(&self, file: &Scene) -> Vec<(&'static str, f64, f64)> {
        let keys = LIVE.iter().filter(|live| {
            let lead = live.lead_in(file);
            self.constants.contains_key(&lead)
        });
        let values = keys.filter_map(|live| {
            let own = *(live.place)(&mut file.clone())?;
            let has = *(live.place)(&mut self.scene.clone())?;
            Some((live.key, own, has))
        });
        values.collect()
    }

    /// What no key explains, in words.
    pub(crate) fn unexplained(&self) -> Option<String> {
        let names = self
            .unexplained
            .iter()
            .map(|number| format!("{number} ({})", tunable_name(*number)));
        let names: Vec<_> = names.collect();
        (!names.is_empty()).then(|| {
            format!(
                "constants of another version of the scene, or set by other means: {}",
                names.join(", ")
            )
        })
    }
}
