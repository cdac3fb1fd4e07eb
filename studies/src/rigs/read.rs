//! Keys of rigs: their ranges, and keys in the place of others, of a file or set by name. An unknown
//! or mistyped key and a value out of range are errors that name the key.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use serde::de::DeserializeOwned;
use toml::{Table, Value};

/// A number of a rig that is out of its range: its key, and what is wrong.
pub(crate) type OutOfRange = (&'static str, String);

/// Keys of a file that can say whether their numbers are in range.
pub(crate) trait Keys: DeserializeOwned {
    fn check(&self) -> Result<(), OutOfRange>;
}

impl Keys for bool {
    fn check(&self) -> Result<(), OutOfRange> {
        Ok(())
    }
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

/// Declares the keys of a rig, or of a part of one: each with
/// its type and, if it is a number, the range, which may name other keys of `rig`.
macro_rules! keys {
    (
        $(#[$meta:meta])*
        $name:ident, $rig:ident:
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
    };
    (@check $rig:ident, $key:ident) => {
        crate::rigs::read::Keys::check(&$rig.$key)?;
    };
    (@check $rig:ident, $key:ident, $range:expr) => {
        crate::rigs::read::within(stringify!($key), &$rig.$key, &$range)?;
    };
}
pub(super) use keys;

pub(super) type Fault = (String, String);

/// Puts what `top` has in the place of what `base` has; both name the same things.
pub(super) fn overlay(base: &mut Table, top: Table) -> Result<(), Fault> {
    for (key, value) in top {
        let Some(place) = base.get_mut(&key) else {
            let known: Vec<&str> = base.keys().map(String::as_str).collect();
            let fault = format!("unknown key, allowed: {}", known.join(", "));
            return Err((key, fault));
        };
        match (place, value) {
            (Value::Table(inner), Value::Table(value)) => overlay(inner, value)?,
            (place, value) => {
                *place = alike(place, value).map_err(|fault| (key, fault))?;
            }
        }
    }
    Ok(())
}

/// The value, as the kind of `place`: a whole number will do for any.
fn alike(place: &Value, value: Value) -> Result<Value, String> {
    match (place, value) {
        (Value::Float(_), Value::Integer(whole)) => Ok(Value::Float(whole as f64)),
        (Value::Array(old), Value::Array(new)) if old.len() == new.len() => {
            let values = old.iter().zip(new);
            let values: Result<Vec<Value>, String> =
                values.map(|(old, new)| alike(old, new)).collect();
            values.map(Value::Array)
        }
        (place, value) if place.same_type(&value) && !place.is_array() => Ok(value),
        (place, value) => Err(format!("found {value}, allowed what is like {place}")),
    }
}

pub(super) fn line_of(text: &str, key: &str) -> usize {
    let sets = |line: &str| {
        line.trim_start()
            .strip_prefix(key)
            .is_some_and(|rest| rest.trim_start().starts_with('='))
    };
    1 + text.lines().position(sets).unwrap_or(0)
}

/// A key of a rig and its value in TOML, such as `head.motor.kp=0.2`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Setting {
    pub(super) rig: String,
    pub(super) keys: Table,
    text: String,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let allowed = "allowed: RIG.KEY=VALUE, such as head.motor.kp=0.2";
        let (key, value) = text.split_once('=').ok_or(allowed)?;
        let (rig, key) = key.trim().split_once('.').ok_or(allowed)?;
        let keys = toml::from_str(&format!("{key} = {}", value.trim()))
            .map_err(|error| format!("{}; {allowed}", error.message().replace('\n', " ")))?;
        Ok(Self {
            rig: rig.to_owned(),
            keys,
            text: text.to_owned(),
        })
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::Setting;

    #[test]
    fn a_setting_that_is_none_is_refused() {
        for text in ["press_m=1", "floor.press_m", "floor.press_m=deep"] {
            let wrong = text.parse::<Setting>().unwrap_err();
            assert!(wrong.contains("allowed: RIG.KEY=VALUE"), "{wrong}");
        }
    }
}
