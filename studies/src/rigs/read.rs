//! Reading a rig's file: an unknown, missing or mistyped key and a value out
//! of range are errors that name the file, the line and the key.

use std::ops::RangeInclusive;
use std::path::Path;

use serde::de::DeserializeOwned;

use host_sim::Error;

/// A number of a rig that is out of its range: its key, and what is wrong.
pub type OutOfRange = (&'static str, String);

/// Keys of a file that can say whether their numbers are in range.
pub trait Keys: DeserializeOwned {
    /// Checks every number.
    ///
    /// # Errors
    /// The first that is out of range.
    fn check(&self) -> Result<(), OutOfRange>;
}

/// Has no range.
impl Keys for bool {
    fn check(&self) -> Result<(), OutOfRange> {
        Ok(())
    }
}

/// A rig: keys in a file of their own.
pub trait Rig: Keys {
    /// The name of its file.
    const FILE: &'static str;
    /// The text that is used where no folder is given.
    const DEFAULT: &'static str;
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
        #[expect(missing_docs, reason = "each key is documented in the rig's file")]
        pub struct $name {
            $(pub $key: $type,)*
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
            const DEFAULT: &'static str = include_str!(concat!("../../rigs/", $file));
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
        Err((key, fault)) => {
            let line = line_of(text, key);
            Err(Error::file(
                path,
                format_args!("line {line}: {key}: {fault}"),
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
