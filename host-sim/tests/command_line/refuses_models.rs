//! Models that are wrong, in a scene and on the command line: status 2, the
//! file and why, and nothing written.

use crate::common::{Place, RECORDING, SEQUENTIAL, TEXTURED, model};

const CLASSIFY: &str = "classify --model the.model --data r.csv --rule sequential --threshold 0.9";

fn place() -> Place {
    let scene = format!("{TEXTURED}{SEQUENTIAL}");
    Place::with(&[("s.toml", &scene), ("r.csv", RECORDING)])
}

#[track_caller]
fn refused_by_both(bytes: &[u8], naming: &str) {
    let place = place();
    place.write("the.model", bytes);
    place.refuses_to_write("run s.toml", &["the.model: ", naming]);
    place.refuses_to_write(CLASSIFY, &["the.model: ", naming]);
}

#[test]
fn files_that_are_no_model() {
    let place = place();
    let naming = ["s.toml:27: classifier.model: the.model: "];
    place.refuses_to_write("run s.toml", &naming);
    let other = ["--set classifier.model=other: classifier.model: other: "];
    place.refuses_to_write("run s.toml --set classifier.model=other", &other);
    place.refuses_to_write(CLASSIFY, &["the.model: "]);
    refused_by_both(b"", "cut short");
    refused_by_both(RECORDING.as_bytes(), "not a likelihood model");
    std::fs::create_dir(place.path("the.model")).unwrap();
    place.refuses_to_write("run s.toml", &["the.model: "]);
    place.refuses_to_write(CLASSIFY, &["the.model: "]);
}

#[test]
fn models_for_something_else() {
    for channels in [1, 3] {
        let naming = format!("{channels} channels");
        refused_by_both(&model(channels, 20, true), &naming);
    }
    // Of other textures: every decision would be wrong.
    let place = Place::classifying();
    let other = TEXTURED.replace("[\"smooth\", \"carpet\"]", "[\"p600\", \"p240\"]");
    place.write("s.toml", format!("{other}{SEQUENTIAL}"));
    let found = "s.toml:27: classifier.model: found the classes smooth, carpet";
    place.refuses_to_write("run s.toml", &[found, "p600, p240"]);
    // Trained on real numbers: good for recordings of such, not for a sensor.
    let place = self::place();
    place.write("the.model", model(2, 20, false));
    place.refuses_to_write("run s.toml", &["the.model: ", "codes"]);
    place.done(&format!("{CLASSIFY} --out d.csv"));
}
