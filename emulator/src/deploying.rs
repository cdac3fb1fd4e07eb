//! Scenes and models deployed to a board: right ones, wrong ones, and such as were interrupted.

mod case;

use std::path::Path;

use firmware::boards::{Region, SlotHeader, newest_first};
use firmware::{ConfigError, Header, Refusal, decode};
use host_sim::Error;
use tactile::ModelBuf;
use whisking::Fix;
use wire::{Command, CommandStatus, Load};

use crate::damaged;
use crate::deployment::Deployment;
use crate::scenario;
use crate::session::Session;
use crate::talk::wrong;
use case::{Case, Flashed, Way, load, load_watched, missing, pass, refuses, running, says, stop};

/// How long PC and board are compared, s, and how long after what changes nothing.
const COMPARED_S: f64 = 3.0;
const SHORT_S: f64 = 0.5;
/// In how long a board that was deployed to whisks, s.
const WATCHED_S: f64 = 0.5;
/// In how long its whisker touches the surface, s.
const TOUCHES_S: f64 = 2.0;
/// How long one that has a model may take to decide, s.
const PATIENCE_S: f64 = 3.0;

/// Deploys the scene with the model in `model` to a board that has it without, by a probe and by
/// the serial port: PC and board must then agree to the last bit, in decisions too, as they must
/// before. What was interrupted after any word, and configurations that are wrong, must leave the
/// scene before, and what is wrong must be refused with its reason: configurations before
/// anything is written, too. Returns what was seen, a line each.
pub(crate) fn deploying(
    on: &scenario::Flashed,
    world: &Path,
    model: &Path,
) -> Result<Vec<String>, Error> {
    let case = Case::new(on, world, model)?;
    let mut lines = Vec::new();
    let without = case.agree(&case.old, &case.old.flash, COMPARED_S)?;
    lines.push(format!("without a model: {without}"));
    let with = case.agree(&case.new, &case.new.flash, COMPARED_S)?;
    lines.push(format!("with a model: {with}"));
    if without.decisions != 0 || with.decisions == 0 {
        return wrong(lines.join("\n"));
    }
    lines.push(case.refuses_to_load()?);
    let words = case.new.deployment.load().words() as usize;
    for (way, written) in [
        (Way::Probe, 0),
        (Way::Serial, words / 8),
        (Way::Probe, words - 1),
    ] {
        case.keeps(way, &case.new.deployment, written, None)?;
        lines.push(format!(
            "{written} of {words} words written: the scene before runs, as on the PC"
        ));
    }
    for (config, error) in case.wrong_configs()? {
        let wrong = Deployment {
            config,
            model: Vec::new(),
        };
        let said = case.keeps(Way::Probe, &wrong, usize::MAX, Some(error))?;
        lines.push(format!("{said}; the scene before runs, as on the PC"));
    }
    for (what, model, why) in damaged::models(&case.new.deployment.model, case.facts()?)? {
        lines.push(format!("{what}: {}", case.refuses(&model, why)?));
    }
    lines.push(case.refuses_another()?);
    lines.extend(case.decides()?);
    Ok(lines)
}

impl Case<'_> {
    /// Nothing is loaded while a motor is armed, nor what there is no room for.
    fn refuses_to_load(&self) -> Result<String, Error> {
        let right = self.new.deployment.load();
        let program = self.with(&self.old.flash)?;
        let mut session = Session::of(&self.old.loaded.scene, Vec::new(), &program)?;
        session.must(Command::Load(right), CommandStatus::Armed)?;
        pass(&mut session, 0.5)?;
        let is_driven = session.drives();
        session.must(Command::Load(right), CommandStatus::Armed)?;
        let mut session = self.stopped(Way::Probe)?;
        let [slot, _] = self.facts()?.flash.slots;
        let room = Load {
            config: slot.config().words() as u16,
            model: slot.model.words() as u16,
        };
        let with_config = |config| Load { config, ..right };
        let with_model = |model| Load { model, ..right };
        for load in [
            with_config(0),
            with_config(4),
            with_config(right.config + 1),
            with_config(room.config + 2),
            with_config(u16::MAX),
            with_model(room.model + 2),
            with_model(u16::MAX),
        ] {
            session.must(Command::Load(load), CommandStatus::OutOfRange)?;
        }
        session.must(Command::Word(0, 0), CommandStatus::NotHere)?;
        session.must(Command::Restart, CommandStatus::NotHere)?;
        for (config, error) in self.wrong_configs()? {
            refuses(&mut session, &config, error)?;
        }
        let is_as_before = session.flash()? == self.old.flash;
        if !is_driven || !is_as_before || running(&mut session)? != self.old.crc()? {
            return missing("the scene before runs on", &session.log());
        }
        Ok(format!(
            "nothing is loaded while a motor is armed, or of more than {} and {} words, and what is \
             wrong is refused before it is written",
            room.config, room.model
        ))
    }

    /// A board that gets so many words of something, with which there is this wrong, whisks on by
    /// the scene before, and does so as the PC does; what its log says of it.
    fn keeps(
        &self,
        way: Way,
        what: &Deployment,
        words: usize,
        wrong: Option<ConfigError>,
    ) -> Result<String, Error> {
        let mut session = self.stopped(way)?;
        load(&mut session, what, words)?;
        let (lines, driven) = pass(&mut session, WATCHED_S)?;
        let is_old = running(&mut session)? == self.old.crc()?;
        let text = wrong.map(|error| error.to_string()).unwrap_or_default();
        // Of a version the log says no more than that it is another.
        let text = text.split(',').next().unwrap_or_default();
        let said = lines.iter().find(|line| line.contains("slot B: "));
        let said = said.map_or("", |line| line);
        if !driven || !is_old || !said.contains(text) {
            let what = format!("the scene before runs, and the log says why: {text}");
            return missing(&what, &lines);
        }
        self.agree(&self.old, &session.flash()?, SHORT_S)?;
        Ok(text.to_owned())
    }

    /// A board that has a scene with a model that is wrong runs it, and refuses the model: it
    /// whisks and decides nothing.
    fn refuses(&self, model: &[u8], refusal: Refusal) -> Result<String, Error> {
        let mut program = self.with(&self.new.flash)?;
        let wrong = Deployment {
            model: model.to_vec(),
            ..self.new.deployment.clone()
        };
        wrong.flash(&mut program)?;
        let session = Session::of(&self.new.loaded.scene, Vec::new(), &program)?;
        self.has_refused(session, refusal)
    }

    fn has_refused(&self, mut session: Session, refusal: Refusal) -> Result<String, Error> {
        let (lines, driven) = pass(&mut session, TOUCHES_S)?;
        let has = |what: &str| lines.iter().any(|line| line.contains(what));
        if !driven || !says(&lines, refusal) || !has("touch ") || has("decision") {
            return missing(refusal.text(), &lines);
        }
        let answer = session.ask(Command::Model)?.values;
        if answer != [0, -i32::from(refusal.code())] || running(&mut session)? != self.new.crc()? {
            return wrong(format!("{refusal:?}: answered {answer:?}"));
        }
        Ok(refusal.text().to_owned())
    }

    /// A board whose model is not the one that its scene was deployed with refuses it.
    fn refuses_another(&self) -> Result<String, Error> {
        let mut program = self.with(&self.new.flash)?;
        let [slot, _] = self.facts()?.flash.slots;
        let header = SlotHeader::linked(!self.new.deployment.model_crc());
        program.add(slot.head.start, &header.bytes())?;
        let session = Session::of(&self.new.loaded.scene, Vec::new(), &program)?;
        let said = self.has_refused(session, Refusal::Other)?;
        Ok(format!("another: {said}"))
    }

    /// The CRC of the configuration by which a board starts whose flash is so.
    fn newest(&self, flash: &[u8]) -> Result<Option<u32>, Error> {
        let facts = self.facts()?;
        let first = self.program.scenes()?.start;
        let at = |region: Region| {
            let from = flash.get((region.start - first) as usize..);
            let bytes = from.and_then(|from| from.get(..region.bytes as usize));
            bytes.unwrap_or_default()
        };
        let slots = facts.flash.slots;
        let headers = slots.map(|slot| SlotHeader::of(at(slot.head)));
        let is_valid = |bytes: &&[u8]| {
            if facts.has_fpu {
                decode::<f32>(bytes, facts.code).is_ok()
            } else {
                decode::<Fix>(bytes, facts.code).is_ok()
            }
        };
        let present = newest_first(headers).into_iter();
        let present = present.filter(|slot| headers[*slot].is_some());
        let config = present.map(|slot| at(slots[slot].config())).find(is_valid);
        Ok(config.and_then(|bytes| Some(Header::of(bytes).ok()?.crc)))
    }

    /// A board that gets the scene with its model: it starts by that once the last word is
    /// written, and by the scene before wherever it is cut off.
    fn loaded(&self, way: Way) -> Result<Session, Error> {
        let mut session = self.stopped(way)?;
        let words = self.new.deployment.load().words() as usize;
        let watch = |session: &mut Session, written| {
            let expected = if written < words {
                &self.old
            } else {
                &self.new
            };
            if self.newest(&session.flash()?)? == Some(expected.crc()?) {
                return Ok(());
            }
            wrong(format!(
                "{way:?}: another scene after {written} of {words} words"
            ))
        };
        load_watched(&mut session, &self.new.deployment, usize::MAX, watch)?;
        Ok(session)
    }

    /// A board that gets the scene with its model decides by it, and does all as the PC does; a
    /// second deployment that is cut off leaves it, where each slot has a model of its own.
    fn decides(&self) -> Result<[String; 3], Error> {
        let by_serial = self.loaded(Way::Serial)?.flash()?;
        let mut session = self.loaded(Way::Probe)?;
        if session.flash()? != by_serial {
            return wrong("the serial port and a probe leave different scenes");
        }
        let right = &self.new.deployment;
        let model = ModelBuf::from_bytes(&right.model);
        let model = model.map_err(|error| Error::Work(error.to_string()))?;
        let (lines, _) = pass(&mut session, PATIENCE_S)?;
        let [crc, classes] = session.ask(Command::Model)?.values;
        let is_it = crc.cast_unsigned() == model.crc() && classes as usize == model.classes();
        let is_named = |line: &&String| {
            let mut names = model.names().chain(["unknown"]);
            names.any(|name| line.contains(&format!("decision left {name} ")))
        };
        let by = format!("decides by model {:08x}", model.crc());
        let has = lines.iter().any(|line| line.contains(&by));
        let first = match lines.iter().find(is_named) {
            Some(line) if is_it && has && running(&mut session)? == self.new.crc()? => line,
            _ => return missing(&by, &lines),
        };
        let deployed = self.agree(&self.new, &session.flash()?, COMPARED_S)?;

        stop(&mut session)?;
        stays_off(&mut session)?;
        // In the middle of the model, which comes first.
        load(&mut session, right, usize::from(right.load().model / 2))?;
        pass(&mut session, SHORT_S)?;
        if running(&mut session)? != self.new.crc()? {
            return missing("the deployed scene runs on", &session.log());
        }
        let [slot, _] = self.facts()?.flash.slots;
        let left = if slot.has_model() {
            &self.new
        } else {
            &self.old
        };
        let left = Flashed {
            loaded: left.loaded.clone(),
            deployment: right.clone(),
            flash: session.flash()?,
        };
        let again = self.agree(&left, &left.flash, COMPARED_S)?;
        if (again.decisions > 0) != slot.has_model() {
            return missing("the deployed scene has its model or not", &[]);
        }
        Ok([
            format!("deployed: {by}, first {first}"),
            format!(
                "deployed by the serial port and by a probe, the scene before after each word but \
                 the last: {deployed}"
            ),
            format!("deployed again, cut off in the middle of the model: {again}"),
        ])
    }
}

/// A board that somebody has armed and stopped since its deployment arms nothing as the supply comes
/// back, which its scene would do as it comes first.
fn stays_off(session: &mut Session) -> Result<(), Error> {
    session.bear_resets(true);
    let board = session.board_mut();
    board.set_power(false)?;
    board.set_power(true)?;
    let (lines, driven) = pass(session, WATCHED_S)?;
    session.bear_resets(false);
    if driven {
        return missing("what somebody has stopped is off", &lines);
    }
    Ok(())
}
