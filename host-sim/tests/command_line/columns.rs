//! What stands in the trace beside the first columns, and that each column is documented.

use crate::common::{IDEAL, Place, SEQUENTIAL, TEXTURED, cells, model};

/// The cells of a column, as they are written.
fn column<'t>(rows: &[Vec<&'t str>], name: &str) -> Vec<&'t str> {
    let at = rows[0].iter().position(|title| *title == name);
    let at = at.unwrap_or_else(|| panic!("no {name}"));
    rows[1..].iter().map(|row| row[at]).collect()
}

fn numbers(rows: &[Vec<&str>], name: &str) -> Vec<f64> {
    let cells = column(rows, name).into_iter();
    cells.map(|cell| cell.parse().unwrap()).collect()
}

/// [`TEXTURED`] with a whisker that bends.
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
    assert_eq!(header("differ.csv"), "label,trial,x,y,contact,touch,pose");

    let text = place.text("differ.csv");
    let rows = cells(&text);
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

/// The page, as it is committed and as the program prints it.
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
fn every_whisker_has_its_own_motion_and_contact() {
    let scene = IDEAL.replace("gain = 1.0", "gain = [1.0, 0.5, 1.0, 0.25]");
    let place = Place::with(&[("s.toml", &scene)]);
    place.done("run s.toml --out .");
    let text = place.text("trace.csv");
    let rows = cells(&text);
    for side in ["left", "right"] {
        let first = numbers(&rows, &format!("theta_{side}_deg"));
        let second = numbers(&rows, &format!("theta_{side}_2_deg"));
        let share = if side == "left" { 0.5 } else { 0.25 };
        // The muscle's drive is proportional to the gain: less of it moves less.
        let travel = |theta: &[f64]| theta.iter().fold(0.0_f64, |most, x| most.max(x - 50.0));
        assert!(travel(&second) < travel(&first) * (share + 0.2), "{side}");
        assert!(travel(&second) > 1.0, "{side}");
        assert_eq!(numbers(&rows, &format!("angle_{side}_2_deg")), second);
        // A side feels what the most bent of its whiskers feels.
        let side_contact = numbers(&rows, &format!("contact_{side}"));
        let second_contact = numbers(&rows, &format!("contact_{side}_2"));
        let pairs = side_contact.iter().zip(&second_contact);
        assert!(pairs.clone().all(|(side, second)| *second <= side + 1e-6));
        assert!(
            pairs.clone().any(|(side, second)| *second < side - 0.1),
            "{side}"
        );
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

#[test]
fn an_elastic_whisker_touches_at_its_tip_first_and_then_below_it() {
    let place = Place::with(&[("s.toml", &elastic())]);
    place.done("run s.toml --out .");
    let text = place.text("trace.csv");
    let rows = cells(&text);
    let (at, on) = (
        column(&rows, "touch_at_left_m"),
        column(&rows, "place_left_m"),
    );
    assert!(rows[0].ends_with(&["touch_at_left_m", "place_left_m"]));
    let touches = at.iter().zip(&on).filter(|(at, _)| !at.is_empty());
    let touches: Vec<[f64; 2]> = touches
        .map(|(at, on)| [at, on].map(|cell| cell.parse().unwrap()))
        .collect();
    assert!(
        touches.len() > 50 && touches.len() < 950,
        "{}",
        touches.len()
    );
    // At the tip of its 112 mm, near where a straight tip touches.
    let [first_at, first_on] = touches[0];
    assert!(
        first_at > 0.111 && first_on.abs() < 0.001,
        "{first_at} {first_on}"
    );
    assert!(touches.iter().all(|[at, _]| *at > 0.056 && *at <= 0.112));
    assert!(touches.iter().any(|[at, _]| *at < 0.1115));
    let in_the_air = at.iter().zip(numbers(&rows, "angle_left_deg"));
    let mut in_the_air = in_the_air.filter(|(at, _)| at.is_empty());
    assert!(in_the_air.all(|(_, angle)| angle < 90.0));
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
    let expected = format!("{t_s:.4} s: whisker 1: fault left {} ", faults[first]);
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
}
