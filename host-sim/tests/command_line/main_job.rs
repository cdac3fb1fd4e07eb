//! `host-sim` without arguments: trains on four textures and tells them apart.

use crate::common::{Place, decisions, line};

const TEXTURES: [&str; 4] = ["smooth", "p600", "p240", "carpet"];

#[test]
fn textures_are_distinguished_as_surely_as_is_said() {
    let place = Place::new();
    let ran = place.done("");
    let files = std::fs::read_dir(place.path("out/bench-textures")).unwrap();
    let files = files.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut files: Vec<_> = files.collect();
    files.sort();
    let expected = [
        "bench-textures.model",
        "bench-textures.png",
        "bench-textures.svg",
        "decisions.csv",
        "trace.csv",
        "training.csv",
    ];
    assert_eq!(files, expected);

    let decided = decisions(&place.text("out/bench-textures/decisions.csv"));
    let named = decided.iter().filter(|d| d.decision != "unknown");
    let mut rates = Vec::new();
    for texture in TEXTURES {
        let own = || named.clone().filter(|d| d.label == texture);
        assert!(own().count() > 0, "no decision on {texture}");
        let hits = own().filter(|d| d.decision == texture).count();
        rates.push(hits as f64 / own().count() as f64);
    }
    let rate = 100.0 * rates.iter().sum::<f64>() / rates.len() as f64;
    println!("hit rates {rates:?}, mean {rate:.1} %");
    assert!(rate > 94.0, "{rate} %");
    let posteriors = named.clone().map(|d| d.posterior).sum::<f64>();
    let stated = posteriors / named.clone().count() as f64;
    let right = named.clone().filter(|d| d.is_right()).count() as f64;
    let found = right / named.clone().count() as f64;
    // One run: its standard error is about half a point.
    assert!((stated - found).abs() < 0.025, "{stated} {found}");

    let expected = format!("{} decisions, hit rate {rate:.1} %", named.count());
    line(&ran.stdout, &expected);
    for texture in TEXTURES {
        let row = |line: &&str| line.trim_start().starts_with(&format!("{texture} |"));
        let row = ran.stdout.lines().find(row).unwrap();
        // The texture, the line, a count for each and one of what was unknown.
        assert_eq!(row.split_whitespace().count(), 3 + TEXTURES.len(), "{row}");
    }
    // Decisions are printed as they fall.
    let falls = ran.stdout.matches(" samples  ").count();
    assert_eq!(falls, decided.len());

    // Its model is what `train` makes of its recording.
    let recorded = "out/bench-textures/training.csv";
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/bench-textures.toml");
    let train = format!("train --data {recorded} --scene {scene} --out again.model");
    place.done(&train);
    assert!(place.bytes("again.model") == place.bytes("out/bench-textures/bench-textures.model"));
}
