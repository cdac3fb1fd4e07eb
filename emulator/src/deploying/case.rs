//! A board that has a scene without a model, to which the same scene is deployed with one, by
//! requests to its loader.

use std::path::Path;

use firmware::boards::BoardFacts;
use firmware::{ConfigError, Part, Refusal, refusal_code};
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::{Integrator, SensorModel};
use wire::{Command, CommandStatus, WhiskerId};

use crate::compare::{Agreement, Circumstances, compare};
use crate::damaged;
use crate::deployment::{Deployment, crc_of, flashed_for, staged};
use crate::program::Program;
use crate::scenario;
use crate::session::{PATIENCE, Session};
use crate::talk::wrong;

/// How long a whisker takes to come to rest, s.
const TO_REST_S: f64 = 0.3;

pub(super) struct Flashed {
    pub(super) loaded: Loaded,
    pub(super) deployment: Deployment,
    pub(super) flash: Vec<u8>,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Way {
    Probe,
    Serial,
}

pub(super) struct Case<'p> {
    pub(super) path: &'p Path,
    pub(super) program: Program,
    /// Whether the program brings its scene with it, and so was built of the parts of that.
    is_lean: bool,
    pub(super) old: Flashed,
    pub(super) new: Flashed,
}

/// Lets time pass; the lines that the board has logged, and whether a motor was driven.
pub(super) fn pass(session: &mut Session, seconds: f64) -> Result<(Vec<String>, bool), Error> {
    let begun = session.now_s();
    let (mut lines, mut driven) = (Vec::new(), false);
    while session.now_s() - begun < seconds {
        session.tick()?;
        lines.extend(session.log());
        driven |= session.drives();
    }
    Ok((lines, driven))
}

pub(super) fn missing<T>(what: &str, lines: &[String]) -> Result<T, Error> {
    wrong(format!("not so: {what}\n  {}", lines.join("\n  ")))
}

pub(super) fn says(lines: &[String], refusal: Refusal) -> bool {
    let at = lines.iter().position(|line| line.contains("limit 34 "));
    let why = at.and_then(|at| lines.get(at + 1));
    why.is_some_and(|line| line.contains(refusal.text()))
}

/// The CRC of the configuration that a board runs by.
pub(super) fn running(session: &mut Session) -> Result<u32, Error> {
    Ok(session.ask(Command::Scene)?.values[0].cast_unsigned())
}

/// Stops a board that whisks, once its whisker is at rest: that is where it starts from.
pub(super) fn stop(session: &mut Session) -> Result<(), Error> {
    session.ask(Command::Setpoint(WhiskerId::default(), 0))?;
    pass(session, TO_REST_S)?;
    session.ask(Command::Stop)?;
    session.tick()
}

impl Flashed {
    pub(super) fn new(loaded: Loaded, program: &Program) -> Result<Self, Error> {
        let facts = program.model()?.facts;
        let deployment = Deployment::of(&loaded.scene, loaded.model(), facts)?;
        let mut program = program.clone();
        deployment.flash(&mut program)?;
        Ok(Self {
            flash: Session::of(&loaded.scene, Vec::new(), &program)?.flash()?,
            loaded,
            deployment,
        })
    }

    pub(super) fn crc(&self) -> Result<u32, Error> {
        crc_of(&self.deployment.config)
    }
}

impl<'p> Case<'p> {
    pub(super) fn new(
        on: &'p scenario::Flashed,
        world: &Path,
        model: &Path,
    ) -> Result<Self, Error> {
        let path = &on.scene;
        let old = Loaded::new(path)?.in_world(world)?;
        let new = old.clone().with_model(model)?;
        let program = flashed_for(&old, &on.program)?;
        Ok(Self {
            path,
            is_lean: Program::load(&on.program)?.brings_scene()?,
            old: Flashed::new(old, &program)?,
            new: Flashed::new(new, &program)?,
            program,
        })
    }

    pub(super) fn facts(&self) -> Result<&'static BoardFacts, Error> {
        Ok(self.program.model()?.facts)
    }

    pub(super) fn with(&self, flash: &[u8]) -> Result<Program, Error> {
        let mut program = self.program.clone();
        program.add(program.scenes()?.start, flash)?;
        Ok(program)
    }

    /// PC and board must agree about a scene, where the board's flash is so.
    pub(super) fn agree(
        &self,
        scene: &Flashed,
        flash: &[u8],
        seconds: f64,
    ) -> Result<Agreement, Error> {
        let mut loaded = scene.loaded.clone();
        loaded.scene.duration_s = seconds;
        let program = self.with(flash)?;
        compare(loaded, self.path, &program, Circumstances::default())
    }

    /// Configurations that a board must refuse; to one whose image has the parts of its scene alone,
    /// that of another integrator is one, to one for any scene that of a sensor which it does not
    /// read.
    pub(super) fn wrong_configs(&self) -> Result<Vec<(Vec<u8>, ConfigError)>, Error> {
        let mut wrong = damaged::configs(&self.new.deployment.config);
        let mut scene = self.old.loaded.scene.clone();
        let mut part = None;
        if !self.is_lean {
            scene.sensor.model = SensorModel::Tmag5170;
            part = Some(Part::Tmag5170);
        } else if let Some(whisking) = &mut scene.whisking {
            let (other, of_other) = match whisking.integrator {
                Integrator::Exact => (Integrator::Euler, Part::Euler),
                Integrator::Euler => (Integrator::Exact, Part::Exact),
            };
            whisking.integrator = other;
            part = Some(of_other);
        }
        let config = Deployment::of(&scene, None, self.facts()?)?.config;
        wrong.extend(part.map(|part| (config, ConfigError::NotBuilt(part))));
        Ok(wrong)
    }

    /// A board with the old scene whose motor was on, and is off, its whisker at rest.
    pub(super) fn stopped(&self, way: Way) -> Result<Session, Error> {
        let program = self.with(&self.old.flash)?;
        let mut session = Session::of(&self.old.loaded.scene, Vec::new(), &program)?;
        if let Way::Serial = way {
            session = session.by_serial();
        }
        let (lines, driven) = pass(&mut session, 0.5)?;
        if !driven || !says(&lines, Refusal::Absent) {
            return missing("a board without a model whisks", &lines);
        }
        stop(&mut session)?;
        Ok(session)
    }
}

/// Sends a configuration that the board puts aside, and must refuse for this reason; nothing is
/// written.
pub(super) fn refuses(
    session: &mut Session,
    config: &[u8],
    error: ConfigError,
) -> Result<(), Error> {
    for command in staged(config) {
        if !matches!(command, Command::Apply(_)) {
            session.must(command, CommandStatus::Done)?;
            continue;
        }
        let answer = session.ask(command)?;
        if answer.status != CommandStatus::OutOfRange || answer.values != refusal_code(error) {
            return wrong(format!("not refused ({error}): {answer:?}"));
        }
    }
    Ok(())
}

/// Has a board whose motors are off load a scene and its model, of which only so many `words`
/// come: then there are no more requests, and it starts again by itself. Then somebody arms it.
pub(super) fn load(session: &mut Session, what: &Deployment, words: usize) -> Result<(), Error> {
    load_watched(session, what, words, |_, _| Ok(()))
}

/// Ticks for which a board that was reset drives nothing before it is armed.
const WAITS: u32 = 200;

fn arm(session: &mut Session) -> Result<(), Error> {
    for _ in 0..WAITS {
        session.tick()?;
        if session.drives() {
            return wrong("a board arms its motors by itself after a reset");
        }
    }
    session.must(Command::Arm, CommandStatus::Done)
}

/// As [`load`]; `watch` looks at it after each word, with the number of those that were written.
pub(super) fn load_watched(
    session: &mut Session,
    what: &Deployment,
    words: usize,
    mut watch: impl FnMut(&mut Session, usize) -> Result<(), Error>,
) -> Result<(), Error> {
    let count = what.load().words() as usize;
    session.bear_resets(true);
    session.must(Command::Load(what.load()), CommandStatus::Done)?;
    watch(session, 0)?;
    for (number, word) in what.words().take(words).enumerate() {
        let command = Command::Word(number as u8, word);
        session.must(command, CommandStatus::Done)?;
        if number == 0 {
            // Its answer was lost, and then one of a word that is not next.
            session.must(command, CommandStatus::Done)?;
            let other = Command::Word(number as u8, !word);
            session.must(other, CommandStatus::OutOfRange)?;
            session.must(Command::Arm, CommandStatus::NotHere)?;
        }
        watch(session, number + 1)?;
    }
    if session.drives() {
        return wrong("a motor is driven while a scene is loaded");
    }
    if words >= count {
        session.must(Command::Restart, CommandStatus::Done)?;
    }
    for _ in 0..PATIENCE {
        session.tick()?;
        if session.was_reset() {
            session.bear_resets(false);
            return arm(session);
        }
    }
    wrong("a board does not start again after loading")
}
