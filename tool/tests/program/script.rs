//! Commands at their times, with `--script`.

use crate::common::Place;

#[test]
fn a_module_carries_out_its_commands_and_says_so() {
    let place = Place::new();
    let script = "0.5 stop\n0.8 arm\n1.0 setpoint left 75\n1.5 release left\n1.5 gain left 0\n";
    place.write("s.txt", script);
    let ran = place.done("records --sim bench.toml --script s.txt --seconds 3 --out r.csv");
    let answers: Vec<&str> = ran.stdout.lines().take(5).collect();
    for (answer, text) in answers.iter().zip(["0.5", "0.8", "1.0", "1.5", "1.5"]) {
        let is_done = answer.starts_with(text) && answer.ends_with(": done");
        assert!(is_done, "{answers:?}");
    }
    let columns = [
        "t_s",
        "setpoint_deg",
        "measured_deg",
        "duty",
        "armed",
        "running",
    ];
    let columns = columns.map(|name| place.column("r.csv", name));
    for n in 0..columns[0].len() {
        let row = columns.each_ref().map(|column| column[n]);
        let [t_s, setpoint, measured, driven @ ..] = row;
        // From the tick after the answer until the next command.
        if (0.51..0.79).contains(&t_s) {
            assert_eq!(driven, [0.0; 3], "{row:?}");
        }
        if (1.3..1.5).contains(&t_s) {
            assert!((setpoint - 75.0).abs() < 0.02, "{row:?}");
            assert!((measured - 75.0).abs() < 1.0, "{row:?}");
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
    ran.prints("gain left 2.5: value out of range\n");
    ran.prints("clear right: no such whisker");
    ran.warns("commands that were refused: 2");

    let ran = place.fails("log --sim bench.toml --script s.txt --seconds 0.15");
    ran.warns("without an answer at the end: 1");

    place.write("bad.txt", "0.1 gain left 1\n0.2 jump\n");
    let bad = "bad.txt: line 2: found \"jump\", unknown command, try help; allowed: arm";
    place.refuses("log --sim bench.toml --script bad.txt", bad);
}

/// The motor must not stay armed because a key was not taken.
#[test]
fn a_key_that_is_refused_does_not_end_a_script() {
    let place = Place::new();
    place.write("s.txt", "0.1 arm\n0.3 set motor.duty_limit 0.5\n0.5 stop\n");
    let ran = place.fails("log --sim bench.toml --script s.txt --seconds 0.8");
    ran.prints(" arm: done");
    ran.prints(" set motor.duty_limit 0.5: the module refuses");
    ran.prints(" stop: done");
}
