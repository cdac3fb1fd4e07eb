//! For a board: turns the scene into types and settings, and tells the linker
//! about the memory. Without a board (no feature names one) it does nothing.
//!
//! The scene is the file that `WHISKER_SCENE` names, relative to the
//! workspace's root; without it `scenes/textures.toml`. A scene that is wrong
//! ends the build with a message.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

#[path = "build/model.rs"]
mod model;
#[path = "build/part.rs"]
mod part;
#[path = "build/perception.rs"]
mod perception;
#[path = "build/source.rs"]
mod source;

#[allow(dead_code, reason = "the boards use the rest")]
#[path = "src/board"]
mod board {
    pub(crate) mod nucleo_f103rb;
    pub(crate) mod nucleo_f446re;
    pub(crate) mod nucleo_g071rb;
    pub(crate) mod timing;
}

use board::timing::{Clocks, RECEIVED_BYTES, TICK_MIN_HZ, serial_keeps_up};
use databake::quote;
use plan::NumberFormat;
use scene::{Driver, MotorSection, Scene, SensorMode, SensorModel};
use whisking::Fix;

/// What the build must know of a board.
struct Board {
    /// Its feature, as cargo tells it.
    feature: &'static str,
    /// Its memory map.
    memory: &'static str,
    name: &'static str,
    clocks: Clocks,
    has_fpu: bool,
    max_classes: usize,
    max_sides: usize,
}

macro_rules! boards {
    ($($feature:literal: $module:ident, $memory:literal;)*) => {
        [$(Board {
            feature: $feature,
            memory: $memory,
            name: board::$module::NAME,
            clocks: board::$module::CLOCKS,
            has_fpu: board::$module::HAS_FPU,
            max_classes: board::$module::MAX_CLASSES,
            max_sides: board::$module::MAX_SIDES,
        }),*]
    };
}

const BOARDS: [Board; 3] = boards! {
    "NUCLEO_F446RE": nucleo_f446re, "firmware/src/board/nucleo_f446re.x";
    "NUCLEO_F103RB": nucleo_f103rb, "firmware/src/board/nucleo_f103rb.x";
    "NUCLEO_G071RB": nucleo_g071rb, "firmware/src/board/nucleo_g071rb.x";
};

const DEFAULT_SCENE: &str = "scenes/textures.toml";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=build");
    println!("cargo::rerun-if-changed=src/board");
    println!("cargo::rerun-if-env-changed=WHISKER_SCENE");
    println!("cargo::rustc-check-cfg=cfg(right_side)");
    println!("cargo::rustc-check-cfg=cfg(telemetry)");
    println!("cargo::rustc-check-cfg=cfg(serial)");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let asked = |board: &&Board| env::var_os(format!("CARGO_FEATURE_{}", board.feature)).is_some();
    let boards: Vec<&Board> = BOARDS.iter().filter(asked).collect();
    let done = match boards[..] {
        [] => Ok(()),
        [board] => link(board).and_then(|()| scene(board)),
        _ => Err("two boards at once: give one feature".into()),
    };
    if let Err(error) = done {
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
fn link(board: &Board) -> Result<(), Box<dyn Error>> {
    // A memory.x in the workspace's root would be taken before this one, whatever the board.
    let memory = workspace()?.join(board.memory);
    println!("cargo::rerun-if-changed={}", memory.display());
    let map = fs::read_to_string(&memory);
    let map = map.map_err(|error| format!("{}: {error}", memory.display()))?;
    // For whoever deploys a model, beside where it goes.
    let most = board.max_classes;
    fs::write(
        output("memory.x")?,
        format!("{map}_model_classes = {most};\n"),
    )?;
    println!("cargo::rustc-link-search={}", env::var("OUT_DIR")?);
    for argument in ["--nmagic", "-Tlink.x", "-Tdefmt.x"] {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
    Ok(())
}

/// Reads the scene and writes its types and settings.
fn scene(board: &Board) -> Result<(), Box<dyn Error>> {
    let path = env::var("WHISKER_SCENE").unwrap_or_else(|_| DEFAULT_SCENE.to_owned());
    let path = workspace()?.join(path);
    println!("cargo::rerun-if-changed={}", path.display());
    let scene = Scene::load(&path)?;
    let wrong = |reason: String| format!("{}: {reason}", path.display());
    fits(&scene, board).map_err(wrong)?;

    let scene_dir = path.parent().unwrap_or(Path::new(""));
    if let Some(classifier) = &scene.classifier {
        model::check_rule(classifier.rule).map_err(wrong)?;
    }
    let model = match (&scene.classifier, scene.model_path(scene_dir)) {
        (Some(classifier), Some(path)) => {
            // A path that is not found beside the scene counts from the workspace's root.
            let path = workspace()?.join(path);
            println!("cargo::rerun-if-changed={}", path.display());
            let model = model::read(&path, classifier)?;
            let (found, most) = (model.classes(), board.max_classes);
            if found > most {
                let reason = format!(
                    "classifier.model: found {found} classes; allowed on the {}: 2 to {most}",
                    board.name
                );
                return Err(wrong(reason).into());
            }
            fs::copy(&path, output("touch.model")?)?;
            Some(model)
        }
        _ => None,
    };
    let format = plan::on_board(&scene, board.name, board.has_fpu);
    let source = match format.map_err(|error| wrong(error.to_string()))? {
        NumberFormat::Fixed => {
            source::source::<Fix>(&scene, model.as_ref(), &quote!(whisking::Fix))
        }
        _ => source::source::<f32>(&scene, model.as_ref(), &quote!(f32)),
    };
    let source = source.map_err(|error| wrong(error.to_string()))?;
    fs::write(output("scene.rs")?, source)?;
    if scene.head.sides.count() > 1 {
        println!("cargo::rustc-cfg=right_side");
    }
    if scene.telemetry.rtt {
        println!("cargo::rustc-cfg=telemetry");
    }
    if scene.telemetry.serial_baud.is_some() {
        println!("cargo::rustc-cfg=serial");
    }
    Ok(())
}

/// What this board cannot do.
fn fits(scene: &Scene, board: &Board) -> Result<(), String> {
    let sides = scene.head.sides.count();
    if sides > board.max_sides || scene.head.whiskers_per_side != 1 {
        let (most, allowed) = match board.max_sides {
            1 => ("one whisker, the left", "\"left\""),
            _ => ("one whisker a side", "\"left\" or \"both\""),
        };
        return Err(format!(
            "the {} carries {most}: found {} with {} a side; \
             allowed: head.sides = {allowed}, head.whiskers_per_side = 1",
            board.name,
            match sides {
                1 => "one side",
                _ => "two sides",
            },
            scene.head.whiskers_per_side
        ));
    }
    let is_brushless = |motor: &MotorSection| motor.driver == Driver::SixStep;
    if sides > 1 && scene.motor.as_ref().is_some_and(is_brushless) {
        return Err(format!(
            "motor.driver: found \"six-step\" on two sides; allowed on the {}: \"h-bridge\", \
             because one brushless motor takes every output of the PWM's timer",
            board.name
        ));
    }
    if scene.sensor.model != SensorModel::Mlx90333 {
        return Err(format!(
            "sensor.model: found \"{}\"; allowed on the {}: \"mlx90333\", because no board's \
             program reads the other yet",
            scene.sensor.model, board.name
        ));
    }
    let clocks = match scene.sensor.mode {
        SensorMode::Fast => board.clocks,
        SensorMode::Slow => board.clocks.halved(),
    };
    if scene.tick_hz < TICK_MIN_HZ || clocks.slot_ns(scene.tick_hz).is_none() {
        return Err(format!(
            "tick_hz: found {}; allowed on the {}: {TICK_MIN_HZ} to {}, because a sensor frame \
             takes {} us",
            scene.tick_hz,
            board.name,
            clocks.tick_max_hz(),
            clocks.frame_least_ns() / 1_000
        ));
    }
    match scene.telemetry.serial_baud {
        Some(baud) => serial_fits(baud, scene.tick_hz, &clocks, board),
        None => Ok(()),
    }
}

/// Whether the board has that baud, and idle keeps up with it.
fn serial_fits(baud: u32, tick_hz: u32, clocks: &Clocks, board: &Board) -> Result<(), String> {
    let refuse = |allowed: String| {
        let name = board.name;
        Err(format!(
            "telemetry.serial_baud: found {baud}; allowed on the {name}: {allowed}"
        ))
    };
    if clocks.serial_divider(baud).is_none() {
        let hz = clocks.serial_hz;
        return refuse(format!(
            "up to {}, where {hz} Hz are a multiple of it to within 1.5 %",
            hz / 16
        ));
    }
    if !serial_keeps_up(baud, tick_hz) {
        return refuse(format!(
            "what brings less than {RECEIVED_BYTES} bytes in two ticks, at {tick_hz} a second \
             up to {}",
            (RECEIVED_BYTES as u32 - 1) * 5 * tick_hz
        ));
    }
    Ok(())
}
