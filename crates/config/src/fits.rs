//! What a board cannot do, in the words of the scene's keys.

use firmware::boards::{self, BoardFacts};
use scene::{Rule, Scene, SensorMode};
use tactile::{Deciding, ModelBuf, StreamClassifier};

use crate::module::{bus, rule_settings};
use crate::{Mismatch, NoSuchFormat, classes, suits};

/// Largest exponent of a model's scale that still lets 14-bit codes fit it.
const MAX_EXPONENT: i16 = 17;

/// Why a scene does not run on a board.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum Unfit {
    #[error("{0}")]
    Board(String),
    #[error("classifier.model: {0}")]
    Model(String),
    #[error(transparent)]
    Format(#[from] NoSuchFormat),
    #[error(transparent)]
    Scene(#[from] Mismatch),
}

pub(crate) fn fits(
    scene: &Scene,
    model: Option<&ModelBuf>,
    board: &BoardFacts,
) -> Result<(), Unfit> {
    let needs = needs(scene);
    if let Err(misfit) = board.fits(&needs) {
        let (key, found) = found(misfit, scene);
        return Err(Unfit::Board(format!(
            "{key}: found {found}; allowed on the {}: {misfit}",
            board.name
        )));
    }
    model.map_or(Ok(()), |model| model_fits(scene, model, board))
}

fn needs(scene: &Scene) -> boards::Needs {
    boards::Needs {
        tick_hz: scene.tick_hz,
        is_slow: scene.sensor.mode == SensorMode::Slow,
        rest_us: scene.sensor.rest_us,
        sides: scene.head.sides.count() as u8,
        whiskers_per_side: scene.head.whiskers_per_side as u8,
        driver: scene.motor.as_ref().map(|motor| motor.driver),
        serial_baud: scene.telemetry.serial_baud,
        bus: bus(scene),
        decides: scene.classifier.is_some(),
    }
}

/// The key that a board refuses, and its value.
fn found(misfit: boards::Misfit, scene: &Scene) -> (&'static str, String) {
    match misfit {
        boards::Misfit::Sides(_) => ("head.sides", "\"both\"".to_owned()),
        boards::Misfit::Whiskers => {
            let found = scene.head.whiskers_per_side.to_string();
            ("head.whiskers_per_side", found)
        }
        boards::Misfit::NoBus | boards::Misfit::DecidesInHead | boards::Misfit::Share(_) => {
            let nodes = scene.head.nodes.unwrap_or_default();
            ("head.nodes", nodes.to_string())
        }
        boards::Misfit::BusOfClock { .. } => {
            let kbit_s = bus(scene).map_or(0, |bus| bus.kbit_s);
            ("head.bus_kbit_s", kbit_s.to_string())
        }
        boards::Misfit::TwoBrushless => ("motor.driver", "\"six-step\" on two sides".to_owned()),
        boards::Misfit::TickHz { .. } => ("tick_hz", scene.tick_hz.to_string()),
        boards::Misfit::BaudOfClock { .. } | boards::Misfit::BaudOfTicks { .. } => {
            let baud = scene.telemetry.serial_baud.unwrap_or_default();
            ("telemetry.serial_baud", baud.to_string())
        }
    }
}

fn model_fits(scene: &Scene, model: &ModelBuf, board: &BoardFacts) -> Result<(), Unfit> {
    let Some(classifier) = &scene.classifier else {
        return Ok(());
    };
    let takes_codes = |channel| {
        model
            .quantiser(channel)
            .is_some_and(|q| q.takes_raw() && q.exponent <= MAX_EXPONENT.into())
    };
    if !(0..model.channels()).all(takes_codes) {
        let reason = "it was not trained on sensor codes of x and y";
        return Err(Unfit::Model(reason.to_owned()));
    }
    if let Rule::Window { samples } = classifier.rule
        && !samples.is_multiple_of(model.block())
    {
        return Err(Unfit::Board(format!(
            "classifier.window: found {samples}; allowed: a multiple of the model's block of {}",
            model.block()
        )));
    }
    let rule = rule_settings(classifier, &classes(scene, model)?)?;
    StreamClassifier::new(model.view(), rule, Deciding::First, 1)
        .map_err(|fault| Unfit::Model(fault.to_string()))?;
    suits(scene, model)?;
    let boards = scene.head.nodes.map_or(1, usize::from).max(1);
    let deciding = classifier.whiskers.heard(scene.whiskers() / boards);
    let (found, most) = (model.poses(), board.poses_of_each(deciding));
    if found > most {
        return Err(Unfit::Model(format!(
            "it was trained in {found} poses; allowed on the {}, where {deciding} of its whiskers \
             decide: up to {most}, because its core has no time for more within a tick",
            board.name
        )));
    }
    let (found, most) = (model.classes(), board.max_classes);
    if found > most {
        return Err(Unfit::Model(format!(
            "found {found} classes; allowed on the {}: 2 to {most}",
            board.name
        )));
    }
    let (bytes, room) = (
        model.as_bytes().len(),
        board.flash.slots[0].model.bytes as usize,
    );
    if bytes > room {
        return Err(Unfit::Model(format!(
            "found {bytes} bytes; allowed on the {}: up to {room}",
            board.name
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::fits;
    use firmware::boards::{BoardFacts, NUCLEO_F446RE};
    use scene::Scene;
    use tactile::ModelBuf;

    /// By a board that has time for one pose, and by one for none.
    #[test]
    fn whiskers_that_decide_share_the_time_for_poses() {
        let text = include_str!("../../../scenes/bench-textures.toml");
        let model = include_bytes!("../../../scenes/models/bench-textures.model");
        let model = ModelBuf::from_bytes(model).unwrap();
        let scene = Scene::from_str("bench-textures.toml", text).unwrap();
        let fits = |max_poses| {
            let board = BoardFacts {
                max_poses,
                ..NUCLEO_F446RE
            };
            fits(&scene, Some(&model), &board).map_err(|unfit| unfit.to_string())
        };
        assert_eq!(fits(1), Ok(()));
        let says = "classifier.model: it was trained in 1 poses; allowed on the NUCLEO-F446RE, \
                    where 1 of its whiskers decide: up to 0, because";
        assert!(fits(0).unwrap_err().starts_with(says));
    }
}
