//! Another configuration for a board that runs, beside the same module on the PC.

use std::path::Path;

use config::AnyConfig;
use firmware::{BoardCode, Config, ConfigError, Field, encode, refusal_code};
use host_sim::Error;
use host_sim::bench::config_of;
use host_sim::classifier::Classifier;
use host_sim::loaded::Loaded;
use scene::{MotorSection, Rule, Scene};
use whisking::Real;
use wire::{Answer, CONFIG_CHANGED, Command, CommandStatus, TaggedCommand};

use crate::compare::Pair;
use crate::damaged;
use crate::deployment::{crc_of, flashed, image, staged, words};
use crate::talk::{Talk, wrong};

/// For how long both run beside each other before and after a change, s.
const PART_S: f64 = 0.5;

/// Ticks that an answer may take.
const PATIENCE: u32 = 20;

/// In the middle of a scene the board gets another configuration, word by word: from the tick that
/// takes it over on it must do what the PC does by the same, to the last bit, and miss no tick.
/// What is refused must change nothing.
pub(crate) fn tune(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let mut talk = Talk::new(Pair::new(&mut loaded, &program)?, false);
    talk.patience = PATIENCE;
    let part = talk.pair.target.ticks_of(PART_S);
    let facts = program.model()?.facts;
    let classifier = loaded.classifier()?;
    let gate = classifier.as_ref().and_then(Classifier::touch_rule);
    let gate = gate.map(|touch| touch.gate);
    let known = (gate, classifier.as_ref().map(Classifier::settings));
    let bytes_of = |scene: &Scene| -> Result<Vec<u8>, Error> {
        Ok(image(scene, loaded.model(), facts)?.bytes.to_vec())
    };
    talk.pass(part)?;
    let mut refused = Vec::new();
    for (bytes, error) in refusable(&loaded, bytes_of)? {
        refuses(&mut talk, &bytes, error)?;
        refused.push(error.to_string());
    }

    let other = other(&loaded.scene);
    let on_board = bytes_of(&other)?;
    let on_pc = match image(&other, loaded.model(), facts)?.config {
        AnyConfig::Single(_) => simulated(&config_of::<f32>(&other, known, false, "")?)?,
        AnyConfig::Fixed(_) => simulated(&config_of::<whisking::Fix>(&other, known, false, "")?)?,
    };
    let before = talk.ticks;
    let answer = give(&mut talk, &on_board)?;
    if answer.status != CommandStatus::Done {
        return wrong(format!("another configuration: {answer:?}"));
    }
    for command in staged(&on_pc) {
        let request = TaggedCommand { tag: 0, command };
        talk.requests.push((answer.sequence, request));
    }
    let took = answer.sequence - before;
    talk.pass(2 * part)?;
    runs_by(&mut talk, &on_board)?;
    talk.follow_exactly()?;
    let missed = talk.pair.target.board_mut().missed()?;
    if missed != 0 {
        return wrong(format!("{missed} ticks missed"));
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
    if let Some(classifier) = &mut other.classifier
        && let Rule::Sequential { threshold } = &mut classifier.rule
    {
        *threshold = 0.5 * (*threshold + 1.0);
    }
    other
}

fn refusable(
    loaded: &Loaded,
    bytes_of: impl Fn(&Scene) -> Result<Vec<u8>, Error>,
) -> Result<Vec<(Vec<u8>, ConfigError)>, Error> {
    let scene = &loaded.scene;
    let mut refused = damaged::configs(&bytes_of(scene)?);
    let mut named = scene.clone();
    named.name.insert(0, 'x');
    refused.push((bytes_of(&named)?, ConfigError::Shape(Field::Name)));
    let motor = scene.motor.as_ref();
    if motor.is_some_and(MotorSection::arms_at_start) {
        let mut held = scene.clone();
        held.sensor.frozen_s *= 2.0;
        refused.push((bytes_of(&held)?, ConfigError::Armed(Field::SensorLimits)));
    }
    Ok(refused)
}

fn simulated<R: Real>(config: &Config<R>) -> Result<Vec<u8>, Error> {
    let bytes = encode(config, BoardCode::Simulation);
    let bytes = bytes.map_err(|error| Error::Work(error.to_string()))?;
    Ok(bytes.to_vec())
}

/// Gives the board a configuration; what it answers in the end.
fn give(talk: &mut Talk, bytes: &[u8]) -> Result<Answer, Error> {
    let mut last = talk.ask_board(Command::Forget)?;
    for command in staged(bytes).skip(1) {
        last = talk.ask_board(command)?;
        if let Command::Stage(number, _) = command
            && (last.status, last.values[0]) != (CommandStatus::Done, i32::from(number) + 1)
        {
            return wrong(format!("{command:?}: {last:?}"));
        }
    }
    Ok(last)
}

fn refuses(talk: &mut Talk, bytes: &[u8], error: ConfigError) -> Result<(), Error> {
    let answer = give(talk, bytes)?;
    let status = match error {
        ConfigError::Armed(_) => CommandStatus::Armed,
        _ => CommandStatus::OutOfRange,
    };
    if answer.status != status || answer.values != refusal_code(error) {
        return wrong(format!("not refused ({error}): {answer:?}"));
    }
    Ok(())
}

/// The board must say that it runs by these bytes, which are others than at the start.
fn runs_by(talk: &mut Talk, bytes: &[u8]) -> Result<(), Error> {
    let crc = crc_of(bytes)?.cast_signed();
    let length = bytes.len() as i32 | CONFIG_CHANGED;
    let scene = talk.ask_board(Command::Scene)?;
    if scene.values != [crc, length] {
        return wrong(format!("it runs by another scene: {scene:?}"));
    }
    let words = words(bytes).into_iter().take(bytes.len().div_ceil(4));
    for (number, word) in words.enumerate() {
        let answer = talk.ask_board(Command::Config(number as u32))?;
        let is_read = answer.status == CommandStatus::Done;
        if !is_read || answer.values[0].cast_unsigned() != word {
            return wrong(format!("word {number}: {answer:?}"));
        }
    }
    Ok(())
}
