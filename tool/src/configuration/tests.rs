use std::path::PathBuf;

use config::{RunsOn, Target};
use firmware::BoardCode;
use firmware::boards::ALL;
use host_sim::bench::config_of;
use host_sim::classifier::Classifier;
use host_sim::loaded::Loaded;
use whisking::FormatCode;

use super::Running;
use crate::deployment::model_of;
use crate::source::scene_file;

fn scenes() -> Vec<(PathBuf, Loaded)> {
    let files = std::fs::read_dir(scene_file("")).unwrap();
    let files = files.map(|file| file.unwrap().path());
    let files = files.filter(|file| file.extension().is_some_and(|ext| ext == "toml"));
    let scenes = files.filter_map(|file| Some((file.clone(), Loaded::new(&file).ok()?)));
    scenes.collect()
}

#[test]
fn a_configuration_is_made_again_from_its_scene() {
    let mut count = 0;
    for (file, loaded) in scenes() {
        let scene = &loaded.scene;
        let model = model_of(&file, scene).unwrap();
        for board in &ALL {
            let Ok(image) = config::image(scene, model.as_ref(), board, "motor.kp=0.05") else {
                continue;
            };
            let running = Running::of(image.bytes.to_vec()).unwrap();
            let again = running.remade(scene, "motor.kp=0.05", &running.classes);
            assert_eq!(
                again.unwrap(),
                running,
                "{} on {}",
                file.display(),
                board.name
            );
            assert_eq!(running.program().board, board.code);
            count += 1;
        }
        let classifier = loaded.classifier().unwrap();
        let gate = classifier.as_ref().and_then(Classifier::touch_rule);
        let gate = gate.map(|touch| touch.gate);
        let classes = classifier.as_ref().map(Classifier::settings);
        let records = model.is_none();
        let target = Target {
            runs_on: RunsOn::Simulation { records },
            gate,
            classes,
            overrides: "",
        };
        let running = Running::of_scene(scene, BoardCode::Simulation, target).unwrap();
        let again = running.remade(scene, "", &running.classes).unwrap();
        assert_eq!(again, running, "{}", file.display());
        if running.program().format == FormatCode::Single {
            // As host-sim has it.
            let made = config_of::<f32>(scene, (gate, classes), records, "").unwrap();
            let made = firmware::encode(&made, BoardCode::Simulation).unwrap();
            assert_eq!(running.bytes(), &*made, "{}", file.display());
        }
    }
    assert!(count > 20, "{count}");
}
