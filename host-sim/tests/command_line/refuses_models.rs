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
fn a_valid_model_is_taken() {
    let place = place();
    place.write("the.model", model(2, 20, true));
    place.done("run s.toml --out out");
    place.done(&format!("{CLASSIFY} --out d.csv"));
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
fn models_that_have_suffered() {
    let valid = model(2, 20, true);
    for kept in [3, 15, 16, 60, valid.len() / 2, valid.len() - 1] {
        refused_by_both(&valid[..kept], "cut short");
    }
    refused_by_both(&[&valid[..], b"\0"].concat(), "bytes follow");
    // In the header, a channel, a name, the table and the checksum.
    for (at, naming) in [
        (0, "WLIK"),
        (4, "version"),
        (20, "gate"),
        (58, "CRC-32"),
        (valid.len() / 2, "CRC-32"),
        (valid.len() - 1, "CRC-32"),
    ] {
        let mut damaged = valid.clone();
        damaged[at] ^= 0x10;
        refused_by_both(&damaged, naming);
    }
}

#[test]
fn models_for_something_else() {
    for channels in [1, 3] {
        let naming = format!("{channels} channels");
        refused_by_both(&model(channels, 20, true), &naming);
    }
    // Of other textures: every decision would be wrong.
    let place = place();
    let other = TEXTURED.replace("[\"smooth\", \"carpet\"]", "[\"p600\", \"p240\"]");
    place.write("s.toml", format!("{other}{SEQUENTIAL}"));
    place.write("the.model", model(2, 20, true));
    let naming = [
        "s.toml:27: classifier.model: found the classes smooth, carpet",
        "p600, p240",
    ];
    place.refuses_to_write("run s.toml", &naming);
    // Trained on real numbers: good for recordings of such, not for a sensor.
    let place = self::place();
    place.write("the.model", model(2, 20, false));
    place.refuses_to_write("run s.toml", &["the.model: ", "codes"]);
    place.done(&format!("{CLASSIFY} --out d.csv"));
}

#[test]
fn a_class_whose_name_could_forge_a_line() {
    let place = Place::new();
    let mut forged = model(2, 20, true);
    let at = forged.windows(6).position(|name| name == b"smooth");
    forged[at.unwrap() + 2] = b'\n';
    let end = forged.len() - 4;
    let sum = tactile::checksum(&forged[..end]).to_le_bytes();
    forged[end..].copy_from_slice(&sum);
    place.write("m", forged);
    place.write("r.csv", RECORDING);
    place.refuses_to_write(
        "classify --model m --data r.csv --rule window --window 20",
        &["m: the name of class 0 has the character '\\n', which is not to be seen"],
    );
}
