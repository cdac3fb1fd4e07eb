//! A configuration on its way to the board by its serial line, word by word, as whoever does not
//! ask this program's own checks would send it.

use config::AnyConfig;
use firmware::boards::BoardFacts;
use firmware::{Config, encode};
use host_sim::Error;
use scene::Scene;
use tactile::ModelBuf;
use whisking::Real;
use whisking::motor::GuardSettings;
use wire::{Command, Frame, TaggedCommand, frame};

use super::file::Change;
use crate::deployment::{image, words};

/// The frames by which the board of a scene is given its configuration with a change.
pub(super) fn frames(
    change: Change,
    scene: &Scene,
    model: Option<&ModelBuf>,
    facts: &BoardFacts,
) -> Result<Vec<Frame>, Error> {
    let bytes = match image(scene, model, facts)?.config {
        AnyConfig::Single(config) => encode(&changed(*config, change), facts.code),
        AnyConfig::Fixed(config) => encode(&changed(*config, change), facts.code),
    };
    let bytes = bytes.map_err(|error| Error::Work(error.to_string()))?;
    let staged = words(&bytes).into_iter().enumerate();
    let staged = staged.map(|(number, word)| Command::Stage(number as u8, word));
    let apply = Command::Apply(bytes.len() as u32);
    let commands = [Command::Forget].into_iter().chain(staged).chain([apply]);
    let tagged = commands
        .zip(1..)
        .map(|(command, tag)| TaggedCommand { tag, command });
    Ok(tagged.map(|request| frame(&request)).collect())
}

fn changed<R: Real>(mut config: Config<R>, change: Change) -> Config<R> {
    let tick_hz = f64::from(config.head.tick_hz);
    let Some(motion) = &mut config.motion else {
        return config;
    };
    let servo = &mut motion.servo;
    match change {
        Change::NoLimits => servo.guards = GuardSettings::NONE.build(tick_hz),
        Change::WideLimits => {
            servo.guards.error = R::from_f64(0.9);
            servo.guards.heat = 526_000_000;
        }
        Change::WildGains => {
            let kp = R::ONE.times(servo.pd.kp).to_f64();
            servo.pd.kp = R::coefficient(20.0 * kp);
            servo.pd.kd = R::coefficient(0.0);
        }
    }
    config
}
