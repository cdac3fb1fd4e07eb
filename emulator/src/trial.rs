//! A scene on a board against what befalls it at certain times, as a file lists it; what became of
//! it is one JSON object. docs/boards.md lists kinds and keys.

mod figures;
mod file;
mod hands;
mod head;
mod links;
mod said;
mod staging;

use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::Error;
use host_sim::loaded::Loaded;
use host_sim::output::{self, write_whole};
use scene::{PlantKind, Scene};
use serde::Serialize;

use crate::deployment::flashed;
use crate::session::Session;
use crate::watch::Servos;
use figures::{Figures, Outcome};
use file::{Scenario, What};
pub(crate) use hands::Hands;
use links::Links;
use said::Lister;

/// Which scene runs against what.
#[derive(Debug, Args)]
pub(crate) struct Choice {
    /// The scene file
    scene: PathBuf,
    /// The program: built for it, or for any scene; none: the files are read, and nothing runs
    #[arg(long, value_name = "ELF")]
    program: Option<PathBuf>,
    /// What befalls it, a list of `[[event]]`
    #[arg(long, value_name = "FILE")]
    scenario: PathBuf,
    /// The scene in whose world it runs; none: its own, or, where its plant is ideal, the same
    /// with a simulated motor
    #[arg(long, value_name = "SCENE")]
    world: Option<PathBuf>,
    /// Where to write what became of it
    #[arg(long, value_name = "FILE")]
    json: PathBuf,
}

impl Choice {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let scenario = Scenario::load(&self.scenario)?;
        output::check(&self.json)?;
        let Some(program) = &self.program else {
            let loaded = self.placed(Loaded::new(&self.scene)?, &scenario)?;
            return scenario.fits(&self.scenario, &loaded.scene);
        };
        let (loaded, program) = flashed(&self.scene, program)?;
        let loaded = self.placed(loaded, &scenario)?;
        scenario.fits(&self.scenario, &loaded.scene)?;
        if let Some(bus) = config::bus(&loaded.scene) {
            return self.write(&head::run(&loaded, bus, &program, &scenario)?);
        }
        let session = Session::running(&loaded.scene, loaded.classes()?, &program)?;
        let servos = Servos::new(&program, &loaded.scene)?;
        let facts = program.model()?.facts;
        let stage = |change| staging::frames(change, &loaded, facts);
        let links = Links::new(&scenario, &loaded.scene, stage)?;
        self.write(&run(session, &servos, &loaded.scene, (&scenario, links))?)
    }

    fn write(&self, outcome: &impl Serialize) -> Result<(), Error> {
        let json = serde_json::to_string_pretty(outcome);
        let json = json.map_err(|error| Error::Work(error.to_string()))?;
        write_whole(&self.json, (json + "\n").as_bytes())
    }

    /// The scene in its world, for as long and with the seed as the scenario has it.
    fn placed(&self, mut loaded: Loaded, scenario: &Scenario) -> Result<Loaded, Error> {
        if let Some(world) = &self.world {
            loaded = loaded.in_world(world)?;
        }
        let scene = &mut loaded.scene;
        if scene.plant.kind == PlantKind::Ideal && scene.whisking.is_some() {
            scene.plant.kind = PlantKind::Textured;
        }
        scene.duration_s = scenario.duration_s.unwrap_or(scene.duration_s);
        scene.seed = scenario.seed.unwrap_or(scene.seed);
        Ok(loaded)
    }
}

fn run(
    mut session: Session,
    servos: &Servos,
    scene: &Scene,
    (scenario, mut links): (&Scenario, Links<'_>),
) -> Result<Outcome, Error> {
    session.bear_resets(true);
    let mut hands = Hands::new(scenario, scene);
    let mut lister = Lister::default();
    let mut figures = Figures::new(scene);
    for _ in 0..session.run.ticks() {
        let t_s = session.run.t_s();
        hands.act(t_s, &mut session)?;
        links.send(t_s, &mut session)?;
        session.pass_tick()?;
        // While no tick ends time passes as fast as it should; ticks are not equally long.
        let period = session.period();
        let board = session.board_mut();
        let was_reset = board.reset.take().is_some() || hands.has_cut;
        let waits = if board.is_late {
            period
        } else {
            period * 3 / 2
        };
        board.world_waits = Some(waits);
        let arrived = links.arrived(&mut session);
        let (t_s, lines) = (session.run.t_s(), session.log());
        lister.hear(t_s, &lines, session.board_mut())?;
        if was_reset {
            lister.list_reset(t_s);
        }
        figures.look(&mut session, servos, was_reset, arrived)?;
    }
    Ok(figures.outcome(lister))
}

/// What befalls a board of `scene` that somebody else talks with, by a file: its times are the
/// board's, its duration and seed do not count.
pub(crate) fn befalling(path: &Path, scene: &Scene) -> Result<Hands, Error> {
    let scenario = Scenario::load(path)?;
    scenario.fits(path, scene)?;
    let is_sent = |what: &What| {
        matches!(
            what,
            What::Serial { .. } | What::Probe { .. } | What::Configuration { .. }
        )
    };
    if scenario.events.iter().any(|event| is_sent(&event.what)) {
        let fault = "found an event that sends something, but whoever talks with the board does";
        return Err(Error::file(path, fault));
    }
    Ok(Hands::new(&scenario, scene))
}
