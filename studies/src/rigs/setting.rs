//! Keys of rigs that are set by name.

use std::fmt;
use std::str::FromStr;

use toml::{Table, Value};

/// A key of a rig and its value in TOML, such as `head.motor.kp=0.2`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Setting {
    path: Vec<String>,
    value: Value,
    text: String,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let allowed = "allowed: RIG.KEY=VALUE, such as head.motor.kp=0.2";
        let (key, value) = text.split_once('=').ok_or(allowed)?;
        let path: Vec<String> = key.trim().split('.').map(str::to_owned).collect();
        if path.len() < 2 {
            return Err(allowed.to_owned());
        }
        let document: Table = toml::from_str(&format!("value = {}", value.trim()))
            .map_err(|error| format!("{}; {allowed}", error.message().replace('\n', " ")))?;
        let value = document.get("value").cloned().ok_or(allowed)?;
        Ok(Self {
            path,
            value,
            text: text.to_owned(),
        })
    }
}

impl Setting {
    pub(crate) fn rig(&self) -> &str {
        self.path.first().map_or("", String::as_str)
    }

    pub(super) fn table(&self) -> Table {
        let keys = self.path.iter().skip(1).rev();
        let nested = keys.fold(self.value.clone(), |value, key| {
            Value::Table(Table::from_iter([(key.clone(), value)]))
        });
        nested.as_table().cloned().unwrap_or_default()
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
