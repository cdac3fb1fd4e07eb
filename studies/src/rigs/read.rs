//! Reading a rig's file: an unknown, missing or mistyped key and a value out
//! of range are errors that name the file, the line and the key.

use std::path::Path;

use serde::de::DeserializeOwned;

use host_sim::Error;

/// A number of a rig that is out of its range.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfRange {
    /// The key.
    pub key: &'static str,
    /// What was found.
    pub found: f64,
    /// The least that is allowed.
    pub low: f64,
    /// The most.
    pub high: f64,
}

/// A rig that can say whether its numbers are in range.
pub trait Rig: DeserializeOwned {
    /// The name of its file.
    const FILE: &'static str;
    /// The text that is used where no folder is given.
    const DEFAULT: &'static str;

    /// Checks every number.
    ///
    /// # Errors
    /// The first that is out of range.
    fn check(&self) -> Result<(), OutOfRange>;
}

/// `found` if it is in `low..=high`.
///
/// # Errors
/// [`OutOfRange`] otherwise, and for what is not a number.
pub fn within(key: &'static str, found: f64, low: f64, high: f64) -> Result<f64, OutOfRange> {
    if (low..=high).contains(&found) {
        Ok(found)
    } else {
        Err(OutOfRange {
            key,
            found,
            low,
            high,
        })
    }
}

/// The rig in `folder`, or the one built in.
///
/// # Errors
/// [`Error::Input`].
pub fn load<R: Rig>(folder: Option<&Path>) -> Result<R, Error> {
    let Some(folder) = folder else {
        return parse(Path::new(R::FILE), R::DEFAULT);
    };
    let path = folder.join(R::FILE);
    let text = std::fs::read_to_string(&path).map_err(|error| Error::file(&path, error))?;
    parse(&path, &text)
}

/// A rig from its text; `path` is for the messages.
///
/// # Errors
/// [`Error::Input`].
pub fn parse<R: Rig>(path: &Path, text: &str) -> Result<R, Error> {
    let rig: R = toml::from_str(text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        let line = 1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count();
        let message = error.message().replace('\n', " ");
        Error::file(path, format_args!("line {line}: {message}"))
    })?;
    match rig.check() {
        Ok(()) => Ok(rig),
        Err(OutOfRange {
            key,
            found,
            low,
            high,
        }) => {
            let line = line_of(text, key);
            Err(Error::file(
                path,
                format_args!("line {line}: {key}: found {found}, allowed {low} to {high}"),
            ))
        }
    }
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
    use super::{Rig, parse};
    use crate::rigs::Floor;
    use std::path::Path;

    fn fault(text: &str) -> String {
        parse::<Floor>(Path::new("x.toml"), text)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn faults_name_file_line_and_key() {
        let changed = |from: &str, to: &str| {
            assert!(Floor::DEFAULT.contains(from), "{from}");
            Floor::DEFAULT.replace(from, to)
        };
        let line = 1 + Floor::DEFAULT
            .lines()
            .position(|line| line.starts_with("azimuth_deg"))
            .unwrap();
        let wrong = fault(&changed("azimuth_deg", "azimut_deg"));
        assert!(
            wrong.starts_with(&format!("x.toml: line {line}:")),
            "{wrong}"
        );
        assert!(wrong.contains("azimut_deg"), "{wrong}");
        let wide = fault(&Floor::DEFAULT.replace("azimuth_deg   = 45.0", "azimuth_deg = 200.0"));
        assert_eq!(
            wide,
            format!("x.toml: line {line}: azimuth_deg: found 200, allowed -90 to 90")
        );
        let missing = fault("tick_hz = 2000.0\n");
        assert!(missing.contains("missing"), "{missing}");
        let nan = fault(&Floor::DEFAULT.replace("azimuth_deg   = 45.0", "azimuth_deg = nan"));
        assert!(nan.contains("NaN"), "{nan}");
    }
}
