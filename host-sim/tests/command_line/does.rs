//! What each command writes and prints when nothing is wrong.

use host_sim::commands::main_job;
use host_sim::files;
use host_sim::output::Output;
use host_sim::progress::Verbosity;
use scene::Scene;

use crate::common::{IDEAL, Place, RECORDING, SEQUENTIAL, TEXTURED, cells, decisions, says};

fn classifying() -> Place {
    let scene = Scene::from_str("training.toml", &TEXTURED.replace("= 0.5", "= 3.0")).unwrap();
    let streams = main_job::record(&scene, Verbosity::Quiet).unwrap();
    let text = format!("{TEXTURED}{SEQUENTIAL}").replace("= 0.5", "= 3.0");
    let place = Place::with(&[("scenes/textured.toml", &text)]);
    let recorded = Output::create(&place.path("recorded.csv")).unwrap();
    files::write_recording(recorded, &streams, 2000).unwrap();
    place.done("train --tables single --data recorded.csv --out scenes/the.model");
    place
}

#[test]
fn run_writes_a_row_a_tick() {
    let place = Place::with(&[("ideal.toml", IDEAL)]);
    let ran = place.done("run ideal.toml --out deep/er");
    let expected = "ideal: 0.1 s simulated, 200 ticks, seed 1\n\
                in deep/er: trace.csv, trace.svg, trace.png\n\
                to look at next: deep/er/trace.png; what each column is: host-sim columns\n";
    assert_eq!(ran.stdout, expected);
    let rows = place.table("deep/er/trace.csv");
    assert_eq!(
        rows[0][..9].join(","),
        "t_s,theta_left_deg,theta_right_deg,z_left,z_right,g_left,g_right,\
         contact_left,contact_right"
    );
    assert_eq!(rows.len(), 1 + 200);
    for (n, row) in (1..).zip(&rows[1..]) {
        assert_eq!(row.len(), rows[0].len());
        // Nothing is decided, and an ideal motor has no duty.
        let is_empty = |title: &str| title == "decision" || title.starts_with("duty_");
        for (title, cell) in rows[0].iter().zip(row) {
            match *title {
                "label" => assert_eq!(*cell, "obstacle"),
                title if is_empty(title) => assert_eq!(*cell, "", "{title}"),
                title => assert!(cell.parse::<f64>().unwrap().is_finite(), "{title}"),
            }
        }
        assert_eq!(row[0].parse::<f64>().unwrap(), f64::from(n) / 2000.0);
    }
    assert_eq!(std::fs::read_dir(place.path("deep/er")).unwrap().count(), 3);
}

#[test]
fn run_writes_decisions_where_the_scene_classifies() {
    let place = classifying();
    let ran = place.done("run scenes/textured.toml --out out");
    let decided = decisions(&place.text("out/decisions.csv"));
    assert!(decided.len() >= 20, "{}", decided.len());
    for d in &decided {
        assert!(["smooth", "carpet"].contains(&d.label.as_str()));
        assert!(["smooth", "carpet"].contains(&d.decision.as_str()));
        assert!(d.samples > 0 && d.samples % 20 == 0);
        assert!(d.posterior > 0.9 && d.posterior <= 1.0);
    }
    let expected = format!("\n{} decisions, hit rate ", decided.len());
    says(&ran.stdout, &[&expected]);
    let trace = place.table("out/trace.csv");
    assert_eq!(trace.len(), 1 + 6000);
    // The trace has each decision in its tick.
    let fallen = trace[1..].iter().filter(|row| !row[16].is_empty());
    let fallen: Vec<_> = fallen.map(|row| (row[0].parse().ok(), row[16])).collect();
    let decided = decided.iter().map(|d| (d.t_s, d.decision.as_str()));
    assert_eq!(trace[0][16], "decision");
    assert_eq!(fallen, decided.collect::<Vec<_>>());

    // The model is looked for beside the scene first, then from where one stands.
    let beside = place.bytes("out/decisions.csv");
    std::fs::rename(place.path("scenes/the.model"), place.path("the.model")).unwrap();
    place.done("run scenes/textured.toml --out out");
    assert_eq!(place.bytes("out/decisions.csv"), beside);

    // By fixed windows every window decides.
    let window = TEXTURED.to_owned()
        + "[classifier]\nrule = \"window\"\nmodel = \"the.model\"\nwindow = 120\n";
    place.write("window.toml", window);
    place.done("run window.toml --out windows");
    let decided = decisions(&place.text("windows/decisions.csv"));
    // Two windows fit in each of four presentations of 250 samples.
    assert_eq!(decided.len(), 8);
    assert!(decided.iter().all(|d| d.samples == 120));
}

#[test]
fn train_and_classify_say_and_write_what_they_did() {
    let place = Place::with(&[("r.csv", RECORDING), ("d.csv", "older")]);
    let ran = place.done("train --tables single --data r.csv --out m --block 2");
    let size = place.bytes("m").len();
    let expected = format!("m: 8 samples in 4 streams, {size} bytes\n");
    assert_eq!(ran.stdout, expected);
    let classify = "classify --model m --data r.csv --rule window --window 2 --out d.csv";
    let ran = place.done(classify);
    let expected = "4 decisions, hit rate 100.0 % (mean over classes), mean 2 samples\n";
    assert!(ran.stdout.ends_with(expected), "{}", ran.stdout);
    let quiet = place.done(&format!("--quiet {classify}"));
    assert_eq!(quiet.stdout, ran.stdout, "but for the progress");
    let decided = decisions(&place.text("d.csv"));
    let rows = decided
        .iter()
        .map(|d| format!("{},{},{}", d.label, d.trial, d.decision));
    let expected = ["low,0,low", "low,1,low", "high,0,high", "high,1,high"];
    assert_eq!(rows.collect::<Vec<_>>(), expected);
    let left: Vec<_> = place.content().into_keys().collect();
    assert_eq!(left.len(), 3, "{left:?}");
}

#[test]
fn recordings_may_come_in_any_dress() {
    let train = |bytes: &[u8]| {
        let place = Place::new();
        place.write("r.csv", bytes);
        place.done("train --tables single --data r.csv --out m");
        place.bytes("m")
    };
    let plain = train(RECORDING.as_bytes());
    let with = |from: &str, to: &str| RECORDING.replace(from, to).into_bytes();
    let mut reordered = Vec::new();
    for row in cells(RECORDING) {
        reordered.push(["note", row[3], row[1], row[2], row[0]].join(","));
    }
    let dresses: [(&str, Vec<u8>); 7] = [
        ("byte order mark", format!("\u{feff}{RECORDING}").into()),
        ("line ends", with("\n", "\r\n")),
        ("quotes", with("low", "\"low\"")),
        ("quoted numbers", with("9000", "\"9000\"")),
        ("spaces", with(",", " , ")),
        ("exponents", with("9000", "9.0e3")),
        ("other order, more columns", reordered.join("\n").into()),
    ];
    for (dress, bytes) in dresses {
        assert!(train(&bytes) == plain, "{dress}");
    }
    let unfinished = RECORDING.trim_end().as_bytes();
    assert!(train(unfinished) == plain, "no newline at the end");
}

#[test]
fn a_reader_that_goes_away_does_not_stop_the_work() {
    let gone = || std::io::pipe().unwrap().1;
    let place = Place::with(&[("r.csv", RECORDING)]);
    let run = |line: &str| {
        let mut command = place.command(line);
        let child = command.stdout(gone()).stderr(gone()).spawn();
        child.unwrap().wait().unwrap().code()
    };
    assert_eq!(run("train --tables single --data r.csv --out m"), Some(0));
    assert!(place.path("m").exists());
    assert_eq!(run("train --data none --out m"), Some(2));
}
