//! A module that is simulated: `host-sim`'s.

use std::path::Path;

use firmware::boards::NUCLEO_F446RE;
use firmware::faults::number;
use firmware::{Event, Refusal};
use host_sim::classifier::deployed;
use host_sim::loaded::Loaded;
use host_sim::origin::Origin;
use host_sim::run::Run;
use host_sim::{Error, report};
use scene::{PlantKind, Scene};
use tactile::ModelBuf;
use wire::TaggedCommand;

use super::flash::Flash;
use super::{Incoming, Source, no_board, texture};
use crate::configuration::Decides;
use crate::deployment::Deployment;

/// The world of a module whose scene has none: an elastic whisker, which moves its sensor as it is
/// swung.
const WORLD: &str = include_str!("../../../scenes/whisker.toml");

pub(crate) struct Simulated {
    loaded: Loaded,
    flash: Flash,
    pub(crate) run: Run,
    /// Of a head of several boards the one that is talked with.
    node: usize,
    /// Lines that it has logged before its first tick.
    first: Vec<String>,
}

/// Bytes for a model, as the NUCLEO-F446RE has them.
const ROOM: usize = NUCLEO_F446RE.flash.slots[0].model.bytes as usize;

impl Simulated {
    /// That of a scene file, whose flash is not kept.
    #[cfg(test)]
    pub(crate) fn of(scene: &Path) -> Result<Self, Error> {
        Self::open(Loaded::new(scene)?, Flash::open(None)?, 0)
    }

    /// The module of a scene with nothing within its whiskers' reach.
    pub(crate) fn in_the_air(scene: &Path) -> Result<Self, Error> {
        let mut loaded = Loaded::new(scene)?;
        let plant = &loaded.scene.plant;
        if plant.kind == PlantKind::Ideal || plant.obstacle.is_none() {
            let world = Scene::from_str("whisker", WORLD);
            let world = world.map_err(|fault| Error::file(scene, fault))?;
            loaded.scene.plant = world.plant;
        }
        if let Some(obstacle) = &mut loaded.scene.plant.obstacle {
            let sides = loaded.scene.head.sides.count();
            obstacle.obstacle_deg = vec![f64::INFINITY; sides];
        }
        Self::open(loaded, Flash::open(None)?, 0)
    }

    pub(super) fn open(mut loaded: Loaded, flash: Flash, node: usize) -> Result<Self, Error> {
        let flash = flash.of_size(ROOM)?;
        let mut first = Vec::new();
        if loaded.scene.awaits_model() {
            let found = deployed(flash.contents(), &loaded.scene, &NUCLEO_F446RE)?;
            first = of_model(&found);
            loaded = loaded.with_deployed(flash.name(), found.ok());
        }
        Ok(Self {
            run: run(&loaded, node)?,
            node,
            loaded,
            flash,
            first,
        })
    }
}

fn run(loaded: &Loaded, node: usize) -> Result<Run, Error> {
    let mut run = Run::new(&loaded.scene, loaded.classifier()?)?;
    run.module_mut().talk_with(node);
    Ok(run)
}

fn of_model(found: &Result<ModelBuf, Refusal>) -> Vec<String> {
    match found {
        Ok(model) => {
            let decides = Decides::By(model.crc(), model.classes() as u32);
            vec![format!("0.000 INFO  {decides}")]
        }
        Err(refusal) => {
            let limit = report::logged(0.0, &Event::Limit(number::NO_MODEL), &[], None);
            let why = format!("0.000 WARN  - {}", refusal.text());
            limit.into_iter().chain([why]).collect()
        }
    }
}

impl Source for Simulated {
    fn next(&mut self) -> Result<Incoming, Error> {
        self.run.tick();
        let mut lines = std::mem::take(&mut self.first);
        let (t_s, classes) = (self.now_s(), self.run.classes());
        let events = self.run.events().iter();
        lines.extend(events.filter_map(|event| report::logged(t_s, event, classes, None)));
        Ok(Incoming {
            packets: self.run.module_mut().take_packets(),
            lines,
            ..Incoming::default()
        })
    }

    fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        let Some(node) = node else {
            self.run.module_mut().request(request);
            return Ok(());
        };
        let is_there = self.run.module_mut().request_of(node.into(), request);
        is_there.then_some(()).ok_or_else(|| no_board(node))
    }

    fn scene(&self) -> Option<&Scene> {
        Some(&self.loaded.scene)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.run.lay(texture(sample, &self.loaded.scene, "")?);
        Ok(())
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        Ok(self.run.is_laid())
    }

    fn now_s(&mut self) -> f64 {
        self.run.row().t_s
    }

    fn origin(&self) -> Origin {
        Origin::default().with("board", "simulated")
    }

    fn deploy(&mut self, what: &Deployment) -> Result<bool, Error> {
        let Some(loaded) = &what.loaded else {
            let fault = "a simulated module is made from its scene: --scene FILE says which";
            return Err(Error::Input(fault.to_owned()));
        };
        if self.flash.is_kept() && loaded.scene.name != self.loaded.scene.name {
            let fault = "--flash keeps the model of a simulated module, and not its scene, which \
                         is that of --sim SCENE";
            return Err(Error::Input(fault.to_owned()));
        }
        let run = run(loaded, self.node)?;
        let model = what.model.as_ref();
        let bytes = model.map_or(&[][..], |model| model.as_bytes());
        self.flash.program(bytes)?;
        self.first = match model {
            _ if loaded.scene.classifier.is_none() => Vec::new(),
            Some(model) => of_model(&Ok(model.clone())),
            None => of_model(&Err(Refusal::Absent)),
        };
        self.loaded = loaded.clone();
        self.run = run;
        Ok(true)
    }
}
