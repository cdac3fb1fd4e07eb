//! Runs the product on the settings of the reference program.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::reference::claims::read_trace;
use crate::reference::{Gate, Obstacle, Row, Settings};
use host_sim::commands::run::{self, Arguments};
use host_sim::progress::Verbosity;

fn scene(settings: &Settings, integrator: &str, duration_s: f64) -> String {
    let [left, right] = &settings.gains;
    assert_eq!(left.len(), right.len());
    let gains: Vec<f64> = left.iter().chain(right).copied().collect();
    let mut text = format!(
        "name = \"reference\"\ntick_hz = {}\nduration_s = {duration_s:?}\nseed = 1\n\
         [head]\nwhiskers_per_side = {}\n\
         [whisking]\nfrequency_hz = {:?}\nintegrator = \"{integrator}\"\ncoupling = {}\n\
         noise = 0.0\ngain = {gains:?}\nstart = {:?}\n",
        settings.tick_hz,
        left.len(),
        settings.frequency_hz,
        settings.coupling,
        settings.start,
    );
    for (name, gate) in [("rcp", &settings.rcp), ("cia", &settings.cia)] {
        if let Some(Gate { gain, tau_s }) = gate {
            writeln!(text, "[{name}]\ngain = {gain:?}\ntau_s = {tau_s:?}").unwrap();
        }
    }
    text += "[plant]\nkind = \"ideal\"\n";
    if let Some(Obstacle { at_deg, stiffness }) = settings.obstacle {
        writeln!(text, "obstacle_deg = {at_deg:?}\nstiffness = {stiffness:?}").unwrap();
    }
    text
}

/// The product's trace of `settings`.
pub(crate) fn trace(settings: &Settings, integrator: &str, duration_s: f64) -> Vec<Row> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, scene(settings, integrator, duration_s)).unwrap();
    let arguments = Arguments::of(&path, folder.path());
    run::run(&arguments, Verbosity::Quiet).unwrap();
    let text = std::fs::read_to_string(folder.path().join("trace.csv")).unwrap();
    read_trace(&text).unwrap()
}

pub(crate) fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}
