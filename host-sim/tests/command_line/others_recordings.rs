//! Recordings of other people: what the page says of them is so.

use crate::common::{Place, RECORDING, SEQUENTIAL, TEXTURED, line, says};

const PAGE: &str = include_str!("../../../docs/recordings.md");
const TRAIN: &str = "train --tables single --data r.csv";
const TRAINED: &str = "train --tables single --data r.csv --out m";

/// Samples that never repeat, from a place in their sequence, of a class by its level.
fn rows(label: &str, trial: usize, level: u32, range: std::ops::Range<u32>) -> String {
    let row = |n: u32| {
        let x = level + (n.wrapping_mul(0x9E37_79B9) >> 22);
        format!("{label},{trial},{x},{}\n", x / 3)
    };
    range.map(row).collect()
}

fn usual() -> String {
    let trials = (0..3).flat_map(|trial: u32| {
        let at = 1_000 * trial;
        ["low", "high"].map(|label| {
            let level = if label == "low" { 1_000 } else { 9_000 };
            rows(label, trial as usize, level, at..at + 400)
        })
    });
    format!("label,trial,x,y\n{}", trials.collect::<String>())
}

/// A recording that is refused, without its last end of a line, and the message.
const REFUSED: &str = r#"
label,trial,x\na,1,2 | line 1: no column "y"; a recording has label,trial,x,y
label;trial;x;y\na;1;2;3 | line 1: semicolons stand between the columns; allowed: commas, and points in numbers
HEADER\na,1,"0,5",3 | line 2: x is "0,5", not a finite number; write it like 1000 or 0.5
HEADER\na,1,nan,3 | line 2: x is "nan", not a finite number
HEADER\na,1,2 | line 2: 3 cells; the header has 4
HEADER\n,1,2,3 | line 2: the label is empty
HEADER\nnan,1,2,3 | line 2: the label is missing: "nan"
HEADER\n"a\nb",1,2,3 | line 2: label "a\nb" has the character '\n', which is not to be seen
HEADER,touch\na,1,2,3,yes | line 2: touch is "yes", not a whole number from 0 to 65535
# tick_hz = fast\nHEADER\na,1,2,3 | tick_hz is "fast", not a whole number above 0
HEADER | no samples"#;

#[test]
fn what_the_page_says_is_refused_is_refused_so() {
    let place = Place::new();
    let refused = |recording: &[u8], message: &str| {
        place.write("r.csv", recording);
        place.refuses_to_write(TRAIN, &["r.csv: ", message]);
        assert!(PAGE.contains(&format!("`{message}`")), "{message}");
    };
    for row in REFUSED.trim().lines() {
        let (recording, message) = row.split_once(" | ").unwrap();
        let recording = recording.replace("HEADER", "label,trial,x,y") + "\n";
        refused(recording.replace("\\n", "\n").as_bytes(), message);
    }
    let wide = "line 1: the text is in UTF-16; save it as CSV in UTF-8";
    refused(b"\xff\xfel\0a\0", wide);
    let latin = b"label,trial,x,y\na,1,2,3\nh\xf6lz,1,2,3\n";
    let not_utf_8 = "line 3: not UTF-8 (Latin-1?); save it as CSV in UTF-8";
    refused(latin, not_utf_8);
}

#[test]
fn the_rate_above_the_table_is_the_recording_s() {
    let place = Place::new();
    place.write("r.csv", format!("# tick_hz = 1000\n{}", usual()));
    let fault = "--rate: found 500, r.csv: tick_hz has 1000";
    place.refuses_to_write(&format!("{TRAIN} --rate 500"), &[fault]);
    assert!(PAGE.contains(&format!("`{fault}`")));
    place.done(TRAINED);
    let rate = |name: &str| {
        let model = tactile::ModelBuf::from_bytes(&place.bytes(name));
        model.unwrap().rate_hz()
    };
    assert_eq!(rate("m"), Some(1000));
    place.done(&format!("{TRAINED} --rate 1000"));
    // A millisecond a sample, without the option.
    let evaluate = "evaluate --model m --data r.csv --threshold 0.6";
    assert!(place.done(evaluate).stdout.contains("20 samples (20 ms)"));
    place.refuses(&format!("{evaluate} --rate 2000"), &["--rate: found 2000"]);

    place.write("other.csv", usual());
    place.done("train --tables single --data other.csv --out usual");
    assert_eq!(rate("usual"), Some(2000));
    let evaluate = "evaluate --model usual --data r.csv";
    place.refuses(evaluate, &["usual: found 2000, r.csv: tick_hz has 1000"]);
    let classify = "classify --model usual --data r.csv --rule window --window 20 --out d.csv";
    place.refuses(classify, &["usual: found 2000, r.csv: tick_hz has 1000"]);
    place.write("2.csv", format!("# tick_hz = 2000\n{}", usual()));
    place.refuses_to_write(
        &format!("{TRAIN} --data 2.csv"),
        &["r.csv: tick_hz: found 1000, 2.csv: tick_hz has 2000"],
    );
}

#[test]
fn a_model_of_another_rate_is_refused_by_a_scene() {
    let place = Place::new();
    let slow = TEXTURED.replace("tick_hz = 2000", "tick_hz = 1000");
    place.write("slow.toml", &slow);
    place.done("record slow.toml --out r.csv");
    assert!(place.text("r.csv").starts_with("# tick_hz = 1000\n"));
    place.done("train --tables single --data r.csv --out the.model");
    place.write("slow.toml", format!("{slow}{SEQUENTIAL}"));
    place.done("run slow.toml --out out");
    place.write("fast.toml", format!("{TEXTURED}{SEQUENTIAL}"));
    let found = "1000 samples a second; the scene has tick_hz = 2000";
    place.refuses("run fast.toml --out out2", &["classifier.model", found]);
}

#[test]
fn what_is_odd_is_warned_of_with_its_line() {
    let place = Place::new();
    let warned = |table: String, line: &str, message: &str| {
        place.write("r.csv", format!("# from the bench\n{table}"));
        let printed = place.done(TRAINED).stdout;
        let warning = format!("\nwarning: r.csv:{line}: ");
        says(&printed, &[&warning, message]);
        says(PAGE, &[message]);
        printed
    };
    let table = usual();
    let next = table.lines().count() + 2;
    warned(
        format!("{table}high,9,1e9,7\n"),
        &next.to_string(),
        "a reading that failed? It does not make the scale",
    );
    warned(
        format!("{table}{}", rows("low", 0, 1_000, 7_000..7_400)),
        &next.to_string(),
        "The rows of a trial must follow each other in time order; a piece counts as a trial",
    );
    let printed = warned(
        format!("{table}{}", rows("low", 9, 1_000, 100..500)),
        "3",
        "What is held out is then not new, and figures are too good; trials must not overlap",
    );
    let most = "75 % of trial \"0\" of \"low\" is, sample for sample, in trial \"9\"";
    says(&printed, &[most]);
    place.write("r.csv", &table);
    place.write("copy.csv", &table);
    let printed = place.done("train --data r.csv --data copy.csv --out m");
    let copied = ["warning: r.csv:2: 100 % of trial", "in copy.csv too"];
    says(&printed.stdout, &copied);
    assert!(!place.done(TRAINED).stdout.contains("warning"));
    for (columns, cells, said) in [
        (",tilt_deg", ",5", "warning: r.csv: tilt_deg alone"),
        (
            ",tilt_deg,depth_deg",
            ",5,6",
            "warning: no poses are estimated",
        ),
    ] {
        let rows = table.lines().skip(1).map(|row| format!("{row}{cells}\n"));
        let rows = format!("label,trial,x,y{columns}\n{}", rows.collect::<String>());
        place.write("r.csv", rows);
        says(&place.done(TRAINED).stdout, &[said]);
    }
    // What rests is equal by chance.
    let rests = |trial| format!("low,{trial},8192,8192\n").repeat(200);
    place.write("r.csv", [table, rests(7), rests(8)].concat());
    assert!(!place.done(TRAINED).stdout.contains("warning"));
}

/// Codes with one word of ones: the model is still one of codes, and decides as before.
#[test]
fn one_outlier_changes_no_decision() {
    let place = Place::new();
    let evaluated = |table: String| {
        place.write("r.csv", table);
        place.write("test.csv", usual());
        place.done(TRAINED);
        let printed = place.done("evaluate --model m --data test.csv").stdout;
        line(&printed, "hit rate").to_owned()
    };
    let usual = usual();
    let outlier = format!("{usual}high,2,4294967295,7\n");
    assert_eq!(evaluated(usual), evaluated(outlier));
}

#[test]
fn rows_in_no_order_are_named_where_nothing_can_be_learnt() {
    let place = Place::new();
    let mut alternating = String::from("label,trial,x,y\n");
    for n in 0..400 {
        alternating += &rows(["low", "high"][n % 2], 1, 1_000, n as u32..n as u32 + 1);
    }
    place.write("r.csv", alternating);
    place.refuses_to_write(
        "train --data r.csv",
        &[
            "less than two blocks",
            "found 400, of 1.0 rows in the mean",
            "r.csv:4: trial \"1\" of \"low\" begins again",
            "2 trials are in 400 pieces. The rows of a trial must follow each other",
        ],
    );
}

#[test]
fn a_hit_rate_says_which_classes_it_leaves_out() {
    let place = Place::new();
    place.write("r.csv", usual());
    place.done(TRAINED);
    // Too short for a decision.
    let short = rows("high", 0, 9_000, 0..5);
    let long = rows("low", 0, 1_000, 0..400);
    place.write("short.csv", format!("label,trial,x,y\n{long}{short}"));
    let printed = place.done("evaluate --model m --data short.csv").stdout;
    let over = "(mean over classes without high: no decision names a class there)";
    says(&printed, &[over]);
    says(PAGE, &[&over.replace("high", "felt")]);
    let classify = "classify --model m --data short.csv --rule window --window 20 --out d.csv";
    let printed = place.done(classify).stdout;
    says(&printed, &["left out, nothing was decided on: high"]);
}

/// Blank lines and cells of two lines: a row's number is not its line.
const OTHER: &str = "note,label,trial,x,y\n\n\"a\nb\",low,a,100,8000\n,low,0,120,8100\n\n\
    ,mud,0,9000,8000\n,mud,0,9100,8100\n,high,1,-0.5,8000\n,high,1,0.5,8100\n";

const CLASSIFY: &str = "classify --model m --rule window --window 2 --out d.csv --data";

#[test]
fn what_does_not_fit_is_reported_with_file_and_line() {
    let place = Place::with(&[("r.csv", RECORDING), ("other.csv", OTHER)]);
    place.done("train --tables single --data r.csv --out m --block 2");
    let evaluate = "evaluate --model m --data other.csv";
    for line in [format!("{CLASSIFY} other.csv"), evaluate.to_owned()] {
        let printed = place.done(&line).stdout;
        let naming = [
            "\nwarning: other.csv:9: x is -0.5; the model was trained on ",
            " 33 % of samples lie outside of the range",
            "\nnote: other.csv:7: label \"mud\" is none of the model's classes: low, high",
        ];
        says(&printed, &naming);
        assert_eq!(printed.matches("other.csv:").count(), 2, "{printed}");
    }
    // In the units of the samples.
    let printed = place.done(&format!("{CLASSIFY} other.csv")).stdout;
    says(&printed, &["trained on 100 to 9100."]);
    // Of what fits nothing is said.
    let printed = place.done(&format!("{CLASSIFY} r.csv")).stdout;
    assert!(!printed.contains("r.csv"), "{printed}");
}
