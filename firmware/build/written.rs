//! The scene as Rust: constants and types of `src/board/scene.rs`.

use std::error::Error;
use std::fs;
use std::path::Path;

use scene::{Driver, Rule, Scene};
use tactile::{ModelBuf, Threshold};
use whisking::Real;

use super::{output, workspace};

/// Largest exponent of a model's scale that still lets 14-bit codes fit it.
const MAX_EXPONENT: i16 = 17;

/// The scene in number format `R`, which the firmware calls `number`.
pub(crate) fn written<R: Real>(
    scene: &Scene,
    scene_dir: &Path,
    number: &str,
) -> Result<String, Box<dyn Error>> {
    Ok([
        general::<R>(scene, number)?,
        motion::<R>(scene)?,
        perception::<R>(scene, scene_dir)?,
    ]
    .concat())
}

fn general<R: Real>(scene: &Scene, number: &str) -> Result<String, Box<dyn Error>> {
    let contact = plan::contact::<R>(scene)?;
    Ok(format!(
        "/// What the scene is called.\n\
         pub(crate) const NAME: &str = {:?};\n\
         /// Ticks a second.\n\
         pub(crate) const TICK_HZ: u32 = {};\n\
         /// Number format of the tick.\n\
         pub(crate) type Number = {number};\n\
         /// Carries the constants of what the scene names.\n\
         pub(crate) struct Scene;\n\
         {}",
        scene.name,
        scene.tick_hz,
        constant(
            "contact",
            "whisking::filter::Config",
            "Option<Config<Number>>",
            &contact
        ),
    ))
}

/// The pattern generator and the position control.
fn motion<R: Real>(scene: &Scene) -> Result<String, Box<dyn Error>> {
    let (Some(motor), Some(plan)) = (&scene.motor, plan::motion::<R, 1, 1>(scene)?) else {
        return Ok("/// How it moves.\n\
             pub(crate) type Moving = super::motion::Still;\n"
            .to_owned());
    };
    let motor = match motor.driver {
        Driver::HBridge => "Brushed",
        Driver::SixStep => "Brushless",
    };
    let whisking = &plan.whisking;
    let parts = [
        constant(
            "oscillators",
            "whisking::oscillator::{Config, Config::*, Euler, Exact, Linear, Turn}",
            "Config<Number>",
            &whisking.oscillators,
        ),
        constant(
            "muscle",
            "whisking::muscle::{Config, Config::*, Euler, Exact, Lag}",
            "Config<Number>",
            &whisking.muscle,
        ),
        constant(
            "rcp",
            "whisking::gate::{Decay, Rcp}",
            "Option<Rcp<Number>>",
            &whisking.rcp,
        ),
        constant(
            "cia",
            "whisking::gate::{Cia, Decay}",
            "Option<Cia<Number>>",
            &whisking.cia,
        ),
        noise(whisking.noise.as_ref()),
        constant(
            "start",
            "whisking::{Start, muscle::History}",
            "Start<Number, 1, 1>",
            &plan.start,
        ),
        constant("pd", "whisking::pd::Config", "Config<Number>", &plan.pd),
        constant(
            "peak_gain",
            "whisking::Config",
            "Number",
            &whisking.peak_gain,
        ),
    ];
    Ok(format!(
        "{}\
         /// How it moves.\n\
         pub(crate) type Moving = super::motion::Whisks<Scene>;\n\
         impl super::motion::Whisking for Scene {{\n    \
         type Motor = super::motors::{motor};\n    \
         const WHISKING: whisking::Config<Number> = whisking::Config {{\n        \
         oscillators: OSCILLATORS,\n        muscle: MUSCLE,\n        \
         peak_gain: PEAK_GAIN,\n        rcp: RCP,\n        cia: CIA,\n        \
         noise: NOISE,\n    }};\n    \
         const START: whisking::Start<Number, 1, 1> = START;\n    \
         const PD: whisking::pd::Config<Number> = PD;\n    \
         const STALL_Q15: i16 = {};\n    \
         const SEED: u64 = {};\n\
         }}\n",
        parts.concat(),
        plan.stall_q15,
        scene.seed
    ))
}

/// The noise has a filter inside, whose type has the same short name.
fn noise<R: Real>(noise: Option<&whisking::noise::Config<R>>) -> String {
    let (parts, value) = match noise {
        None => (String::new(), "None".to_owned()),
        Some(noise) => (
            constant(
                "noise_filter",
                "whisking::filter::Config",
                "Config<Number>",
                &noise.filter,
            ) + &constant(
                "noise_amplitude",
                "whisking::noise::Config",
                "<Number as whisking::Real>::Fine",
                &noise.amplitude,
            ),
            "Some(whisking::noise::Config {\n    \
             amplitude: NOISE_AMPLITUDE,\n    filter: NOISE_FILTER,\n})"
                .to_owned(),
        ),
    };
    format!(
        "{parts}/// Noise of the oscillators.\n\
         pub(crate) const NOISE: Option<whisking::noise::Config<Number>> = {value};\n"
    )
}

/// The model and its rule.
fn perception<R: Real>(scene: &Scene, scene_dir: &Path) -> Result<String, Box<dyn Error>> {
    let (Some(classifier), Some(path)) = (&scene.classifier, scene.model_path(scene_dir)) else {
        return Ok("/// What it decides.\n\
             pub(crate) type Deciding = super::touch::Nothing;\n"
            .to_owned());
    };
    // A path that is not found beside the scene counts from the workspace's root.
    let path = workspace()?.join(path);
    println!("cargo::rerun-if-changed={}", path.display());
    let wrong = |reason: &dyn std::fmt::Display| format!("model {}: {reason}", path.display());

    let bytes = fs::read(&path)
        .map_err(|error| wrong(&format!("{error}; learn it first with `host-sim train`")))?;
    fs::write(output("touch.model")?, &bytes)?;
    let model = ModelBuf::from_bytes(&bytes).map_err(|error| wrong(&error))?;
    let takes_codes = |channel| {
        model
            .quantiser(channel)
            .is_some_and(|q| q.takes_raw() && q.exponent <= MAX_EXPONENT.into())
    };
    if model.channels() != 2 || !takes_codes(0) || !takes_codes(1) {
        return Err(wrong(&"it was not learnt from sensor codes of x and y").into());
    }

    let (decides, rule) = match classifier.rule {
        Rule::Sequential { threshold } => {
            Threshold::new(threshold).map_err(|error| wrong(&error))?;
            let rule = format!(
                "impl super::touch::AtThreshold for Scene {{\n    \
                 const THRESHOLD: tactile::Threshold =\n        \
                 match tactile::Threshold::new({threshold:?}) {{\n            \
                 Ok(threshold) => threshold,\n            \
                 Err(_) => panic!(\"the build script has checked it\"),\n        }};\n}}\n"
            );
            ("Sequential", rule)
        }
        Rule::Window { samples } => {
            if !samples.is_multiple_of(model.block()) {
                return Err(wrong(&format!(
                    "classifier.window: found {samples}; allowed: a multiple of the model's \
                     block of {}",
                    model.block()
                ))
                .into());
            }
            let rule = format!(
                "impl super::touch::ByWindow for Scene {{\n    \
                 const SAMPLES: u32 = {samples};\n}}\n"
            );
            ("Window", rule)
        }
    };
    let contact_min = classifier.contact_min.map(R::from_f64);
    Ok(format!(
        "/// What it decides.\n\
         pub(crate) type Deciding = super::touch::{decides}<Scene>;\n\
         {}{rule}\
         impl super::touch::Classifies for Scene {{\n    \
         const CONTACT_MIN: Option<Number> = CONTACT_MIN;\n    \
         fn model() -> &'static [u8] {{\n        \
         tactile::include_model!(concat!(env!(\"OUT_DIR\"), \"/touch.model\"))\n    }}\n}}\n",
        constant(
            "contact_min",
            "whisking::Config",
            "Option<Number>",
            &contact_min
        ),
    ))
}

/// `pub(crate) const NAME: TYPE = VALUE;` in a module of its own, because
/// values print with unqualified type names of which several are alike.
fn constant(name: &str, imports: &str, of_type: &str, value: &impl std::fmt::Debug) -> String {
    let upper = name.to_uppercase();
    format!(
        "mod {name} {{\n    \
         #[allow(unused_imports, reason = \"depends on the scene\")]\n    \
         use {{super::Number, whisking::*, {imports}}};\n    \
         /// As computed from the scene.\n    \
         pub(crate) const {upper}: {of_type} = {value:?};\n}}\n\
         pub(crate) use {name}::{upper};\n"
    )
}
