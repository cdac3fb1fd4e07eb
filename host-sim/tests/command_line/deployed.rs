//! Scenes whose model lies apart from the program.

use crate::common::{Place, SEQUENTIAL, TEXTURED, model, says};

fn awaiting() -> String {
    SEQUENTIAL.replace("model = \"the.model\"\n", "")
}

fn place() -> Place {
    let linked = format!("{TEXTURED}{SEQUENTIAL}");
    let awaiting = awaiting();
    let (module, _) = TEXTURED.split_once("[plant]").unwrap();
    let place = Place::with(&[
        ("linked.toml", &linked),
        ("deployed.toml", &format!("{TEXTURED}{awaiting}")),
        ("bench.toml", &format!("{module}{awaiting}")),
        ("deaf.toml", TEXTURED),
    ]);
    place.write("the.model", model(2, 20, true));
    place
}

#[test]
fn a_model_decides_alike_linked_and_deployed_and_in_the_world_of_another_scene() {
    let place = place();
    place.done("run linked.toml --out linked --no-plot");
    place.done("run deployed.toml --model the.model --out deployed --no-plot");
    place.done("run bench.toml --world linked.toml --model the.model --out bench --no-plot");
    let decided = place.text("linked/decisions.csv");
    assert!(decided.lines().count() > 3, "{decided}");
    for out in ["deployed", "bench"] {
        assert_eq!(place.text(&format!("{out}/decisions.csv")), decided);
        let trace = |out: &str| place.text(&format!("{out}/trace.csv"));
        assert_eq!(trace(out), trace("linked"));
    }
}

#[test]
fn without_a_model_it_says_so_and_whisks_on() {
    let place = place();
    let ran = place.run("run deployed.toml --out out --no-plot");
    assert_eq!(ran.status, Some(0), "{}", ran.stderr);
    let none = "classifier: names no model, and none is given: nothing is decided";
    says(&ran.stderr, &[&format!("deployed.toml:25: {none}")]);
    assert!(place.path("out/trace.csv").exists());
    assert!(!place.path("out/decisions.csv").exists());
    // As without a classifier, but for the header that says what it is.
    place.done("run deaf.toml --out deaf --no-plot");
    let rows = |out: &str| {
        let text = place.text(&format!("{out}/trace.csv"));
        let rows = text.lines().filter(|line| !line.starts_with('#'));
        rows.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(rows("out").len(), rows("deaf").len());
}

#[test]
fn a_model_where_there_is_no_use_for_it_is_refused() {
    let place = place();
    for (scene, why) in [
        ("linked.toml", "linked.toml:27: classifier.model: found, so"),
        ("deaf.toml", "deaf.toml: it has no [classifier]"),
    ] {
        place.refuses_to_write(&format!("run {scene} --model the.model"), &[why]);
    }
    place.refuses_to_write("run deployed.toml --model none.model", &["none.model: "]);
    place.refuses_to_write("run bench.toml --world none.toml", &["none.toml: "]);
}
