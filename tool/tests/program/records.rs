//! `whisker records`.

use host_sim::run::Run;
use scene::Scene;

use crate::common::{BENCH, Place};

fn cells(text: &str) -> Vec<Vec<&str>> {
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    rows.map(|row| row.split(',').collect()).collect()
}

#[test]
fn every_tick_has_the_row_of_its_trace() {
    let place = Place::new();
    let ran = place.done("records --sim bench.toml --out r.csv");
    ran.prints("r.csv: 6000 records at 2000 ticks a second, 0 lost");
    place.holds("r.csv", "# scene = bench\n# tick_hz = 2000\n");
    let text = place.text("r.csv");
    let rows = cells(&text);
    let at = |name: &str| rows[0].iter().position(|column| *column == name).unwrap();
    let [time, x, y, setpoint] = ["t_s", "x", "y", "setpoint_deg"].map(at);
    let [measured, z, contact, touching] = ["measured_deg", "z", "contact", "touching"].map(at);
    let columns = [time, x, y, setpoint, measured, z, contact, touching];
    let scene = Scene::from_str("bench.toml", BENCH).unwrap();
    let mut run = Run::new(&scene, None).unwrap();
    assert_eq!(rows.len(), 1 + 6000);
    let mut angle_before = 50.0;
    for (n, row) in (1..).zip(&rows[1..]) {
        let trace = run.tick();
        assert_eq!(row[0], n.to_string());
        assert_eq!(row[2], "left");
        let found = columns.map(|at| row[at].parse::<f64>().unwrap());
        // The encoder is read in the tick, the trace has the angle after it.
        let expected = [
            trace.t_s,
            trace.x[0],
            trace.y[0],
            trace.theta_deg[0],
            angle_before,
            trace.z[0],
            trace.contact[0],
            f64::from(u8::from(trace.touch[0] != 0)),
        ];
        // Q13 of 100 degrees, and steps of the encoder.
        let tolerances = [1e-9, 0.0, 0.0, 0.0123, 0.25, 1.3e-4, 1.3e-4, 0.0];
        for n in 0..expected.len() {
            let off = (found[n] - expected[n]).abs();
            assert!(off <= tolerances[n], "{row:?}: {n}: {expected:?}");
        }
        angle_before = trace.angle_deg[0];
    }
}

#[test]
fn what_is_missing_is_counted() {
    let place = Place::new();
    place.done("records --sim bench.toml --seconds 0.1 --out r.csv");
    let text = place.text("r.csv");
    // The fourth and the fifth tick, and the last but one.
    let is_gone = |line: &str| {
        ["4,", "5,", "199,"]
            .iter()
            .any(|gone| line.starts_with(gone))
    };
    let kept = text.lines().filter(|line| !is_gone(line));
    place.write("less.csv", &kept.collect::<Vec<_>>().join("\n"));
    let whole = place.done("records --file r.csv");
    whole.prints("200 records at 2000 ticks a second, 0 lost");
    let less = place.done("records --file less.csv");
    less.prints("197 records at 2000 ticks a second, 3 lost");
}

#[test]
fn a_table_goes_to_standard_output_alone() {
    let place = Place::new();
    let ran = place.done("records --sim bench.toml --seconds 0.01 --out -");
    assert_eq!(cells(&ran.stdout).len(), 1 + 20);
    ran.warns("20 records");
}

#[test]
fn what_is_wrong_is_said() {
    let place = Place::new();
    place.write("bad.csv", "sequence,t_s\n1,2\n");
    let column = "bad.csv: line 1: no column \"side\"";
    place.refuses("records --file bad.csv", column);
    place.refuses("records --sim bench.toml", "--out");
    place.refuses("records --sim bench.toml --out /", "/: not a file name");
    place.done("records --sim bench.toml --seconds 0.01 --out r.mcap");
    place.refuses("records --sim bench.toml --out r.mcap", "is there already");
    place.refuses("records --file r.mcap", "r.mcap: messages (.mcap) are not");
    // Nothing is accepted that would have no effect.
    for line in [
        "log --sim bench.toml --baud 9600",
        "records --file bad.csv --world bench.toml",
        "monitor --sim bench.toml --frames 1 --save m.csv",
    ] {
        place.refuses(line, "cannot be used with");
    }
}
