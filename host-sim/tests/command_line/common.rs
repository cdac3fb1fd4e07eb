//! A folder to run the program in, and files to give it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use host_sim::classifier::Classifier;
use host_sim::decisions::Decided;
use host_sim::run::Run;
use scene::Scene;
use tactile::ModelBuf;
use tactile::train::{Options, Trainer};
use tempfile::TempDir;

/// Two textures of an active whisker that is touched gently; half a second.
pub(crate) const TEXTURED: &str = r#"name = "textured"
tick_hz = 2000
duration_s = 0.5
seed = 1
[head]
whiskers_per_side = 1
sides = "left"
[whisking]
frequency_hz = 8.0
integrator = "exact"
coupling = false
noise = 0.01
gain = 1.0
start = [[1.0, 0.0]]
[rcp]
gain = 0.7
tau_s = 0.03
[plant]
kind = "textured"
obstacle_deg = [80.0]
stiffness = 0.1
textures = ["smooth", "carpet"]
present_s = 0.125
exchange = "timed"
"#;

pub(crate) const SEQUENTIAL: &str =
    "[classifier]\nrule = \"sequential\"\nmodel = \"the.model\"\nthreshold = 0.9\n";

/// Both sides before obstacles, without motors; a tenth of a second.
pub(crate) const IDEAL: &str = r#"name = "ideal"
tick_hz = 2000
duration_s = 0.1
seed = 1
[head]
whiskers_per_side = 2
[whisking]
frequency_hz = 10.0
integrator = "euler"
coupling = true
noise = 0.0
gain = 1.0
start = [[1.0, 0.0], [0.6, 0.5]]
[rcp]
gain = 0.7
tau_s = 0.02
[plant]
kind = "ideal"
obstacle_deg = [80.0, 90.0]
stiffness = 0.1
"#;

/// Two classes of sensor codes, distinguished by x.
pub(crate) const RECORDING: &str = "label,trial,x,y\n\
    low,0,100,8000\nlow,0,120,8100\nlow,1,140,8000\nlow,1,110,8100\n\
    high,0,9000,8000\nhigh,0,9100,8100\nhigh,1,9050,8000\nhigh,1,9020,8100\n";

pub(crate) struct Place(TempDir);

#[derive(Debug)]
pub(crate) struct Ran {
    /// `None`: by a signal.
    pub(crate) status: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Place {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn with(files: &[(&str, &str)]) -> Self {
        let place = Self::new();
        for (name, text) in files {
            place.write(name, text);
        }
        place
    }

    /// With s.toml, t.toml, which presents textures, r.csv and a model m.
    pub(crate) fn usual() -> Self {
        let scenes = [("s.toml", IDEAL), ("t.toml", TEXTURED)];
        let place = Self::with(&[&scenes[..], &[("r.csv", RECORDING)]].concat());
        place.write("m", model(2, 20, true));
        place
    }

    /// With a scene s.toml that classifies by the.model, and ideal.toml.
    pub(crate) fn classifying() -> Self {
        let classifies = format!("{TEXTURED}{SEQUENTIAL}");
        let place = Self::with(&[("s.toml", &classifies), ("ideal.toml", IDEAL)]);
        place.write("the.model", model(2, 20, true));
        place
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    /// A table of comma-separated values, none of which is in quotes.
    pub(crate) fn table(&self, name: &str) -> Vec<Vec<&'static str>> {
        cells(self.text(name).leak())
    }

    pub(crate) fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
        command
            .args(line.split_ascii_whitespace())
            .current_dir(self.0.path())
            .stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, line: &str) -> Ran {
        let output = self.command(line).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Ran {
            status: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// Runs the program here, which must succeed and have nothing to complain of.
    pub(crate) fn done(&self, line: &str) -> Ran {
        let ran = self.run(line);
        assert_eq!((ran.status, ran.stderr.as_str()), (Some(0), ""), "{line}");
        ran
    }

    /// Runs the program here, which must succeed; what it says on standard error.
    #[track_caller]
    pub(crate) fn warned(&self, line: &str) -> String {
        let ran = self.run(line);
        assert_eq!(ran.status, Some(0), "{line}: {ran:?}");
        ran.stderr
    }

    /// The whole content of the folder; `None` for a folder.
    pub(crate) fn content(&self) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut content = BTreeMap::new();
        walk(self.0.path(), &mut content);
        content
    }

    /// Status 2, a message that has each of `naming`, and the folder as it was.
    pub(crate) fn refuses(&self, line: &str, naming: &[&str]) {
        let before = self.content();
        let ran = self.run(line);
        assert_eq!(ran.status, Some(2), "{line}: {ran:?}");
        assert_eq!(ran.stdout, "", "{line}");
        for name in naming {
            assert!(ran.stderr.contains(name), "{line}: no {name:?} in: {ran:?}");
        }
        let after = self.content();
        let names = |content: &BTreeMap<PathBuf, _>| content.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&after), names(&before), "{line}");
        assert!(after == before, "{line} changed a file");
    }

    /// Once onto older output, which must survive, and once into a folder that is not there.
    pub(crate) fn refuses_to_write(&self, line: &str, naming: &[&str]) {
        let old = ["old/trace.csv", "old/decisions.csv", "old/file"];
        for name in old {
            self.write(name, "older output");
        }
        let outs = if line.starts_with("run ") {
            ["old", "new/deep"]
        } else {
            ["old/file", "new/deep/file"]
        };
        for out in outs {
            self.refuses(&format!("{line} --out {out}"), naming);
        }
    }

    /// Refuses each line of a table: a command, and behind bars what the message names. One that
    /// writes and says nowhere what refuses to write.
    pub(crate) fn refuses_each(&self, table: &str) {
        for row in table.trim().lines() {
            let mut cells = row.split('|').map(str::trim);
            let command = cells.next().unwrap();
            let naming: Vec<&str> = cells.collect();
            let writes = ["run", "train", "classify", "sweep"];
            let writes = writes.iter().any(|name| command.starts_with(name));
            if writes && !command.contains("--out") {
                self.refuses_to_write(command, &naming);
            } else {
                self.refuses(command, &naming);
            }
        }
    }
}

fn walk(folder: &Path, content: &mut BTreeMap<PathBuf, Option<Vec<u8>>>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            walk(&path, content);
            content.insert(path, None);
        } else {
            let bytes = std::fs::read(&path).unwrap();
            content.insert(path, Some(bytes));
        }
    }
}

/// Two classes, trained on two samples, whole numbers or not.
pub(crate) fn model(channels: usize, block: u32, whole: bool) -> Vec<u8> {
    let options = Options {
        bins: 10,
        smooth: 1.0,
        block,
    };
    let mut trainer = Trainer::new(channels, options).unwrap();
    let high = if whole { 9000.0 } else { 9000.25 };
    trainer.add("smooth", &vec![8000.0; channels]).unwrap();
    trainer.add("carpet", &vec![high; channels]).unwrap();
    trainer.train().unwrap().as_bytes().to_vec()
}

/// A run of a scene, whose classifier, if it has one, has such a model.
pub(crate) fn run(scene: &Scene) -> Run {
    let classifier = scene.classifier.as_ref();
    let classifier = classifier.map(|_| Classifier::of_scene(its_model(), scene).unwrap());
    Run::new(scene, classifier).unwrap()
}

pub(crate) fn its_model() -> ModelBuf {
    ModelBuf::from_bytes(&model(2, 20, true)).unwrap()
}

#[track_caller]
pub(crate) fn says(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no {part:?} in {text}");
    }
}

#[track_caller]
pub(crate) fn line<'t>(text: &'t str, name: &str) -> &'t str {
    let found = text.lines().find(|line| line.starts_with(name));
    found.unwrap_or_else(|| panic!("no {name:?} in {text}"))
}

pub(crate) fn column<'t>(rows: &[Vec<&'t str>], name: &str) -> Vec<&'t str> {
    let at = rows[0].iter().position(|title| *title == name);
    let at = at.unwrap_or_else(|| panic!("no {name}"));
    rows[1..].iter().map(|row| row[at]).collect()
}

pub(crate) fn numbers(rows: &[Vec<&str>], name: &str) -> Vec<f64> {
    let cells = column(rows, name).into_iter();
    cells.map(|cell| cell.parse().unwrap()).collect()
}

pub(crate) fn cells(text: &str) -> Vec<Vec<&str>> {
    text.lines().map(|line| line.split(',').collect()).collect()
}

/// What stands before the reasons; checks the header, too. That of a scene has the time, and where
/// several are heard the whisker.
pub(crate) fn decisions(text: &str) -> Vec<Decided> {
    let mut rows = cells(text).into_iter();
    let header = rows.next().unwrap().join(",");
    let header = header.strip_suffix(",reason,among").unwrap();
    let more = header.strip_prefix("label,trial,decision,samples,posterior,touch");
    let (more, allowed) = (more.unwrap(), ["", ",t_s", ",t_s,side,whisker"]);
    assert!(allowed.contains(&more), "{header}");
    let decided = |row: Vec<&str>| Decided {
        t_s: (!more.is_empty()).then(|| row[6].parse().unwrap()),
        place: None,
        label: row[0].into(),
        trial: row[1].into(),
        decision: row[2].into(),
        reason: None,
        among: None,
        samples: row[3].parse().unwrap(),
        posterior: row[4].parse().unwrap(),
        touch: row[5].parse().unwrap(),
        pose: None,
    };
    rows.map(decided).collect()
}
