//! The rigs of the five papers: where whiskers are fixed, how they are moved,
//! what is before them, and what they record. A rig is a file of its own, `studies/rigs/*.toml`,
//! whose keys are documented there; what is made of recordings is in [`crate::experiment`].

mod chance;
pub(crate) mod corridor;
pub(crate) mod floor;
mod frame;
pub(crate) mod head;
mod maze;
mod module;
pub(crate) mod pad;
mod read;
pub(crate) mod table;
pub(crate) mod whiskers;

use std::path::Path;

use host_sim::Error;
use toml::{Table as Document, Value};

use chance::Wander;
pub(crate) use chance::{Chance, seed_of};
pub(crate) use corridor::{Corridor, FELT, Felt, INPUTS, Pads, Robot, relief};
pub(crate) use floor::{Floor, RobotMotion, trials};
pub(crate) use frame::plane;
use frame::{direction, panned, turn};
pub(crate) use head::{CHANNELS, WhiskingHead};
pub(crate) use maze::{Made, Maze, Wall};
use module::{EACH, HeadModule, PositionControl, SIDES};
pub(crate) use pad::Pad;
use pad::{Layout, Vibrissa};
pub(crate) use read::Setting;
use read::{Fault, Keys, OutOfRange, keys, line_of, overlay};
pub(crate) use table::{Contact, Table, contacts};
pub(crate) use whiskers::Surfaces;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rigs {
    pub(crate) floor: Floor,
    pub(crate) head: WhiskingHead,
    pub(crate) table: Table,
    pub(crate) pad: Pad,
    pub(crate) corridor: Corridor,
    pub(crate) maze: Maze,
    pub(crate) surfaces: Surfaces,
}

/// The files of the rigs that are built in, by name; surfaces have none.
const FILES: [(&str, &str); 6] = [
    ("floor", include_str!("../rigs/floor.toml")),
    ("head", include_str!("../rigs/head.toml")),
    ("table", include_str!("../rigs/table.toml")),
    ("pad", include_str!("../rigs/pad.toml")),
    ("corridor", include_str!("../rigs/corridor.toml")),
    ("maze", include_str!("../rigs/maze.toml")),
];

fn names() -> String {
    let names = FILES.iter().map(|(name, _)| *name).chain(["surfaces"]);
    names.collect::<Vec<_>>().join(", ")
}

impl Rigs {
    /// The rigs that are built in, with what files in `folder` say, and `settings` after them.
    pub(crate) fn load(folder: Option<&Path>, settings: &[Setting]) -> Result<Self, Error> {
        let mut all = Document::from_iter([("surfaces".to_owned(), whiskers::defaults().into())]);
        for (name, text) in FILES {
            let file: Result<Document, _> = text.parse();
            let file = file.map_err(|error| Error::file(Path::new(name), error))?;
            all.insert(name.to_owned(), file.into());
        }
        if let Some(folder) = folder {
            let wrong = |error| Error::file(folder, error);
            for entry in std::fs::read_dir(folder).map_err(wrong)? {
                let path = entry.map_err(wrong)?.path();
                if path.extension() == Some("toml".as_ref()) {
                    let text = std::fs::read_to_string(&path);
                    let text = text.map_err(|error| Error::file(&path, error))?;
                    Self::read(&mut all, &path, &text)?;
                }
            }
        }
        for setting in settings {
            let rig = &setting.rig;
            let Some(Value::Table(keys)) = all.get_mut(rig) else {
                return Err(Error::Input(format!(
                    "{rig}: unknown rig, allowed: {}",
                    names()
                )));
            };
            overlay(keys, setting.keys.clone())
                .map_err(|(key, fault)| Error::Input(format!("{rig}.{key}: {fault}")))?;
        }
        Self::of(&all).map_err(|(rig, (key, fault))| Error::Input(format!("{rig}.{key}: {fault}")))
    }

    /// Puts what the text of a rig's file says in the place of what there is.
    fn read(all: &mut Document, path: &Path, text: &str) -> Result<(), Error> {
        let at = |line: usize, fault: &str| Error::file(path, format_args!("line {line}: {fault}"));
        let own: Document = text.parse().map_err(|error: toml::de::Error| {
            let at_byte = error.span().map_or(0, |span| span.start);
            let before = text.bytes().take(at_byte);
            let line = 1 + before.filter(|byte| *byte == b'\n').count();
            at(line, &error.message().replace('\n', " "))
        })?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let Some(Value::Table(keys)) = all.get_mut(&*name) else {
            let fault = format!("{name}.toml is no rig, allowed: {}", names());
            return Err(Error::file(path.parent().unwrap_or(path), fault));
        };
        overlay(keys, own)
            .and_then(|()| Self::of(all).map(drop).map_err(|(_, fault)| fault))
            .map_err(|(key, fault)| at(line_of(text, &key), &format!("{key}: {fault}")))
    }

    /// Rigs as a document has them; with a fault the rig.
    fn of(all: &Document) -> Result<Self, (&'static str, Fault)> {
        fn rig<R: Keys>(all: &Document, name: &'static str) -> Result<R, (&'static str, Fault)> {
            let keys = all.get(name).cloned().unwrap_or(Value::Boolean(false));
            let rig: R = keys.try_into().map_err(|error: toml::de::Error| {
                (name, (String::new(), error.message().replace('\n', " ")))
            })?;
            let checked = rig.check();
            checked.map_err(|(key, fault)| (name, (key.to_owned(), fault)))?;
            Ok(rig)
        }
        Ok(Self {
            floor: rig(all, "floor")?,
            head: rig(all, "head")?,
            table: rig(all, "table")?,
            pad: rig(all, "pad")?,
            corridor: rig(all, "corridor")?,
            maze: rig(all, "maze")?,
            surfaces: rig(all, "surfaces")?,
        })
    }

    #[cfg(test)]
    pub(crate) fn with(settings: &[&str]) -> Self {
        let settings: Vec<_> = settings.iter().map(|text| text.parse().unwrap()).collect();
        Self::load(None, &settings).unwrap()
    }
}

#[cfg(test)]
mod tests {
    use super::{FILES, Floor, Rigs, Setting};

    /// What a file of the floor robot in a folder, and settings, make of it.
    fn floor(text: &str, settings: &[&str]) -> Result<Floor, String> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("floor.toml"), text).unwrap();
        let settings: Vec<Setting> = settings.iter().map(|text| text.parse().unwrap()).collect();
        let found = Rigs::load(Some(folder.path()), &settings);
        let wrong = |fault: host_sim::Error| {
            let text = fault.to_string();
            text.replace(&folder.path().display().to_string(), "")
        };
        found.map(|rigs| rigs.floor).map_err(wrong)
    }

    #[test]
    fn a_file_holds_what_differs_and_settings_come_last() {
        let plain = Rigs::with(&[]).floor;
        let text = "press_m = 0.02\nturn_rad_s = 1\n";
        let found = floor(text, &["floor.press_m=0.01", "head.gain=2"]).unwrap();
        assert_eq!((found.press_m, found.turn_rad_s), (0.01, 1.0));
        let same = Floor {
            press_m: plain.press_m,
            turn_rad_s: plain.turn_rad_s,
            ..found
        };
        assert_eq!(same, plain);
        assert_eq!(Rigs::with(&["head.motor.kp=0.3"]).head.motor.kp, 0.3);
        // In range together, in any order.
        let both = ["floor.leg_least_s=5", "floor.leg_most_s=6"];
        let found = floor("", &both).unwrap();
        assert_eq!((found.leg_least_s, found.leg_most_s), (5.0, 6.0));
    }

    #[test]
    fn faults_name_file_line_and_key() {
        for (text, settings, expected) in [
            (
                "# a robot\nazimut_deg = 3.0\n",
                &[][..],
                "/floor.toml: line 2: azimut_deg: unknown key, allowed: azimuth_deg",
            ),
            (
                "\nazimuth_deg   = 200.0\n",
                &[],
                "/floor.toml: line 2: azimuth_deg: found 200, allowed -90 to 90",
            ),
            (
                "azimuth_deg = nan",
                &[],
                "/floor.toml: line 1: azimuth_deg: found NaN",
            ),
            (
                "press_m = \"deep\"",
                &[],
                "/floor.toml: line 1: press_m: found \"deep\", allowed what is like 0.008",
            ),
            (
                "full_scale_rad = [1.0]",
                &[],
                "/floor.toml: line 1: full_scale_rad: found [1.0], allowed what is like [",
            ),
            ("press_m =", &[], "/floor.toml: line 1: "),
            ("", &["floor.depth=1"], "floor.depth: unknown key"),
            (
                "",
                &["floor.leg_least_s=5"],
                "floor.leg_most_s: found 3, allowed 5 to 1000",
            ),
            ("", &["flor.press_m=1"], "flor: unknown rig, allowed: floor"),
        ] {
            let found = floor(text, settings).unwrap_err();
            assert!(found.starts_with(expected), "{found}");
        }
    }

    /// What stands beside a key: behind it, in the lines below it that go on, and in those above
    /// it since the last that is no comment.
    fn comment(lines: &[&str], key: usize) -> String {
        let is_comment = |line: &&&str| line.starts_with('#');
        let above = lines[..key].iter().rev().take_while(is_comment);
        let goes_on = |line: &&&str| line.starts_with(' ') && line.trim_start().starts_with('#');
        let below = lines[key + 1..].iter().take_while(goes_on);
        let behind = lines[key].split_once('#').map_or("", |(_, behind)| behind);
        let all = above.chain(below).copied().chain([behind]);
        all.collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn every_value_has_its_source_or_was_chosen() {
        const SOURCES: [&str; 6] = ["chosen", "section", "eq.", "Table", "BIOTACT", "\""];
        for (_, text) in FILES {
            let lines: Vec<&str> = text.lines().collect();
            let is_key = |line: &str| line.starts_with(|first: char| first.is_ascii_lowercase());
            for n in (0..lines.len()).filter(|n| is_key(lines[*n])) {
                // Keys that stand together share what is above the first.
                let first = (0..=n).rev().take_while(|n| is_key(lines[*n])).last();
                let beside = [n, first.unwrap_or(n)].map(|n| comment(&lines, n)).concat();
                let has_source = SOURCES.iter().any(|source| beside.contains(source));
                assert!(has_source, "{}", lines[n]);
            }
        }
    }
}
