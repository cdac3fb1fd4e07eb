//! Runs the product on the settings of the reference program.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use acceptance::claims::read_trace;
use acceptance::reference::{Row, Settings};
use host_sim::commands::run::{self, Arguments};
use host_sim::progress::Verbosity;

pub(crate) fn scene(settings: &Settings, integrator: &str, duration_s: f64) -> String {
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
        if let Some(gate) = gate {
            write!(
                text,
                "[{name}]\ngain = {:?}\ntau_s = {:?}\n",
                gate.gain, gate.tau_s
            )
            .unwrap();
        }
    }
    text.push_str("[plant]\nkind = \"ideal\"\n");
    if let Some(obstacle) = &settings.obstacle {
        let (at, stiffness) = (obstacle.at_deg, obstacle.stiffness);
        write!(text, "obstacle_deg = {at:?}\nstiffness = {stiffness:?}\n").unwrap();
    }
    text
}

/// The product's trace of `settings`.
pub(crate) fn trace(settings: &Settings, integrator: &str, duration_s: f64) -> Vec<Row> {
    run(&scene(settings, integrator, duration_s))
}

fn run(scene: &str) -> Vec<Row> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    let arguments = Arguments::of(&path, folder.path());
    run::run(&arguments, Verbosity::Quiet).unwrap();
    let text = std::fs::read_to_string(folder.path().join("trace.csv")).unwrap();
    read_trace(&text).unwrap()
}

pub(crate) fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}
