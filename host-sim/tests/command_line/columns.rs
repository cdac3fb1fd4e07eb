//! What stands in the trace beside the first columns, and that each column is documented.

use std::collections::BTreeSet;

use crate::common::{Place, SEQUENTIAL, TEXTURED, column, line, model, numbers};

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

    let rows = place.table("differ.csv");
    // The scene's own: only readings differ.
    let stands: BTreeSet<_> = rows[1..].iter().map(|row| (row[7], row[8])).collect();
    assert!(stands.len() == 1 && rows[1][7] == "20", "{stands:?}");
    let of_row = rows[1..].iter().map(|row| (row[0], row[1], row[6]));
    let mut presented: Vec<_> = of_row.collect();
    presented.dedup();
    assert!(presented.len() > 1, "{presented:?}");
    let poses = presented.iter().map(|(.., pose)| (*pose).to_owned());
    let expected = (0..presented.len()).map(|n| n.to_string());
    assert!(poses.eq(expected), "{presented:?}");
    // More columns do no harm to those who read it.
    place.done("train --data differ.csv --tables single --out the.model");
}

#[test]
fn every_column_that_is_written_is_on_the_page() {
    let page = include_str!("../../../docs/files.md");
    let place = Place::new();
    let printed = place.done("columns").stdout;
    assert_eq!(printed, page, "run cargo xtask docs --quick");

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
        let rows = place.table(file);
        for title in &rows[0] {
            let places = ["left_2", "left_3", "right_2", "right_3"].into_iter();
            let further = places.fold(title.to_string(), |of, place| of.replacen(place, "*", 1));
            let is_on_page = |title: &str| page.contains(&format!("| `{title}` |"));
            let is_documented = is_on_page(title) || is_on_page(&further);
            assert!(is_documented || *title == "rcp.gain", "{file}: {title}");
        }
        let is_as_wide = |row: &Vec<&str>| row.len() == rows[0].len();
        assert!(rows.iter().all(is_as_wide), "{file}");
    }
}

#[test]
fn speed_and_duty_are_those_of_the_motion() {
    let place = Place::with(&[("s.toml", TEXTURED)]);
    place.done("run s.toml --out .");
    let rows = place.table("trace.csv");
    let angle = numbers(&rows, "angle_left_deg");
    let speed = numbers(&rows, "speed_left_deg_s");
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
    assert!(most > 100.0 && wrong < 0.05 * most, "{wrong} of {most}");
    // The truth: four presentations of 250 ticks.
    let (labels, trials) = (column(&rows, "label"), column(&rows, "trial"));
    for (n, (label, trial)) in labels.into_iter().zip(trials).enumerate() {
        let presented = n / 250;
        assert_eq!(label, ["smooth", "carpet"][presented % 2], "{n}");
        assert_eq!(trial, (presented / 2).to_string(), "{n}");
    }
    let mut faults = column(&rows, "fault_left").into_iter();
    assert!(faults.all(|fault| fault == "0"));
}

/// A driver that may not exceed a hundredth of its duty cannot follow: the motor is given up. Of
/// more whiskers, that one's: its number from 1 on its side, as in the column's name.
#[test]
fn a_fault_stands_in_the_trace_by_its_number() {
    let place = Place::with(&[("s.toml", TEXTURED)]);
    for (whiskers, place_of) in [(1, "left"), (2, "left_2")] {
        let keys = format!("--set head.whiskers_per_side={whiskers} --set motor.duty_limit=0.01");
        let said = place.warned(&format!("run s.toml {keys} --set duration_s=3 --out ."));
        let rows = place.table("trace.csv");
        let faults = column(&rows, &format!("fault_{place_of}"));
        let first = faults.iter().position(|fault| *fault != "0");
        let first = first.expect("a fault");
        let (t_s, fault) = (numbers(&rows, "t_s")[first], faults[first]);
        let expected = format!("{t_s:.4} s: left whisker {whiskers}: fault left {fault} ");
        line(&said, &expected);
        // Its motor is off meanwhile.
        let duty = column(&rows, &format!("duty_{place_of}"))[first + 1];
        assert_eq!(duty.parse::<f64>().unwrap(), 0.0);
    }
}
