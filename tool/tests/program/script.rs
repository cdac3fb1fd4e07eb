//! Commands at their times, with `--script`.

use crate::common::Place;

#[test]
fn a_module_carries_out_its_commands_and_says_so() {
    let place = Place::new();
    place.write(
        "s.txt",
        "0.5 stop\n0.8 arm\n1.0 setpoint left 75\n1.5 release left\n1.5 gain left 0\n",
    );
    let ran = place.done("records --sim bench.toml --script s.txt --seconds 3 --out r.csv");
    let answers: Vec<&str> = ran.stdout.lines().take(5).collect();
    for (answer, text) in answers.iter().zip(["0.5", "0.8", "1.0", "1.5", "1.5"]) {
        assert!(
            answer.starts_with(text) && answer.ends_with(": done"),
            "{answers:?}"
        );
    }
    let table = place.text("r.csv");
    let rows = table
        .lines()
        .skip(5)
        .map(|row| row.split(',').collect::<Vec<_>>());
    for row in rows {
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let (t_s, setpoint, measured, duty) = (number(1), number(5), number(6), number(7));
        // From the tick after the answer until the next command.
        if (0.51..0.79).contains(&t_s) {
            assert_eq!((duty, row[12], row[13]), (0.0, "0", "0"), "{row:?}");
        }
        if (1.3..1.5).contains(&t_s) {
            assert!(
                (setpoint - 75.0).abs() < 0.02 && (measured - 75.0).abs() < 1.0,
                "{row:?}"
            );
        }
        // Without gain the muscle falls back to rest.
        if t_s > 2.5 {
            assert!((setpoint - 50.0).abs() < 0.5, "{row:?}");
        }
    }
}

#[test]
fn what_is_refused_is_said_and_fails() {
    let place = Place::new();
    place.write("s.txt", "0.1 gain left 2.5\n0.2 clear right\n");
    let ran = place.fails("log --sim bench.toml --script s.txt --seconds 0.5");
    let lines: Vec<&str> = ran.stdout.lines().collect();
    assert!(
        lines[0].ends_with("gain left 2.5: value out of range"),
        "{lines:?}"
    );
    assert!(
        lines[1].contains("clear right: no such whisker"),
        "{lines:?}"
    );
    ran.warns("commands that were refused: 2");

    let ran = place.fails("log --sim bench.toml --script s.txt --seconds 0.15");
    ran.warns("without an answer at the end: 1");

    place.write("bad.txt", "0.1 gain left 1\n0.2 jump\n");
    place.refuses(
        "log --sim bench.toml --script bad.txt",
        "bad.txt: line 2: found \"jump\", unknown command, try help; allowed: arm",
    );
}

/// The motor must not stay armed because a key was not taken.
#[test]
fn a_key_that_is_refused_does_not_end_a_script() {
    let place = Place::new();
    place.write("s.txt", "0.1 arm\n0.3 set motor.duty_limit 0.5\n0.5 stop\n");
    let ran = place.fails("log --sim bench.toml --script s.txt --seconds 0.8");
    for part in [
        " arm: done",
        " set motor.duty_limit 0.5: the module refuses",
        " stop: done",
    ] {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
}
