//! A configuration on its way to the board by its serial line, word by word, as whoever does not
//! ask this program's own checks would send it.

use config::AnyConfig;
use firmware::boards::BoardFacts;
use firmware::{Config, encode};
use host_sim::Error;
use host_sim::loaded::Loaded;
use whisking::Real;
use whisking::motor::GuardSettings;
use wire::{Frame, TaggedCommand, frame};

use super::file::Change;
use crate::deployment::{image, staged};

/// The frames by which the board of a scene is given its configuration with a change.
pub(super) fn frames(
    change: Change,
    loaded: &Loaded,
    facts: &BoardFacts,
) -> Result<Vec<Frame>, Error> {
    let bytes = match image(&loaded.scene, loaded.model(), facts)?.config {
        AnyConfig::Single(config) => encode(&changed(*config, change), facts.code),
        AnyConfig::Fixed(config) => encode(&changed(*config, change), facts.code),
    };
    let bytes = bytes.map_err(|error| Error::Work(error.to_string()))?;
    let tagged = staged(&bytes).zip(1..);
    let frames = tagged.map(|(command, tag)| frame(&TaggedCommand { tag, command }));
    Ok(frames.collect())
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
