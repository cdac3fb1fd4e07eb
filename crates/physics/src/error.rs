//! What is wrong with a setting.

/// A setting that is out of its range, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("plant setting {0} is out of range")]
pub struct BadSetting(pub &'static str);

impl BadSetting {
    /// `value` if it is in `lo..=hi`.
    ///
    /// # Errors
    /// The setting's `name`, also for what is not a number.
    pub fn check(name: &'static str, value: f64, lo: f64, hi: f64) -> Result<f64, Self> {
        if (lo..=hi).contains(&value) {
            Ok(value)
        } else {
            Err(Self(name))
        }
    }
}
