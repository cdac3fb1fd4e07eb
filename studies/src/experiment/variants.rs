//! Changes of rigs that are tried beside them: values that were chosen, undone; and what might
//! be why a claim is not met, changed.

use anyhow::Result;
use std::sync::LazyLock;

use serde::Deserialize;

use super::recording::Dataset;
use super::request::Name;
use crate::paper::printed;
use crate::rigs::Setting;

/// Why a change is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    /// It undoes what was chosen.
    Without,
    /// It changes what might be a cause.
    Cause,
}

/// A change.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Variant {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// What is to be known of it.
    pub(super) note: String,
    /// Keys of one rig.
    set: Vec<String>,
    /// Whether it might tell a placebo apart, so that it has one.
    #[serde(default)]
    pub(super) has_placebo: bool,
}

/// All of them.
pub(super) static VARIANTS: LazyLock<Vec<Variant>> =
    LazyLock::new(|| printed(include_str!("../../variants.toml"), "variants"));

impl Variant {
    /// The keys that it sets.
    pub(super) fn settings(&self) -> Result<Vec<Setting>> {
        let settings = self.set.iter().map(|text| text.parse());
        settings
            .collect::<Result<_, _>>()
            .map_err(anyhow::Error::msg)
    }

    /// The data set of the rig that it changes.
    pub(super) fn dataset(&self) -> Option<Dataset> {
        let rig = self.set.first()?.split('.').next()?;
        let all = Name::ALL.iter().flat_map(|name| name.datasets());
        all.copied().find(|dataset| dataset.text() == rig)
    }
}

#[cfg(test)]
mod tests {
    use super::VARIANTS;
    use crate::rigs::Rigs;

    #[test]
    fn every_variant_changes_one_rig() {
        let plain = Rigs::load(None, &[]).unwrap();
        for variant in VARIANTS.iter() {
            let settings = variant.settings().unwrap();
            let dataset = variant.dataset().unwrap();
            assert!(settings.iter().all(|one| one.rig() == dataset.text()));
            let changed = Rigs::load(None, &settings).unwrap();
            assert_ne!(changed, plain, "{}", variant.name);
            assert!(!variant.note.is_empty());
        }
    }
}
