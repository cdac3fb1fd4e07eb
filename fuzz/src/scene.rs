use host_sim::run::Run;
use scene::Scene;
use whisking::Fix;

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

/// The reader of scenes, and the plan of those it takes.
///
/// # Panics
/// If problems are nameless.
pub fn scene(data: &[u8]) {
    let Some(scene) = read(data) else { return };
    let _ = plan::settings(&scene);
    let _ = plan::check(&scene);
    let _ = plan::cautions(&scene);
    let _ = plan::in_simulation(&scene);
    for has_fpu in [false, true] {
        let _ = plan::on_board(&scene, "board", has_fpu);
    }
    let _ = plan::motion::<f32, 1, 1>(&scene);
    let _ = plan::motion::<Fix, 2, 1>(&scene);
    let _ = plan::contact::<f32>(&scene, true);
    let _ = plan::contact::<Fix>(&scene, true);
}

/// The first ticks of the scenes that are taken, without their classifiers.
///
/// # Panics
/// If a value of the trace is no number.
pub fn simulation(data: &[u8]) {
    let Some(scene) = read(data) else { return };
    let Ok(mut run) = Run::new(&scene, None) else {
        return;
    };
    for _ in 0..TICKS.min(run.ticks()) {
        let _ = run.tick();
    }
}
