//! For a board: tells the linker about the memory. Without one (no feature names it) it does nothing.
//!
//! No code comes from here: a scene is data, of which a program knows nothing.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

/// The features of boards, as cargo tells them, and their memory maps.
const BOARDS: [(&str, &str); 3] = [
    ("NUCLEO_F446RE", "src/board/nucleo_f446re.x"),
    ("NUCLEO_F103RB", "src/board/nucleo_f103rb.x"),
    ("NUCLEO_G071RB", "src/board/nucleo_g071rb.x"),
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let asked =
        |&&(board, _): &&(&str, &str)| env::var_os(format!("CARGO_FEATURE_{board}")).is_some();
    let boards: Vec<_> = BOARDS.iter().filter(asked).collect();
    let done = match boards[..] {
        [] => Ok(()),
        [(_, map)] => link(map),
        _ => Err("two boards at once: give one feature".into()),
    };
    if let Err(error) = done {
        println!("cargo::error={error}");
    }
}

fn workspace() -> Result<PathBuf, Box<dyn Error>> {
    let package = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    Ok(package.parent().ok_or("no workspace")?.to_owned())
}

/// Copies a file to where the linker, or the program, finds it by this name.
fn copy(from: &PathBuf, name: &str) -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={}", from.display());
    let to = PathBuf::from(env::var("OUT_DIR")?).join(name);
    let bytes = fs::read(from).map_err(|error| format!("{}: {error}", from.display()))?;
    Ok(fs::write(to, bytes)?)
}

/// The memory map, which the workspace's memory.x includes, and the linker scripts of
/// cortex-m-rt and defmt.
fn link(map: &str) -> Result<(), Box<dyn Error>> {
    copy(&PathBuf::from(map), "board.x")?;
    println!("cargo::rustc-link-search={}", env::var("OUT_DIR")?);
    println!("cargo::rustc-link-search={}", workspace()?.display());
    println!("cargo::rerun-if-changed=../memory.x");
    // Functions of the same instructions are one: no program compares where functions are.
    for argument in ["--nmagic", "--icf=all", "-Tlink.x", "-Tdefmt.x"] {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
    Ok(())
}
