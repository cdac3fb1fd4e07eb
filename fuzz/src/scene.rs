use config::{RunsOn, Target};
use firmware::{BoardCode, encode};
use host_sim::run::Run;
use scene::Scene;
use whisking::{Fix, Real};

/// Ticks of a scene that is taken.
const TICKS: u64 = 8;

fn read(data: &[u8]) -> Option<Scene> {
    let text = str::from_utf8(data).ok()?;
    match Scene::from_str("scene", text) {
        Ok(scene) => Some(scene),
        Err(problems) => {
            assert!(!problems.to_string().is_empty());
            None
        }
    }
}

/// The reader of scenes, and the configurations of those it takes.
///
/// # Panics
/// If problems are nameless, or if a module would refuse a configuration.
pub fn scene(data: &[u8]) {
    let Some(scene) = read(data) else { return };
    let _ = config::settings(&scene);
    let _ = config::check(&scene);
    let _ = config::cautions(&scene);
    let _ = config::in_simulation(&scene);
    for has_fpu in [false, true] {
        let _ = config::on_board(&scene, "board", has_fpu);
    }
    for runs_on in [RunsOn::Simulation { records: false }, RunsOn::Board] {
        build::<f32>(&scene, runs_on);
        build::<f64>(&scene, runs_on);
        build::<Fix>(&scene, runs_on);
    }
}

fn build<R: Real>(scene: &Scene, runs_on: RunsOn) {
    let target = Target::of(runs_on);
    if let Ok(config) = config::build::<R>(scene, target) {
        assert_eq!(config.check(), Ok(()));
        let _ = encode(&config, BoardCode::Simulation);
    }
}

/// The first ticks of the scenes that are taken, without their classifiers.
pub fn simulation(data: &[u8]) {
    let Some(scene) = read(data) else { return };
    let Ok(mut run) = Run::new(&scene, None) else {
        return;
    };
    for _ in 0..TICKS.min(run.ticks()) {
        let _ = run.tick();
    }
}
