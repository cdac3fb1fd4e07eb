//! What stands in the trace beside the first columns, and that each column is documented.

use crate::common::{Place, SEQUENTIAL, TEXTURED, cells, model};

fn column<'t>(rows: &[Vec<&'t str>], name: &str) -> Vec<&'t str> {
    let at = rows[0].iter().position(|title| *title == name);
    let at = at.unwrap_or_else(|| panic!("no {name}"));
    rows[1..].iter().map(|row| row[at]).collect()
}

fn numbers(rows: &[Vec<&str>], name: &str) -> Vec<f64> {
    let cells = column(rows, name).into_iter();
    cells.map(|cell| cell.parse().unwrap()).collect()
}

fn elastic() -> String {
    TEXTURED.replace(
        "kind = \"textured\"",
        "kind = \"whisker\"\nshaft = \"biotact-middle\"",
    )
}

#[test]
fn a_recording_has_the_number_of_the_pose_where_poses_differ() {
    let alike = elastic().replace("exchange = \"timed\"\n", "");
    let place = Place::with(&[
        ("alike.toml", &alike),
        ("differ.toml", &(alike.clone() + "gain_spread = 0.05\n")),
    ]);
    for of in ["alike", "differ"] {
        place.done(&format!("record {of}.toml --out {of}.csv"));
    }
    let header = |file: &str| place.text(file).lines().next().unwrap().to_owned();
    assert_eq!(header("alike.csv"), "label,trial,x,y,contact,touch");
    let differ = "label,trial,x,y,contact,touch,pose,tilt_deg,depth_deg";
    assert_eq!(header("differ.csv"), differ);

    let text = place.text("differ.csv");
    let rows = cells(&text);
    // The scene's own: only readings differ.
    assert!(
        rows[1..]
            .iter()
            .all(|row| row[7] == "20" && row[8] == rows[1][8])
    );
    let of_row: Vec<[&str; 3]> = rows[1..]
        .iter()
        .map(|row| [row[0], row[1], row[6]])
        .collect();
    let mut presented = of_row.clone();
    presented.dedup();
    let poses: Vec<&str> = presented.iter().map(|[.., pose]| *pose).collect();
    assert!(poses.len() > 1, "{presented:?}");
    let expected: Vec<String> = (0..poses.len()).map(|n| n.to_string()).collect();
    assert_eq!(poses, expected, "each presentation has one of its own");
    // More columns do no harm to those who read it.
    place.done("train --data differ.csv --tables single --out the.model");
}

#[test]
fn every_column_that_is_written_is_on_the_page() {
    let page = include_str!("../../../docs/files.md");
    let place = Place::new();
    assert_eq!(
        place.done("columns").stdout,
        page,
        "run cargo xtask docs --quick"
    );

    let spread = "gain_spread = 0.05\n";
    let scene = elastic().replace("exchange = \"timed\"\n", spread) + SEQUENTIAL;
    let both = scene
        .replace("sides = \"left\"", "sides = \"both\"")
        .replace("whiskers_per_side = 1", "whiskers_per_side = 3")
        .replace("start = [[1.0, 0.0]]", "start = [[1.0, 0.0], [1.0, 0.0]]")
        .replace("[80.0]", "[80.0, 80.0]")
        + "whiskers = \"each\"\n";
    place.write("both.toml", both);
    place.write("the.model", model(2, 20, true));
    place.done("run both.toml --out out");
    place.done("record both.toml --out recorded.csv");
    place.run("sweep both.toml --key rcp.gain=0.5 --out sweep.csv");
    place.done("press --shaft xy-table --push-deg 5 --out press.csv --shape shape.csv");
    for file in [
        "out/trace.csv",
        "out/decisions.csv",
        "recorded.csv",
        "sweep.csv",
        "press.csv",
        "shape.csv",
    ] {
        let text = place.text(file);
        for title in text.lines().next().unwrap().split(',') {
            let further = title.replacen("left_2", "*", 1).replacen("left_3", "*", 1);
            let further = further
                .replacen("right_2", "*", 1)
                .replacen("right_3", "*", 1);
            let is_documented = page.contains(&format!("| `{title}` |"))
                || page.contains(&format!("| `{further}` |"));
            assert!(is_documented || title == "rcp.gain", "{file}: {title}");
        }
        let widths = cells(&text).into_iter().map(|row| row.len());
        let widths: std::collections::BTreeSet<_> = widths.collect();
        assert_eq!(widths.len(), 1, "{file}: {widths:?}");
    }
}

#[test]
fn speed_and_duty_are_those_of_the_motion() {
    let place = Place::with(&[("s.toml", TEXTURED)]);
    place.done("run s.toml --out .");
    let text = place.text("trace.csv");
    let rows = cells(&text);
    let (angle, speed) = (
        numbers(&rows, "angle_left_deg"),
        numbers(&rows, "speed_left_deg_s"),
    );
    let duty = numbers(&rows, "duty_left");
    assert!(duty.iter().all(|duty| duty.abs() <= 1.0));
    assert!(duty.iter().any(|duty| *duty > 0.05) && duty.iter().any(|duty| *duty < -0.05));
    // The mean of two speeds is the way between them over a tick, but for the jerk.
    let steps = angle.windows(2).zip(speed.windows(2));
    let wrong = steps.map(|(angle, speed)| {
        let way = (angle[1] - angle[0]) * 2000.0;
        (way - f64::midpoint(speed[0], speed[1])).abs()
    });
    let most = speed.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let wrong = wrong.fold(0.0, f64::max);
    assert!(
        most > 100.0 && wrong < 0.05 * most,
        "{wrong} of {most} degrees/s"
    );
    // The truth: four presentations of 250 ticks.
    let (labels, trials) = (column(&rows, "label"), column(&rows, "trial"));
    for (n, (label, trial)) in labels.into_iter().zip(trials).enumerate() {
        let presented = n / 250;
        assert_eq!(label, ["smooth", "carpet"][presented % 2], "{n}");
        assert_eq!(trial, (presented / 2).to_string(), "{n}");
    }
    assert!(
        column(&rows, "fault_left")
            .iter()
            .all(|fault| *fault == "0")
    );
}

/// A driver that may not exceed a hundredth of its duty cannot follow: the motor is given up.
#[test]
fn a_fault_stands_in_the_trace_by_its_number() {
    let place = Place::with(&[("s.toml", TEXTURED)]);
    let ran = place.run("run s.toml --set motor.duty_limit=0.01 --set duration_s=3 --out .");
    assert_eq!(ran.status, Some(0), "{ran:?}");
    let text = place.text("trace.csv");
    let rows = cells(&text);
    let faults = column(&rows, "fault_left");
    let first = faults
        .iter()
        .position(|fault| *fault != "0")
        .expect("a fault");
    let t_s: f64 = column(&rows, "t_s")[first].parse().unwrap();
    let expected = format!("{t_s:.4} s: left whisker 1: fault left {} ", faults[first]);
    assert!(
        ran.stderr.starts_with(&expected),
        "{expected}: {}",
        ran.stderr
    );
    // Its motor is off meanwhile.
    assert_eq!(
        column(&rows, "duty_left")[first + 1]
            .parse::<f64>()
            .unwrap(),
        0.0
    );
    // Of more whiskers, that one's: its number from 1 on its side, as in the column's name.
    let several = "--set head.whiskers_per_side=2 --set motor.duty_limit=0.01";
    let ran = place.run(&format!("run s.toml {several} --set duration_s=3 --out ."));
    let text = place.text("trace.csv");
    let rows = cells(&text);
    let faults = column(&rows, "fault_left_2");
    let first = faults.iter().position(|fault| *fault != "0");
    let first = first.expect("a fault of the second");
    let t_s: f64 = column(&rows, "t_s")[first].parse().unwrap();
    let expected = format!("{t_s:.4} s: left whisker 2: fault left {} ", faults[first]);
    assert!(ran.stderr.contains(&expected), "{expected}: {}", ran.stderr);
}
