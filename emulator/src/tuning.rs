//! Another configuration for a board that runs, beside the same module on the PC.

use std::collections::VecDeque;
use std::path::Path;

use config::AnyConfig;
use firmware::{BoardCode, Config, ConfigError, Field, Packet, encode, refusal_code};
use host_sim::Error;
use host_sim::bench::config_of;
use host_sim::classifier::Classifier;
use host_sim::loaded::Loaded;
use scene::{Arm, Rule, Scene};
use whisking::Real;
use wire::{Answer, CONFIG_CHANGED, Command, CommandStatus, TaggedCommand};

use crate::compare::{Pair, Seen};
use crate::damaged;
use crate::deployment::{flashed, image, model_of, words};

/// For how long both run beside each other before and after a change, s.
const PART_S: f64 = 0.5;

/// Ticks that an answer may take.
const PATIENCE: u32 = 20;

/// A board and a PC, tick by tick.
struct Talk {
    pair: Pair,
    /// Ticks of the PC, and those of the board after them.
    ticks: u64,
    ahead: VecDeque<Seen>,
    tag: u16,
    part: u32,
}

/// Has the board in the middle of the scene in `path` go on by another configuration, sent word
/// by word: from the tick that takes it over on it must do what the PC does by the same, to the
/// last bit, and miss no tick. What is refused must change nothing. Returns what was found.
///
/// # Errors
/// [`Error::Work`] says what was otherwise.
pub(crate) fn tune(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let mut talk = Talk {
        pair: Pair::new(&mut loaded, &program)?,
        ticks: 0,
        ahead: VecDeque::new(),
        tag: 0x4000,
        part: (PART_S * f64::from(loaded.scene.tick_hz)) as u32,
    };
    let facts = program.model()?.facts;
    let gate = loaded
        .classifier()?
        .as_ref()
        .and_then(Classifier::touch_rule);
    let gate = gate.map(|touch| touch.gate);
    let model = model_of(&loaded.scene, path)?;
    let bytes_of = |scene: &Scene| -> Result<Vec<u8>, Error> {
        Ok(image(scene, model.as_ref(), facts)?.bytes.to_vec())
    };
    talk.pass(talk.part)?;
    let mut refused = Vec::new();
    for (bytes, error) in wrong(&loaded, bytes_of)? {
        talk.refuses(&bytes, error)?;
        refused.push(error.to_string());
    }

    let other = other(&loaded.scene);
    let on_board = bytes_of(&other)?;
    let on_pc = match image(&other, model.as_ref(), facts)?.config {
        AnyConfig::Single(_) => simulated(&config_of::<f32>(&other, gate, false, "")?)?,
        AnyConfig::Fixed(_) => simulated(&config_of::<whisking::Fix>(&other, gate, false, "")?)?,
    };
    let before = talk.ticks;
    talk.stage(&on_board)?;
    talk.request_on_pc(Command::Forget);
    for (number, word) in words(&on_pc).into_iter().enumerate() {
        talk.request_on_pc(Command::Stage(number as u8, word));
    }
    let apply = Command::Apply(on_board.len() as u32);
    let answer = talk.ask(apply)?;
    if answer.status != CommandStatus::Done {
        return Err(Error::Work(format!("another configuration: {answer:?}")));
    }
    talk.request_on_pc(Command::Apply(on_pc.len() as u32));
    let took = talk.ticks - before;
    talk.pass(2 * talk.part)?;
    talk.runs_by(&on_board)?;
    talk.follow(u64::MAX)?;
    let missed = talk.pair.target.module_mut().board.missed()?;
    if missed != 0 {
        return Err(Error::Work(format!("{missed} ticks missed")));
    }
    Ok(vec![
        format!("refused, and nothing changed: {}", refused.join("; ")),
        format!(
            "another configuration of {} bytes taken over after {took} ticks: PC and board agree \
             to the last bit in {} ticks, none missed",
            on_board.len(),
            talk.ticks
        ),
    ])
}

/// The same scene with other numbers.
fn other(scene: &Scene) -> Scene {
    let mut other = scene.clone();
    if let Some(whisking) = &mut other.whisking {
        whisking.frequency_hz *= 1.25;
    } else {
        other.sensor.frozen_s *= 2.0;
    }
    if let Some(rcp) = &mut other.rcp {
        rcp.gain *= 0.5;
    }
    let rule = other
        .classifier
        .as_mut()
        .map(|classifier| &mut classifier.rule);
    if let Some(Rule::Sequential { threshold }) = rule {
        *threshold = 0.5 * (*threshold + 1.0);
    }
    other
}

/// Configurations that the board must refuse, and why.
fn wrong(
    loaded: &Loaded,
    bytes_of: impl Fn(&Scene) -> Result<Vec<u8>, Error>,
) -> Result<Vec<(Vec<u8>, ConfigError)>, Error> {
    let scene = &loaded.scene;
    let mut wrong = damaged::configs(&bytes_of(scene)?);
    let mut named = scene.clone();
    named.name.insert(0, 'x');
    wrong.push((bytes_of(&named)?, ConfigError::Shape(Field::Name)));
    let is_armed = scene
        .motor
        .as_ref()
        .is_some_and(|motor| motor.arm == Arm::AtStart);
    if is_armed {
        let mut held = scene.clone();
        held.sensor.frozen_s *= 2.0;
        wrong.push((bytes_of(&held)?, ConfigError::Armed(Field::SensorLimits)));
    }
    Ok(wrong)
}

/// A configuration as the PC takes it.
fn simulated<R: Real>(config: &Config<R>) -> Result<Vec<u8>, Error> {
    let bytes = encode(config, BoardCode::Simulation);
    let bytes = bytes.map_err(|error| Error::Work(error.to_string()))?;
    Ok(bytes.to_vec())
}

impl Talk {
    /// A tick of the board; what it has answered.
    fn tick(&mut self) -> Result<Vec<Answer>, Error> {
        self.ahead.push_back(self.pair.tick_board()?);
        let packets = self.pair.target.module_mut().board.packets()?;
        let answers = packets.into_iter().filter_map(|packet| match packet {
            Packet::Answer(answer) => Some(answer),
            Packet::Record(_) | Packet::Event(_) => None,
        });
        Ok(answers.collect())
    }

    /// The PC follows up to this tick: each must be the same.
    fn follow(&mut self, to: u64) -> Result<(), Error> {
        while self.ticks < to
            && let Some(seen) = self.ahead.pop_front()
        {
            self.ticks += 1;
            self.pair.follow(self.ticks, seen, |number| number)?;
        }
        Ok(())
    }

    fn pass(&mut self, ticks: u32) -> Result<(), Error> {
        (0..ticks).try_for_each(|_| self.tick().map(drop))?;
        self.follow(u64::MAX)
    }

    /// Asks the board for something; the PC has followed up to the tick after which that was
    /// done.
    fn ask(&mut self, command: Command) -> Result<Answer, Error> {
        self.tag += 1;
        let request = TaggedCommand {
            tag: self.tag,
            command,
        };
        let board = &mut self.pair.target.module_mut().board;
        if !board.request(&wire::frame(&request))? {
            return Err(Error::Work(format!("{command:?}: no room for it")));
        }
        for _ in 0..PATIENCE {
            let answers = self.tick()?;
            if let Some(answer) = answers.into_iter().find(|answer| answer.tag == self.tag) {
                self.follow(answer.sequence.into())?;
                return Ok(answer);
            }
        }
        Err(Error::Work(format!("{command:?}: no answer")))
    }

    /// The same of the PC, before its next tick.
    fn request_on_pc(&mut self, command: Command) {
        let module = self.pair.host.module_mut();
        module.request(TaggedCommand { tag: 0, command });
    }

    /// Has the board put a configuration aside.
    fn stage(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.ask(Command::Forget)?;
        for (number, word) in words(bytes).into_iter().enumerate() {
            let command = Command::Stage(number as u8, word);
            let answer = self.ask(command)?;
            let is_next = answer.values[0] as usize == number + 1;
            if answer.status != CommandStatus::Done || !is_next {
                return Err(Error::Work(format!("{command:?}: {answer:?}")));
            }
        }
        Ok(())
    }

    /// The board refuses a configuration for this reason.
    fn refuses(&mut self, bytes: &[u8], error: ConfigError) -> Result<(), Error> {
        self.stage(bytes)?;
        let answer = self.ask(Command::Apply(bytes.len() as u32))?;
        let status = match error {
            ConfigError::Armed(_) => CommandStatus::Armed,
            _ => CommandStatus::OutOfRange,
        };
        if answer.status != status || answer.values != refusal_code(error) {
            return Err(Error::Work(format!("not refused ({error}): {answer:?}")));
        }
        Ok(())
    }

    /// The board must say that it runs by these bytes, which are others than at the start.
    fn runs_by(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let crc = words(bytes).get(3).map_or(0, |crc| crc.cast_signed());
        let length = bytes.len() as i32 | CONFIG_CHANGED;
        let scene = self.ask(Command::Scene)?;
        if scene.values != [crc, length] {
            return Err(Error::Work(format!("it runs by another scene: {scene:?}")));
        }
        let words = words(bytes).into_iter().take(bytes.len().div_ceil(4));
        for (number, word) in words.enumerate() {
            let answer = self.ask(Command::Config(number as u32))?;
            let is_read = answer.status == CommandStatus::Done;
            if !is_read || answer.values[0].cast_unsigned() != word {
                return Err(Error::Work(format!("word {number}: {answer:?}")));
            }
        }
        Ok(())
    }
}
