//! Reading a rig: the keys that are built in, in whose place come those of a file that holds
//! what differs, and in theirs those that are set by name. An unknown or mistyped key and a
//! value out of range are errors that name the file, the line and the key.

use std::ops::RangeInclusive;
use std::path::Path;

use host_sim::Error;
use serde::de::DeserializeOwned;
use toml::Table;

use super::overlay::{Fault, overlay};
use super::setting::Setting;

/// A number of a rig that is out of its range: its key, and what is wrong.
pub(crate) type OutOfRange = (&'static str, String);

/// Keys of a file that can say whether their numbers are in range.
pub(crate) trait Keys: DeserializeOwned {
    fn check(&self) -> Result<(), OutOfRange>;
}

/// Has no range.
impl Keys for bool {
    fn check(&self) -> Result<(), OutOfRange> {
        Ok(())
    }
}

/// A rig: keys in a file of their own.
pub(crate) trait Rig: Keys {
    const FILE: &'static str;
    /// The values of all keys where nothing else is said.
    fn defaults() -> String;
}

/// A key's value, as the numbers that must be in its range.
pub(super) trait Numbers {
    fn numbers(&self) -> Vec<f64>;
}

impl Numbers for f64 {
    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }
}

impl Numbers for usize {
    fn numbers(&self) -> Vec<f64> {
        vec![*self as f64]
    }
}

/// Checks that all of `found` are in `range`; what is not a number is in none.
pub(super) fn within(
    key: &'static str,
    found: &impl Numbers,
    range: &RangeInclusive<f64>,
) -> Result<(), OutOfRange> {
    let (low, high) = (range.start(), range.end());
    match found.numbers().iter().find(|found| !range.contains(found)) {
        None => Ok(()),
        Some(found) => Err((key, format!("found {found}, allowed {low} to {high}"))),
    }
}

/// Declares the keys of a rig, or of a part of one that has no file: each with
/// its type and, if it is a number, the range, which may name other keys of `rig`.
macro_rules! keys {
    (
        $(#[$meta:meta])*
        $name:ident $(in $file:literal)?, $rig:ident:
        $($key:ident: $type:ty $(=> $range:expr)?,)*
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(crate) struct $name {
            $(pub(crate) $key: $type,)*
        }

        impl crate::rigs::read::Keys for $name {
            fn check(&self) -> Result<(), crate::rigs::read::OutOfRange> {
                let $rig = self;
                $(crate::rigs::read::keys!(@check $rig, $key $(, $range)?);)*
                Ok(())
            }
        }

        $(impl crate::rigs::read::Rig for $name {
            const FILE: &'static str = $file;

            fn defaults() -> String {
                include_str!(concat!("../../rigs/", $file)).to_owned()
            }
        })?
    };
    (@check $rig:ident, $key:ident) => {
        crate::rigs::read::Keys::check(&$rig.$key)?;
    };
    (@check $rig:ident, $key:ident, $range:expr) => {
        crate::rigs::read::within(stringify!($key), &$rig.$key, &$range)?;
    };
}
pub(super) use keys;

/// The rig that is built in, with what the file in `folder` says, if there is one, and with
/// those of `settings` that are its keys.
pub(crate) fn load<R: Rig>(folder: Option<&Path>, settings: &[Setting]) -> Result<R, Error> {
    let path = folder.map(|folder| folder.join(R::FILE));
    let there = path.filter(|path| path.exists());
    let text = match &there {
        Some(path) => std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?,
        None => String::new(),
    };
    let path = there.as_deref().unwrap_or(Path::new(R::FILE));
    parse(path, &text, settings)
}

/// A rig from the text of its file, which has what differs, and from settings; `path` is for
/// the messages.
pub(crate) fn parse<R: Rig>(path: &Path, text: &str, settings: &[Setting]) -> Result<R, Error> {
    let at = |line: usize, fault: String| Error::file(path, format_args!("line {line}: {fault}"));
    let mut keys: Table =
        toml::from_str(&R::defaults()).map_err(|error| at(1, error.to_string()))?;
    let own: Table = toml::from_str(text).map_err(|error: toml::de::Error| {
        let at_byte = error.span().map_or(0, |span| span.start);
        let before = text.bytes().take(at_byte);
        let line = 1 + before.filter(|byte| *byte == b'\n').count();
        at(line, error.message().replace('\n', " "))
    })?;
    let of_file = |(key, fault): Fault| at(line_of(text, &key), format!("{key}: {fault}"));
    overlay(&mut keys, own).map_err(of_file)?;
    check::<R>(&keys).map_err(of_file)?;
    let name = R::FILE.trim_end_matches(".toml");
    let mine: Vec<&Setting> = settings.iter().filter(|one| one.rig() == name).collect();
    if mine.is_empty() {
        return check(&keys).map_err(of_file);
    }
    let wrong = |(key, fault): Fault| Error::Input(format!("{name}.{key}: {fault}"));
    for setting in mine {
        overlay(&mut keys, setting.table()).map_err(wrong)?;
    }
    check(&keys).map_err(wrong)
}

fn check<R: Rig>(keys: &Table) -> Result<R, Fault> {
    let rig: R = keys
        .clone()
        .try_into()
        .map_err(|error: toml::de::Error| (String::new(), error.message().replace('\n', " ")))?;
    let wrong = |(key, fault): OutOfRange| (key.to_owned(), fault);
    rig.check().map_err(wrong)?;
    Ok(rig)
}

/// The line on which `key` is set.
fn line_of(text: &str, key: &str) -> usize {
    let sets = |line: &str| {
        line.trim_start()
            .strip_prefix(key)
            .is_some_and(|rest| rest.trim_start().starts_with('='))
    };
    1 + text.lines().position(sets).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::{Rig, Setting, load, parse};
    use crate::rigs::{Corridor, Floor, Maze, Pad, Table, WhiskingHead};
    use std::path::Path;

    fn fault(text: &str) -> String {
        let found = parse::<Floor>(Path::new("x.toml"), text, &[]);
        found.unwrap_err().to_string()
    }

    #[test]
    fn a_file_holds_what_differs_and_settings_come_last() {
        let plain: Floor = load(None, &[]).unwrap();
        let settings = ["floor.press_m=0.01", "head.gain=2"].map(|text| text.parse().unwrap());
        let text = "press_m = 0.02\nturn_rad_s = 1\n";
        let found: Floor = parse(Path::new("x.toml"), text, &settings).unwrap();
        assert_eq!((found.press_m, found.turn_rad_s), (0.01, 1.0));
        let same = Floor {
            press_m: plain.press_m,
            turn_rad_s: plain.turn_rad_s,
            ..found
        };
        assert_eq!(same, plain);
        let motor: Setting = "head.motor.kp=0.3".parse().unwrap();
        let head: WhiskingHead = load(None, &[motor]).unwrap();
        assert_eq!(head.motor.kp, 0.3);
    }

    #[test]
    fn faults_name_file_line_and_key() {
        let wrong = fault("# a robot\nazimut_deg = 3.0\n");
        assert!(
            wrong.starts_with("x.toml: line 2: azimut_deg: unknown key, allowed: azimuth_deg"),
            "{wrong}"
        );
        let wide = fault("\nazimuth_deg   = 200.0\n");
        assert_eq!(
            wide,
            "x.toml: line 2: azimuth_deg: found 200, allowed -90 to 90"
        );
        assert!(fault("azimuth_deg = nan").contains("NaN"));
        let typed = fault("press_m = \"deep\"");
        assert_eq!(
            typed,
            "x.toml: line 1: press_m: found \"deep\", allowed what is like 0.008"
        );
        assert!(fault("full_scale_rad = [1.0]").contains("allowed what is like ["));
        assert!(fault("press_m =").starts_with("x.toml: line 1: "));
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
        for text in [
            Floor::defaults(),
            WhiskingHead::defaults(),
            Table::defaults(),
            Pad::defaults(),
            Corridor::defaults(),
            Maze::defaults(),
        ] {
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
