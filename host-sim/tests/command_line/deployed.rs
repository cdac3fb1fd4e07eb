//! Scenes whose model lies apart from the program.

use crate::common::{Place, SEQUENTIAL, TEXTURED, says};

fn place() -> Place {
    let awaiting = SEQUENTIAL.replace("model = \"the.model\"\n", "");
    let (module, _) = TEXTURED.split_once("[plant]").unwrap();
    let place = Place::classifying();
    place.write("deployed.toml", format!("{TEXTURED}{awaiting}"));
    place.write("bench.toml", format!("{module}{awaiting}"));
    place
}

#[test]
fn a_model_decides_alike_linked_and_deployed_and_in_the_world_of_another_scene() {
    let place = place();
    place.done("run s.toml --out linked --no-plot");
    place.done("run deployed.toml --model the.model --out deployed --no-plot");
    place.done("run bench.toml --world s.toml --model the.model --out bench --no-plot");
    let decided = place.text("linked/decisions.csv");
    assert!(decided.lines().count() > 3, "{decided}");
    for out in ["deployed", "bench"] {
        assert_eq!(place.text(&format!("{out}/decisions.csv")), decided);
        let trace = |out: &str| place.text(&format!("{out}/trace.csv"));
        assert_eq!(trace(out), trace("linked"));
    }
    // What the world brings is set there.
    let ran = place.done(
        "run bench.toml --world s.toml --model the.model --set duration_s=0.1 --set seed=7 \
         --set motor.arm=on-command --out short",
    );
    let said = "0.1 s simulated, 200 ticks, seed 7\n\
                in short: trace.csv, decisions.csv, trace.svg, trace.png\nits motors were not armed";
    assert!(ran.stdout.contains(said), "{ran:?}");
}

#[test]
fn without_a_model_it_says_so_and_whisks_on() {
    let place = place();
    let said = place.warned("run deployed.toml --out out --no-plot");
    let none =
        "deployed.toml:25: classifier: names no model, and none is given: nothing is decided";
    says(&said, &[none]);
    assert_eq!(place.table("out/trace.csv").len(), 1 + 1000);
    assert!(!place.path("out/decisions.csv").exists());
}

#[test]
fn a_model_where_there_is_no_use_for_it_is_refused() {
    let place = place();
    place.refuses_each(
        "run s.toml --model the.model | s.toml:27: classifier.model: found, so
         run ideal.toml --model the.model | ideal.toml: it has no [classifier]
         run deployed.toml --model none.model | none.model:
         run bench.toml --world none.toml | none.toml:",
    );
}
