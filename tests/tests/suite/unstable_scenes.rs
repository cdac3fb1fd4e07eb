//! Scenes that forward Euler cannot carry are refused by the simulator before
//! it writes anything: exit status 2, the file, the key, what was found and
//! what is allowed. (Where the limits stand is for the crate `config` to test.)

use crate::common;
use std::path::Path;

use acceptance::reference::Settings;
use host_sim::commands::run::{self, Arguments};
use host_sim::progress::Verbosity;

/// Runs the reference scene at other rates; the refusal, if there is one.
fn refusal(frequency_hz: f64, tick_hz: f64, integrator: &str) -> Option<(u8, String)> {
    let settings = Settings {
        frequency_hz,
        tick_hz,
        ..Settings::papers()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, common::scene(&settings, integrator, 0.1)).unwrap();
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let error = run::run(&Arguments::of(&path, &out), Verbosity::Quiet).err()?;
    assert!(is_empty(&out), "nothing is written");
    let name = path.display().to_string();
    let said = error.to_string();
    for line in said.lines() {
        assert!(line.starts_with(&name), "{line}");
    }
    Some((error.exit_status(), said.replace(&name, "scene.toml")))
}

fn is_empty(folder: &Path) -> bool {
    std::fs::read_dir(folder).unwrap().next().is_none()
}

#[test]
fn too_few_ticks_a_whisk_for_forward_euler() {
    let (status, said) = refusal(25.0, 400.0, "euler").unwrap();
    assert_eq!(status, 2);
    assert_eq!(
        said,
        "scene.toml: whisking.integrator: found \"euler\" at 25 Hz with tick_hz = 400: a tick \
         multiplies the muscles' fast mode by -1.33, so it grows; allowed: integrator = \
         \"exact\", or \"euler\" with tick_hz at least 467"
    );
    assert_eq!(refusal(25.0, 467.0, "euler"), None);
    assert_eq!(refusal(25.0, 400.0, "exact"), None);
}
