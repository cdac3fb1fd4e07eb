//! Keys of rigs that are set by name.

use std::fmt;
use std::str::FromStr;

use toml::Table;

/// A key of a rig and its value in TOML, such as `head.motor.kp=0.2`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Setting {
    pub(super) rig: String,
    /// The keys of the rig that it sets.
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
