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

/// Changes to a whisker on each side, for [`bench_with`].
pub(crate) const TWO_SIDES: &[(&str, &str)] = &[
    ("\"left\"", "\"both\""),
    ("[[1.0, 0.0]]", "[[1.0, 0.0], [1.0, 0.0]]"),
    ("[100.0]", "[100.0, 100.0]"),
];

/// A change to another name, for [`bench_with`].
pub(crate) const OTHER: (&str, &str) = ("\"bench\"", "\"other\"");

/// [`BENCH`] with other text in place of some, each of which must be there.
pub(crate) fn bench_with(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(BENCH.to_owned(), |scene, (from, to)| {
        assert!(scene.contains(from), "no {from:?}");
        scene.replace(from, to)
    })
}

/// The words of a command line, none of which has a space within; `@` stands for the folder of
/// the workspace's scenes.
pub(crate) fn words(line: &str) -> Vec<String> {
    let folder = scenes("").display().to_string();
    let words = line.split_whitespace();
    words.map(|word| word.replace('@', &folder)).collect()
}

pub(crate) fn scenes(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../scenes")
        .join(name)
}

pub(crate) struct Place(TempDir);

#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) status: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Place {
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

    /// [`BENCH`] with these changes, as a file.
    pub(crate) fn bench(&self, name: &str, changes: &[(&str, &str)]) {
        self.write(name, &bench_with(changes));
    }

    pub(crate) fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    #[track_caller]
    pub(crate) fn holds(&self, name: &str, text: &str) {
        contains(&self.text(name), text);
    }

    /// The numbers of a column of a table of records.
    pub(crate) fn column(&self, name: &str, column: &str) -> Vec<f64> {
        let table = self.text(name);
        let mut rows = table.lines().filter(|line| !line.starts_with('#'));
        let at = rows.next().unwrap().split(',').position(|of| of == column);
        let cells = rows.map(|row| row.split(',').nth(at.unwrap()).unwrap());
        cells.map(|cell| cell.parse().unwrap()).collect()
    }

    pub(crate) fn run(&self, arguments: &str) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_whisker"))
            .args(words(arguments))
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

    #[track_caller]
    pub(crate) fn done(&self, arguments: &str) -> Ran {
        let ran = self.run(arguments);
        assert_eq!(ran.status, Some(0), "{arguments}: {}", ran.stderr);
        ran
    }

    #[track_caller]
    pub(crate) fn fails(&self, arguments: &str) -> Ran {
        let ran = self.run(arguments);
        assert_eq!(ran.status, Some(1), "{arguments}: {}", ran.stderr);
        ran
    }

    #[track_caller]
    pub(crate) fn refuses(&self, arguments: &str, why: &str) {
        let ran = self.run(arguments);
        assert_eq!(ran.status, Some(2), "{arguments}: {}", ran.stderr);
        assert_eq!(ran.stdout, "");
        assert!(ran.stderr.contains(why), "{arguments}: {}", ran.stderr);
    }
}

impl Ran {
    #[track_caller]
    pub(crate) fn prints(&self, text: &str) {
        contains(&self.stdout, text);
    }

    #[track_caller]
    pub(crate) fn warns(&self, text: &str) {
        contains(&self.stderr, text);
    }
}

#[track_caller]
pub(crate) fn contains(found: &str, text: &str) {
    assert!(found.contains(text), "no {text:?}: {found}");
}

/// The text of a scene of the workspace.
pub(crate) fn scene(name: &str) -> String {
    std::fs::read_to_string(scenes(name)).unwrap()
}
