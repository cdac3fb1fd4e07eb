//! A folder to run the program in.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tempfile::TempDir;

/// A whisker before two textures, which decides nothing; RCP has contact computed.
pub(crate) const BENCH: &str = r#"name = "bench"
tick_hz = 2000
duration_s = 3.0
seed = 1
[head]
whiskers_per_side = 1
sides = "left"
[whisking]
frequency_hz = 2.0
integrator = "exact"
coupling = false
noise = 0.005
gain = 1.0
start = [[1.0, 0.0]]
[rcp]
gain = 0.7
tau_s = 0.125
[plant]
kind = "textured"
obstacle_deg = [100.0]
stiffness = 0.1
textures = ["smooth", "carpet"]
present_s = 1.0
"#;

/// A file of the workspace's scenes.
pub(crate) fn scenes(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../scenes")
        .join(name)
}

/// The scene of the main job.
pub(crate) fn textures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/textures.toml")
}

/// A folder to work in; gone when dropped.
pub(crate) struct Place(TempDir);

/// How the program ended.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) status: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Place {
    /// A folder with [`BENCH`] in it.
    pub(crate) fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        place.write("bench.toml", BENCH);
        place
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub(crate) fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Runs the program with these arguments, which have no spaces within.
    pub(crate) fn run(&self, arguments: &str) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_whisker"))
            .args(arguments.split_whitespace())
            .current_dir(self.0.path())
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Ran {
            status: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// The same, which must end well.
    pub(crate) fn done(&self, arguments: &str) -> Ran {
        let ran = self.run(arguments);
        assert_eq!(ran.status, Some(0), "{arguments}: {}", ran.stderr);
        ran
    }

    /// The same, which must be refused: what it says.
    pub(crate) fn refused(&self, arguments: &str) -> String {
        let ran = self.run(arguments);
        assert_eq!(ran.status, Some(2), "{arguments}: {}", ran.stderr);
        assert_eq!(ran.stdout, "");
        ran.stderr
    }
}
