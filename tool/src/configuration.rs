//! The configuration that a module runs by: read back, made from a scene, changed, and sent.

mod program;
mod runs_by;

use config::{RunsOn, Target};
use firmware::{
    BoardCode, ConfigBytes, ConfigError, HeadConfig, Header, Links, Part, decode, encode,
    refusal_of,
};
use host_sim::Error;
use mlx90333::Decoder;
use scene::Scene;
use serde_json::Value;
use tactile::ClassList;
use whisking::Real;
use whisking::motor::Duty;
use wire::{Command, CommandStatus};

use crate::conversation::Conversation;

pub(crate) use program::Program;
pub(crate) use runs_by::{Decides, RunsBy};

/// `function::<R>(arguments)` in a number format.
macro_rules! in_format {
    ($format:expr, $function:ident($($argument:expr),* $(,)?)) => {
        match $format {
            ::whisking::FormatCode::Single => $function::<f32>($($argument),*),
            ::whisking::FormatCode::Double => $function::<f64>($($argument),*),
            ::whisking::FormatCode::Fixed => $function::<::whisking::Fix>($($argument),*),
        }
    };
}
pub(crate) use in_format;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Running {
    program: Program,
    bytes: Vec<u8>,
    /// The CRC-32 by which a module names it.
    pub(crate) crc: u32,
    pub(crate) head: HeadConfig,
    pub(crate) links: Links,
    /// How frames of an MLX90333 are read.
    pub(crate) decoder: Decoder,
    /// Least time between two frames of one, µs, and whether it is in its slow mode.
    pub(crate) rest_us: u16,
    pub(crate) has_slow_sensors: bool,
    pub(crate) has_motor: bool,
    pub(crate) decides: bool,
    contact_min: Option<f64>,
    pub(crate) classes: ClassList,
}

/// What has become of a configuration that was sent to a module.
pub(crate) enum Taken {
    Runs,
    Refused(ConfigError),
    /// Its image was built without taking any ([`firmware::Part::Set`]).
    NotBuilt,
}

/// What to do about an image that was built without this.
pub(crate) const fn builds(part: Part) -> &'static str {
    match part {
        Part::Tmag5170 => "cargo xtask firmware --scene SCENE builds one that reads it",
        // A program for any scene has no room for it on each board.
        Part::SelfMotion => "cargo xtask firmware --scene SCENE builds one that has it",
        _ => "cargo xtask firmware --any-scene builds one that has it",
    }
}

pub(crate) fn not_built(part: Part) -> Error {
    Error::Work(format!(
        "the module's image was built without {part}; {}",
        builds(part)
    ))
}

fn read<R: Real>(program: Program, bytes: Vec<u8>) -> Result<Running, ConfigError> {
    let config = decode::<R>(&bytes, program.board)?;
    let classifier = config.classifier.as_ref();
    Ok(Running {
        crc: Header::of(&bytes)?.crc,
        decides: classifier.is_some_and(|of| of.rule.is_some()),
        contact_min: classifier.and_then(|of| of.contact_min.map(Real::to_f64)),
        classes: config.classes,
        head: config.head,
        links: config.links,
        decoder: config.sensor.decoder,
        rest_us: config.sensor.rest_us,
        has_slow_sensors: config.sensor.kind.is_slow(),
        has_motor: config.motion.is_some(),
        program,
        bytes,
    })
}

fn built<R: Real>(
    scene: &Scene,
    target: Target<'_>,
    board: BoardCode,
) -> Result<ConfigBytes, config::Mismatch> {
    Ok(encode(&config::build::<R>(scene, target)?, board)?)
}

fn may_become<R: Real>(old: &Running, new: &Running) -> Result<(), ConfigError> {
    let board = old.program.board;
    let new = decode::<R>(&new.bytes, board)?;
    decode::<R>(&old.bytes, board)?.may_become(&new, false)
}

fn gentle<R: Real>(of: &Running, most: f64) -> Result<ConfigBytes, ConfigError> {
    let board = of.program.board;
    let mut config = decode::<R>(&of.bytes, board)?;
    if let Some(motion) = &mut config.motion {
        let servo = &mut motion.servo;
        servo.pd.limit = servo.pd.limit.min((most * whisking::pd::FULL) as i32);
        // It is driven hard from half of that on, which is Q15 here.
        let hard = Duty::from_q15((servo.pd.limit >> 10) as i16);
        let stall = &mut servo.guards.stall;
        stall.threshold = stall.threshold.min(hard);
    }
    encode(&config, board)
}

fn tree<R: Real>(of: &Running) -> Value {
    let config = decode::<R>(&of.bytes, of.program.board).ok();
    serde_json::to_value(config).unwrap_or_default()
}

/// The names of the values in which two trees differ; `path` is theirs.
fn differing(path: &str, one: &Value, other: &Value) -> Vec<String> {
    match (one, other) {
        (Value::Object(one), Value::Object(other)) => {
            let inner = one.iter().flat_map(|(name, value)| {
                let path = format!("{path}{}{name}", if path.is_empty() { "" } else { "." });
                differing(&path, value, other.get(name).unwrap_or_default())
            });
            inner.collect()
        }
        _ if one == other => Vec::new(),
        _ => vec![path.to_owned()],
    }
}

impl Running {
    pub(crate) fn ask(module: &mut Conversation) -> Result<Self, Error> {
        let runs_by = RunsBy::ask(module)?;
        let RunsBy::Scene { crc, length, .. } = runs_by else {
            return Err(Error::Work(format!(
                "the module {runs_by}; whisker deploy --scene FILE gives it one"
            )));
        };
        let mut bytes = Vec::with_capacity(length);
        for word in (0..length.div_ceil(4)).step_by(2) {
            let two = module.ask(Command::Config(word as u32))?.values;
            bytes.extend(two.map(i32::to_le_bytes).as_flattened());
        }
        bytes.truncate(length);
        let found = Self::of(bytes)?;
        if found.crc == crc {
            return Ok(found);
        }
        let fault = "somebody else sets keys in the module meanwhile; try again";
        Err(Error::Work(fault.to_owned()))
    }

    /// Has a module go on by it, between two ticks.
    pub(crate) fn send(&self, module: &mut Conversation) -> Result<Taken, Error> {
        let first = module.answer(Command::Forget)?;
        match first.status {
            CommandStatus::Done => {}
            CommandStatus::NotHere => return Ok(Taken::NotBuilt),
            status => return Err(Error::Work(format!("the module takes no scene: {status}"))),
        }
        // Zeros follow the last byte.
        let mut bytes = self.bytes().to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        for (number, word) in bytes.as_chunks().0.iter().enumerate() {
            module.ask(Command::Stage(number as u8, u32::from_le_bytes(*word)))?;
        }
        let answer = module.answer(Command::Apply(self.bytes().len() as u32))?;
        match (answer.status, refusal_of(answer.values)) {
            (CommandStatus::Done, _) => Ok(Taken::Runs),
            (CommandStatus::OutOfRange | CommandStatus::Armed, Some(refused)) => {
                Ok(Taken::Refused(refused))
            }
            (status, _) => Err(Error::Work(format!(
                "the module does not take the configuration: {status}"
            ))),
        }
    }

    pub(crate) fn of(bytes: Vec<u8>) -> Result<Self, Error> {
        let fault = "the configuration of the module cannot be read";
        let strange = |why: ConfigError| Error::Work(format!("{fault}: {why}"));
        let header = Header::of(&bytes).map_err(strange)?;
        let program = Program::of(header.board, header.format)?;
        in_format!(program.format, read(program, bytes)).map_err(strange)
    }

    pub(crate) fn of_scene(
        scene: &Scene,
        board: BoardCode,
        target: Target<'_>,
    ) -> Result<Self, Error> {
        let program = Program::for_scene(board, scene)?;
        let built = in_format!(program.format, built(scene, target, board));
        let built = built.map_err(|fault| Error::Input(fault.to_string()))?;
        Self::of(built.to_vec())
    }

    /// That of a scene for the same module with the same model, with these keys in place of the
    /// scene file's own, and these priors and thresholds of the model's classes.
    pub(crate) fn remade(
        &self,
        scene: &Scene,
        overrides: &str,
        classes: &ClassList,
    ) -> Result<Self, Error> {
        let board = self.program.board;
        let (runs_on, is_recording) = match board {
            BoardCode::Simulation => {
                let records = !self.decides;
                (RunsOn::Simulation { records }, records)
            }
            _ => (RunsOn::Board, false),
        };
        // What the model was trained from; a recording has none.
        let own = scene.classifier.as_ref().and_then(|own| own.contact_min);
        let is_models = own.is_none() && !is_recording;
        let gate = self.contact_min.filter(|_| is_models);
        let target = Target {
            runs_on,
            gate: gate.map(|gate| gate as f32),
            classes: Some(classes),
            overrides,
        };
        Self::of_scene(scene, board, target)
    }

    /// The same with motors that are driven by so much at most.
    pub(crate) fn gentle(&self, most: f64) -> Result<Self, Error> {
        let bytes = in_format!(self.program.format, gentle(self, most));
        let bytes = bytes.map_err(|fault| Error::Work(fault.to_string()))?;
        Self::of(bytes.to_vec())
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    pub(crate) const fn program(&self) -> Program {
        self.program
    }

    /// Whether a module that runs by it may go on by `new`, with its motors off.
    pub(crate) fn may_become(&self, new: &Self) -> Result<(), ConfigError> {
        in_format!(self.program.format, may_become(self, new))
    }

    /// The names of the values that another has otherwise, as [`firmware::Config`] has them.
    pub(crate) fn differs_in(&self, other: &Self) -> Vec<String> {
        if self.program != other.program {
            return vec!["whisking.numbers".to_owned()];
        }
        let [one, other] = [self, other].map(|of| in_format!(of.program.format, tree(of)));
        differing("", &one, &other)
    }
}

#[cfg(test)]
mod tests;
