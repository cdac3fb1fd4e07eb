//! Keys that are given beside the file, such as on a command line.

use std::fmt;
use std::str::FromStr;

use toml::de::DeValue;

/// A key that is given in place of the file's, or besides: it is checked as if it stood there.
///
/// ```
/// use scene::{Override, Scene};
///
/// let text = "
///     name = 'still'
///     tick_hz = 2000
///     duration_s = 1
///     seed = 1
///     head.whiskers_per_side = 1
///     plant.kind = 'ideal'
/// ";
/// let longer: Override = "duration_s=2.5".parse()?;
/// let (scene, _) = Scene::from_str_with("still.toml", text, &[longer]).unwrap();
/// assert_eq!(scene.duration_s, 2.5);
///
/// let slip: Override = "head.whisker_per_side=2".parse()?;
/// let problems = Scene::from_str_with("still.toml", text, &[slip]).unwrap_err();
/// assert_eq!(
///     problems.to_string(),
///     "--set head.whisker_per_side=2: head.whisker_per_side: unknown key; \
///      did you mean `whiskers_per_side`? allowed here: whiskers_per_side, rows, \
///      sides, nodes, bus_kbit_s"
/// );
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override {
    source: String,
    key: String,
    value: String,
}

impl Override {
    /// A key, with its section where it has one (`plant.stiffness`), and its value: TOML, or
    /// a word without its quotes. Messages call it `source`.
    pub fn new(source: String, key: &str, value: &str) -> Self {
        Self {
            source,
            key: key.trim().to_owned(),
            value: value.trim().to_owned(),
        }
    }

    /// The key.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// The value as it was given.
    pub fn value(&self) -> &str {
        &self.value
    }

    pub(crate) fn source(&self) -> &str {
        &self.source
    }

    pub(crate) fn toml(&self) -> String {
        let Self { key, value, .. } = self;
        if DeValue::parse(value).is_ok() {
            return format!("{key} = {value}");
        }
        let quoted = toml::Value::String(value.clone());
        format!("{key} = {quoted}")
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.value)
    }
}

/// `KEY=VALUE`, as the option `--set` has it.
impl FromStr for Override {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((key, value)) if !key.trim().is_empty() && !value.trim().is_empty() => {
                Ok(Self::new(format!("--set {text}"), key, value))
            }
            _ => Err("allowed: KEY=VALUE, such as plant.stiffness=0.2".to_owned()),
        }
    }
}
