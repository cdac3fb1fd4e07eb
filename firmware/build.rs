//! For a board: turns the scene into constants and tells the linker about the
//! memory. For a PC it does nothing.
//!
//! The scene is the file that `WHISKER_SCENE` names, seen from the workspace's
//! root; without it `scenes/textures.toml`. What is wrong with it ends the
//! build with a message.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

use scene::{Driver, Rule, Scene};
use tactile::{ModelBuf, Threshold};

#[allow(dead_code, reason = "the board uses the rest")]
#[path = "src/board/timing.rs"]
mod timing;

const DEFAULT_SCENE: &str = "scenes/textures.toml";

/// Largest exponent of a model's scale that still lets 14-bit codes fit it.
const MAX_EXPONENT: i16 = 17;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=WHISKER_SCENE");
    println!("cargo::rustc-check-cfg=cfg(motor, values(\"none\", \"h-bridge\", \"six-step\"))");
    println!(
        "cargo::rustc-check-cfg=cfg(perception, values(\"none\", \"sequential\", \"window\"))"
    );
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    if let Err(error) = link().and_then(|()| scene()) {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}

fn workspace() -> Result<PathBuf, Box<dyn Error>> {
    let package = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    Ok(package.parent().ok_or("no workspace")?.to_owned())
}

fn output(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    Ok(PathBuf::from(env::var("OUT_DIR")?).join(name))
}

/// The memory map, and the linker scripts of cortex-m-rt and defmt.
fn link() -> Result<(), Box<dyn Error>> {
    let memory = workspace()?.join("memory.x");
    println!("cargo::rerun-if-changed={}", memory.display());
    fs::copy(&memory, output("memory.x")?)
        .map_err(|error| format!("{}: {error}", memory.display()))?;
    println!("cargo::rustc-link-search={}", env::var("OUT_DIR")?);
    for argument in ["--nmagic", "-Tlink.x", "-Tdefmt.x"] {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
    Ok(())
}

/// Reads the scene and writes its constants.
fn scene() -> Result<(), Box<dyn Error>> {
    let path = env::var("WHISKER_SCENE").unwrap_or_else(|_| DEFAULT_SCENE.to_owned());
    let path = workspace()?.join(path);
    println!("cargo::rerun-if-changed={}", path.display());
    let scene = Scene::load(&path)?;
    fits(&scene).map_err(|reason| format!("{}: {reason}", path.display()))?;

    let mut text = general(&scene)?;
    text += &motion(&scene)?;
    text += &perception(&scene, path.parent().unwrap_or(Path::new("")))?;
    fs::write(output("scene.rs")?, text)?;
    Ok(())
}

/// What this board cannot do.
fn fits(scene: &Scene) -> Result<(), String> {
    if scene.whiskers() != 1 {
        return Err(format!(
            "the NUCLEO-F446RE carries one whisker, the left: found {} with {} a side; \
             allowed: head.sides = \"left\", head.whiskers_per_side = 1",
            match scene.head.sides.count() {
                1 => "one side",
                _ => "two sides",
            },
            scene.head.whiskers_per_side
        ));
    }
    if timing::slot_ns(scene.tick_hz).is_none() {
        return Err(format!(
            "tick_hz: found {}; allowed on the NUCLEO-F446RE: {} to {}, because a sensor frame \
             takes {} us",
            scene.tick_hz,
            timing::TICK_MIN_HZ,
            timing::TICK_MAX_HZ,
            timing::frame_ns(timing::SLOT_FAST_NS) / 1_000
        ));
    }
    Ok(())
}

fn general(scene: &Scene) -> Result<String, Box<dyn Error>> {
    let contact = plan::contact::<f32>(scene)?;
    Ok(format!(
        "/// What the scene is called.\n\
         pub(crate) const NAME: &str = {:?};\n\
         /// Ticks a second.\n\
         pub(crate) const TICK_HZ: u32 = {};\n\
         {}",
        scene.name,
        scene.tick_hz,
        constant(
            "contact",
            "whisking::filter::Config",
            "Option<Config<f32>>",
            &contact
        ),
    ))
}

/// The pattern generator and the position control.
fn motion(scene: &Scene) -> Result<String, Box<dyn Error>> {
    let motor = match scene.motor.as_ref().map(|motor| motor.driver) {
        None => "none",
        Some(Driver::HBridge) => "h-bridge",
        Some(Driver::SixStep) => "six-step",
    };
    println!("cargo::rustc-cfg=motor=\"{motor}\"");
    let Some(plan) = plan::motion::<f32, 1, 1>(scene)? else {
        return Ok(String::new());
    };
    let whisking = &plan.whisking;
    let parts = [
        constant(
            "oscillators",
            "whisking::oscillator::{Config, Config::*, Euler, Exact, Linear, Turn}",
            "Config<f32>",
            &whisking.oscillators,
        ),
        constant(
            "muscle",
            "whisking::muscle::{Config, Config::*, Euler, Exact, Lag}",
            "Config<f32>",
            &whisking.muscle,
        ),
        constant(
            "rcp",
            "whisking::gate::{Decay, Rcp}",
            "Option<Rcp<f32>>",
            &whisking.rcp,
        ),
        constant(
            "cia",
            "whisking::gate::{Cia, Decay}",
            "Option<Cia<f32>>",
            &whisking.cia,
        ),
        noise(whisking.noise.as_ref()),
        constant(
            "start",
            "whisking::{Start, muscle::History}",
            "Start<f32, 1, 1>",
            &plan.start,
        ),
        constant("pd", "whisking::pd::Config", "Config<f32>", &plan.pd),
    ];
    Ok(format!(
        "{}\
         /// Oscillators, muscles and gates.\n\
         pub(crate) const WHISKING: whisking::Config<f32> = whisking::Config {{\n    \
         oscillators: OSCILLATORS,\n    muscle: MUSCLE,\n    peak_gain: {:?},\n    \
         rcp: RCP,\n    cia: CIA,\n    noise: NOISE,\n}};\n\
         /// Duty above which a motor that stands still is stalled, Q15.\n\
         pub(crate) const STALL_Q15: i16 = {};\n\
         /// Seed of the noise.\n\
         pub(crate) const SEED: u64 = {};\n",
        parts.concat(),
        whisking.peak_gain,
        plan.stall_q15,
        scene.seed
    ))
}

/// The noise has a filter inside, whose type has the same short name.
fn noise(noise: Option<&whisking::noise::Config<f32>>) -> String {
    let (filter, value) = match noise {
        None => (String::new(), "None".to_owned()),
        Some(noise) => (
            constant(
                "noise_filter",
                "whisking::filter::Config",
                "Config<f32>",
                &noise.filter,
            ),
            format!(
                "Some(whisking::noise::Config {{\n    \
                 amplitude: {:?},\n    filter: NOISE_FILTER,\n}})",
                noise.amplitude
            ),
        ),
    };
    format!(
        "{filter}/// Noise of the oscillators.\n\
         pub(crate) const NOISE: Option<whisking::noise::Config<f32>> = {value};\n"
    )
}

/// The model and its rule.
fn perception(scene: &Scene, scene_dir: &Path) -> Result<String, Box<dyn Error>> {
    let (Some(classifier), Some(path)) = (&scene.classifier, scene.model_path(scene_dir)) else {
        println!("cargo::rustc-cfg=perception=\"none\"");
        return Ok(String::new());
    };
    // A path that is not found beside the scene counts from the workspace's root.
    let path = workspace()?.join(path);
    println!("cargo::rerun-if-changed={}", path.display());
    let wrong = |reason: &dyn std::fmt::Display| format!("model {}: {reason}", path.display());

    let bytes = fs::read(&path)
        .map_err(|error| wrong(&format!("{error}; learn it first with `host-sim train`")))?;
    fs::write(output("touch.model")?, &bytes)?;
    let buffer = ModelBuf::from_bytes(&bytes).map_err(|error| wrong(&error))?;
    let model = buffer.model().map_err(|error| wrong(&error))?;
    let takes_codes = |channel| {
        model
            .quantiser(channel)
            .is_some_and(|q| q.takes_raw() && q.exponent <= MAX_EXPONENT.into())
    };
    if model.channels() != 2 || !takes_codes(0) || !takes_codes(1) {
        return Err(wrong(&"it was not learnt from sensor codes of x and y").into());
    }

    let rule = match classifier.rule {
        Rule::Sequential { threshold } => {
            Threshold::new(threshold).map_err(|error| wrong(&error))?;
            println!("cargo::rustc-cfg=perception=\"sequential\"");
            format!(
                "/// Posterior at which a decision falls.\n\
                 pub(crate) const THRESHOLD: tactile::Threshold =\n    \
                 match tactile::Threshold::new({threshold:?}) {{\n        \
                 Ok(threshold) => threshold,\n        \
                 Err(_) => panic!(\"the build script has checked it\"),\n    }};\n"
            )
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
            println!("cargo::rustc-cfg=perception=\"window\"");
            format!(
                "/// Samples a decision.\n\
                 pub(crate) const WINDOW: u32 = {samples};\n"
            )
        }
    };
    Ok(format!(
        "{rule}\
         /// Classes of the model.\n\
         pub(crate) const CLASSES: usize = {};\n\
         /// Least contact during which samples count.\n\
         pub(crate) const CONTACT_MIN: Option<f32> = {:?};\n\
         /// The model in flash.\n\
         pub(crate) fn model() -> &'static [u8] {{\n    \
         tactile::include_model!(concat!(env!(\"OUT_DIR\"), \"/touch.model\"))\n}}\n",
        model.classes(),
        classifier.contact_min.map(|least| least as f32),
    ))
}

/// `pub(crate) const NAME: TYPE = VALUE;` in a module of its own, because
/// values print with unqualified type names of which several are alike.
fn constant(name: &str, imports: &str, of_type: &str, value: &impl std::fmt::Debug) -> String {
    let upper = name.to_uppercase();
    format!(
        "mod {name} {{\n    \
         #[allow(unused_imports, reason = \"depends on the scene\")]\n    \
         use {imports};\n    \
         /// As computed from the scene.\n    \
         pub(crate) const {upper}: {of_type} = {value:?};\n}}\n\
         pub(crate) use {name}::{upper};\n"
    )
}
