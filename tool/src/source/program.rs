//! Building the program of a board.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::ValueEnum;
use host_sim::{Error, report};

/// A board whose program can be built, emulated and flashed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BoardName {
    /// Cortex-M4F, a whisker a side
    NucleoF446re,
    /// Cortex-M3, in fixed point, one whisker
    NucleoF103rb,
    /// Cortex-M0+, likewise
    NucleoG071rb,
}

/// How cargo is told to build it.
struct Recipe {
    feature: &'static str,
    program: &'static str,
    target: &'static str,
}

const fn recipe(board: BoardName) -> Recipe {
    let (feature, program, target) = match board {
        BoardName::NucleoF446re => ("nucleo-f446re", "nucleo_f446re", "thumbv7em-none-eabihf"),
        BoardName::NucleoF103rb => ("nucleo-f103rb", "nucleo_f103rb", "thumbv7m-none-eabi"),
        BoardName::NucleoG071rb => ("nucleo-g071rb", "nucleo_g071rb", "thumbv6m-none-eabi"),
    };
    Recipe {
        feature,
        program,
        target,
    }
}

/// Builds the program of `scene`; returns its file.
pub(crate) fn build(board: BoardName, scene: &Path) -> Result<PathBuf, Error> {
    let Recipe {
        feature,
        program,
        target,
    } = recipe(board);
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let top = here.parent().unwrap_or(here);
    let wrong = |error: std::io::Error| Error::file(scene, error);
    let scene_file = std::path::absolute(scene).map_err(wrong)?;
    report::warn(format_args!(
        "building the {feature}'s program of {}",
        scene.display()
    ));
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .args(["build", "--quiet", "--locked", "--profile", "firmware"])
        .args(["-p", "firmware", "--features", feature, "--bin", program])
        .args(["--target", target])
        .env("WHISKER_SCENE", scene_file)
        // As all programs of boards are built: others would be compiled anew.
        .env("RUSTFLAGS", "-D warnings")
        .current_dir(top);
    let status = cargo.status().map_err(|error| {
        Error::Work(format!(
            "cargo: {error}; Rust is installed by https://rustup.rs"
        ))
    })?;
    if !status.success() {
        return Err(Error::Work(format!(
            "the program could not be built ({status}); is the target there? rustup target add \
             {target}"
        )));
    }
    let built = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| top.join("target"), Into::into);
    Ok(built.join(target).join("firmware").join(program))
}
