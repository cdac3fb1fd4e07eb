//! Keys and seeds in place of the scene file's: `--set`, `--seed`, and `sweep` over them.

use crate::common::{IDEAL, Place, cells, decisions, numbers, says};

#[test]
fn a_run_is_as_if_the_file_said_so() {
    let place = Place::classifying();
    let scene = place.text("s.toml");
    let changed = scene
        .replace("seed = 1", "seed = 7")
        .replace("[80.0]", "[75.0]")
        .replace("threshold = 0.9", "threshold = 0.8");
    place.write("changed.toml", changed);
    place.done("run changed.toml --out expected");
    let set = "--set plant.obstacle_deg=[75.0] --set classifier.threshold=0.8";
    place.done(&format!("run s.toml {set} --seed 7 --out found"));
    place.done(&format!("run s.toml {set} --set seed=7 --out again"));
    place.done("run s.toml --out plain");
    for file in ["trace.csv", "decisions.csv"] {
        let bytes = |folder: &str| place.bytes(&format!("{folder}/{file}"));
        assert!(bytes("found") == bytes("expected"), "{file}");
        assert!(bytes("again") == bytes("expected"), "{file}");
        assert!(bytes("plain") != bytes("expected"), "{file}");
    }
    place.done("record changed.toml --out expected.csv");
    place.done(&format!("record s.toml {set} --seed 7 --out found.csv"));
    assert_eq!(place.text("found.csv"), place.text("expected.csv"));
}

#[test]
fn a_run_says_what_costs_come_to() {
    let place = Place::classifying();
    let keys = "cost_error = 20\ncost_delay_per_s = 1";
    let scene = place.text("s.toml").replace("threshold = 0.9", keys);
    place.write("costs.toml", scene);
    let said = place.done("run costs.toml --out o --no-plot").stdout;
    says(
        &said,
        &["thresholds by costs: smooth 0.99", ", carpet 0.99"],
    );
}

#[test]
fn a_sweep_has_a_row_a_run_and_each_is_that_of_run() {
    let place = Place::classifying();
    let axes = "--key plant.obstacle_deg=[75.0],[80.0] --key classifier.threshold=0.8,0.9";
    let ran = place.run(&format!("sweep s.toml {axes} --seeds 3..5 --out sweep.csv"));
    assert_eq!(ran.status, Some(0), "{ran:?}");
    says(&ran.stderr, &["4 settings, 8 runs, 4 s of simulated time"]);
    says(&ran.stdout, &["sweep.csv: 8 runs of 4 settings"]);
    let rows = place.table("sweep.csv");
    assert_eq!(
        rows[0].join(","),
        "plant.obstacle_deg,classifier.threshold,seed,right,wrong,refused,error_rate,\
         decision_time_s,touches,faults,tracking_rms_deg"
    );
    assert_eq!(rows.len(), 1 + 8);
    let mut n = 0;
    for obstacle in ["[75.0]", "[80.0]"] {
        for threshold in ["0.8", "0.9"] {
            for seed in ["3", "4"] {
                n += 1;
                let row = &rows[n];
                assert_eq!(row[..3], [obstacle, threshold, seed]);
                let set = format!(
                    "--set plant.obstacle_deg={obstacle} --set classifier.threshold={threshold}"
                );
                place.done(&format!("run s.toml {set} --seed {seed} --out one"));
                let decided = decisions(&place.text("one/decisions.csv"));
                let right = decided.iter().filter(|d| d.is_right()).count();
                assert_eq!(row[3], right.to_string());
                assert_eq!(row[4], (decided.len() - right).to_string());
                let samples: u32 = decided.iter().map(|d| d.samples).sum();
                let mean = f64::from(samples) / decided.len() as f64 / 2000.0;
                let found: f64 = row[7].parse().unwrap();
                assert!((found - mean).abs() < 1e-6, "{found} {mean}");
                assert_eq!(row[9], "0");
                let tracking = tracking_rms_deg(&place.table("one/trace.csv"));
                let found: f64 = row[10].parse().unwrap();
                assert!((found - tracking).abs() < 2e-6, "{found} {tracking}");
            }
        }
    }
    assert!(rows[1..].iter().any(|row| row[3] != rows[1][3]), "{rows:?}");

    let piped = place.run(&format!("sweep s.toml {axes} --seeds 3..5 --quiet --out -"));
    assert_eq!(cells(&piped.stdout), rows);
    place.run("sweep s.toml --out own.csv");
    let own = place.table("own.csv");
    assert_eq!(own[1][0], "1", "the scene's own seed");
}

/// Of the left side, from the columns of a trace.
fn tracking_rms_deg(rows: &[Vec<&str>]) -> f64 {
    let [theta, angle] = ["theta_left_deg", "angle_left_deg"].map(|name| numbers(rows, name));
    let errors = theta.iter().zip(&angle).map(|(theta, angle)| angle - theta);
    let squares: f64 = errors.map(|error| error * error).sum();
    (squares / theta.len() as f64).sqrt()
}

#[test]
fn sweeps_that_cannot_be() {
    let place = Place::with(&[("s.toml", IDEAL)]);
    place.refuses_each(
        "sweep s.toml --key rcp.gian=1,2 | --key rcp.gian=1: rcp.gian | `gain`
         sweep s.toml --key rcp.gain=0.5,-1 | --key rcp.gain=-1: rcp.gain: found -1
         sweep s.toml --key rcp.gain=1,,2 | KEY=VALUE
         sweep s.toml --key rcp.gain=1 --key rcp.gain=2 | rcp.gain is given twice
         sweep s.toml --key rcp.gain=0.5,0.50 | 0.50 is there twice
         sweep s.toml --key seed=1,2 | seed has a column of its own
         sweep s.toml --key rcp.gain=0.5,0.6 --seeds 0..600000 | more than 1000000
         sweep s.toml --seeds 5 | --seeds | A..B
         sweep none.toml --key rcp.gain=1 | none.toml: cannot be read",
    );
}
