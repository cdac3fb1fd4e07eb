//! Which scene a command is about, and what is different from its file.

use std::path::PathBuf;

use clap::Args;
use scene::Override;

/// A scene file, and keys in place of its own.
#[derive(Debug, Clone, Args)]
pub struct SceneChoice {
    /// The scene file (docs/scenes.md lists its keys)
    #[arg(value_name = "SCENE")]
    pub file: PathBuf,
    /// A key in place of the file's, such as plant.stiffness=0.2; may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<Override>,
}

impl From<PathBuf> for SceneChoice {
    fn from(file: PathBuf) -> Self {
        let set = Vec::new();
        Self { file, set }
    }
}

/// A seed as a scene has it: TOML's whole numbers end there.
///
/// # Errors
/// What is allowed instead.
pub fn seed(text: &str) -> Result<u64, String> {
    let seed: Option<u64> = text.parse().ok();
    let seed = seed.filter(|seed| i64::try_from(*seed).is_ok());
    seed.ok_or_else(|| format!("allowed: a whole number from 0 to {}", i64::MAX))
}
