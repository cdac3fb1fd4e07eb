//! Hashes of traces that host-sim writes, against which the other ways to run a scene are held.

use std::path::PathBuf;
use std::sync::Mutex;

use crate::run::{Fault, once, output, run, target, top, workspace_program, write};

/// One side and two, an elastic shaft, and a classifier that hears both.
const SCENES: [&str; 4] = ["both", "cia", "textures", "whisker"];

/// Writes NAME.sha256 of each scene's trace, once; returns the folder.
pub(crate) fn written() -> Result<PathBuf, Fault> {
    static WRITTEN: Mutex<Option<PathBuf>> = Mutex::new(None);
    once(&WRITTEN, write_all)
}

fn write_all() -> Result<PathBuf, Fault> {
    let folder = target().join("traces");
    for name in SCENES {
        let out = folder.join(name);
        let scene = top().join("scenes").join(format!("{name}.toml"));
        let mut command = workspace_program("host-sim");
        run(command
            .args(["--quiet", "run", "--no-plot"])
            .arg(scene)
            .arg("--out")
            .arg(&out))?;
        let mut hash = std::process::Command::new("sha256sum");
        let said = output(hash.arg(out.join("trace.csv")))?;
        let hash = said.split_whitespace().next().unwrap_or_default();
        write(&folder.join(format!("{name}.sha256")), hash)?;
    }
    Ok(folder)
}
