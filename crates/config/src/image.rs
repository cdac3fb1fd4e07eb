//! What a board runs by: a configuration in its number format, and its model.

use firmware::boards::{BoardFacts, InHead};
use firmware::{Config, ConfigBytes, Driver, Part, decode, encode};
use scene::Scene;
use tactile::{Deciding, ModelBuf, RuleSettings};
use whisking::{Fix, FormatCode, Real, oscillator};

use crate::fits::{Unfit, fits};
use crate::{Mismatch, NumberFormat, RunsOn, Target, build, classes, on_board};

/// A configuration in whichever number format.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyConfig {
    /// `f32`.
    Single(Box<Config<f32>>),
    /// [`Fix`].
    Fixed(Box<Config<Fix>>),
}

/// What is written into a board's flash besides its program.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// The configuration.
    pub config: AnyConfig,
    /// The same as bytes, with its header.
    pub bytes: ConfigBytes,
    /// The features of the crate `firmware` by which a program has what it needs, and no more.
    pub features: Vec<&'static str>,
}

fn parts<R: Real>(config: &Config<R>) -> Vec<Part> {
    let links = &config.links;
    let is_linked = links.has_rtt || links.serial_baud.is_some();
    let is_tuned = config.motion.is_some() || config.classifier.is_some();
    let mut parts = vec![
        (is_linked && is_tuned, Part::Set),
        // Whoever classifies wants to try other models.
        (is_linked && config.classifier.is_some(), Part::Deploy),
        (links.has_rtt, Part::Rtt),
        (links.serial_baud.is_some(), Part::Serial),
        (links.has_pins, Part::Pins),
        (config.contact.is_some(), Part::Contact),
        (config.head.bus.is_some(), Part::Bus),
        (config.sensor.limits.zero.is_some(), Part::Zero),
        (config.sensor.self_motion.is_some(), Part::SelfMotion),
        (true, config.sensor.kind.part()),
    ];
    if let Some(motion) = &config.motion {
        let whisking = &motion.whisking;
        let is_euler = matches!(whisking.oscillators, oscillator::Config::Euler(_));
        let is_brushed = motion.driver == Driver::HBridge;
        parts.extend([
            (true, Part::Motion),
            (is_euler, Part::Euler),
            (!is_euler, Part::Exact),
            (whisking.rcp.is_some(), Part::Rcp),
            (whisking.cia.is_some(), Part::Cia),
            (whisking.noise.is_some(), Part::Noise),
            (is_brushed, Part::HBridge),
            (!is_brushed, Part::SixStep),
            (motion.servo.homing.is_some(), Part::Homing),
        ]);
    }
    if let Some(classifier) = &config.classifier {
        let is_window = matches!(classifier.rule, Some(RuleSettings::Window(_)));
        parts.extend([
            (true, Part::Classifier),
            (is_window, Part::Window),
            (!is_window, Part::Sequential),
            (classifier.deciding != Deciding::First, Part::Several),
            (!config.classes.is_empty(), Part::Priors),
            (classifier.says_pose, Part::Pose),
        ]);
    }
    let needed = parts.into_iter().filter(|(is_needed, _)| *is_needed);
    needed.map(|(_, part)| part).collect()
}

/// `None`: for any model.
fn features<R: Real>(
    config: &Config<R>,
    model: Option<&ModelBuf>,
    board: &BoardFacts,
) -> Vec<&'static str> {
    let mut features: Vec<_> = parts(config).into_iter().map(Part::feature).collect();
    if config.classifier.is_some() {
        let any_that = |asks: fn(&ModelBuf) -> bool| model.is_none_or(asks);
        let of_models = [
            (any_that(ModelBuf::is_joint), "joint"),
            (
                model.map_or(board.awaits_opinion, ModelBuf::has_opinion),
                "opinion",
            ),
        ];
        let needed = of_models.into_iter().filter(|(is_needed, _)| *is_needed);
        features.extend(needed.map(|(_, feature)| feature));
    }
    let own = match config.head.bus {
        Some(bus) => config.head.whiskers() / usize::from(bus.nodes).max(1),
        None => config.head.sides.into(),
    };
    if own > 1 {
        features.push("both-sides");
    }
    if config.head.bus.is_some() && board.in_head != InHead::Tuned {
        features.retain(|feature| *feature != Part::Set.feature());
    }
    if board.has_fpu && R::FORMAT == FormatCode::Fixed {
        features.push("fixed");
    }
    features
}

/// A configuration as bytes, once it has passed what a board asks of it: a program that takes none
/// by a link does not ask again.
fn checked<R: Real>(config: &Config<R>, board: &BoardFacts) -> Result<ConfigBytes, Mismatch> {
    let bytes = encode(config, board.code).map_err(Mismatch::Config)?;
    decode::<R>(&bytes, board.code).map_err(Mismatch::Config)?;
    Ok(bytes)
}

/// What `board` runs by for `scene`, whose classifier decides by `model`; `overrides` are the
/// keys that differ from the scene's file.
///
/// # Errors
/// Why the scene does not fit the board.
pub fn image(
    scene: &Scene,
    model: Option<&ModelBuf>,
    board: &BoardFacts,
    overrides: &str,
) -> Result<Image, Unfit> {
    fits(scene, model, board)?;
    let classes = model.map(|model| classes(scene, model)).transpose()?;
    let target = Target {
        runs_on: RunsOn::Board,
        gate: model.and_then(|model| model.touch_rule().map(|touch| touch.gate)),
        classes: classes.as_ref(),
        overrides,
    };
    if on_board(scene, board.name, board.has_fpu)? == NumberFormat::Fixed {
        let config = build::<Fix>(scene, target)?;
        made(config, AnyConfig::Fixed, model, board)
    } else {
        let config = build::<f32>(scene, target)?;
        made(config, AnyConfig::Single, model, board)
    }
}

fn made<R: Real>(
    config: Config<R>,
    any: fn(Box<Config<R>>) -> AnyConfig,
    model: Option<&ModelBuf>,
    board: &BoardFacts,
) -> Result<Image, Unfit> {
    Ok(Image {
        bytes: checked(&config, board)?,
        features: features(&config, model, board),
        config: any(Box::new(config)),
    })
}
