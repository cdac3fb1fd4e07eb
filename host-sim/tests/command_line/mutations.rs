//! Files that were mutilated at random: refused or taken, but never a panic, a
//! signal or a number that is not finite.

use std::path::Path;

use host_sim::commands::classify;
use host_sim::commands::train;
use host_sim::decisions::Decided;
use host_sim::progress::Verbosity;
use host_sim::recording::CHANNELS;
use host_sim::training::{How, Tables};
use proptest::collection::vec;
use proptest::prelude::*;
use scene::{Rule, Scene};

use crate::common::{Place, RECORDING, SEQUENTIAL, TEXTURED, decisions, model};

#[derive(Debug, Clone)]
enum Cut {
    Replace(f64, u8),
    Insert(f64, &'static str),
    Delete(f64, usize),
    Double(f64, usize),
    End(f64),
    Number(f64, &'static str),
}

/// Ends of ranges, and what lies within most.
const NUMBERS: [&str; 16] = [
    "0", "1", "2", "12", "25", "100", "360", "20000", "100000", "0.5", "1.5", "0.999999", "0.05",
    "1e-6", "-1.5", "-360",
];

/// What is most likely to upset a reader.
const BITS: [&str; 16] = [
    "-", "0", "9", "1e308", "nan", "inf", ",", "\n", "\"", "[", "]", "\u{0}", "=", "\u{feff}", ".",
    "e-320",
];

fn cut() -> impl Strategy<Value = Cut> {
    let at = 0.0..1.0_f64;
    prop_oneof![
        3 => (at.clone(), any::<u8>()).prop_map(|(at, byte)| Cut::Replace(at, byte)),
        3 => (at.clone(), proptest::sample::select(&BITS[..]))
            .prop_map(|(at, text)| Cut::Insert(at, text)),
        2 => (at.clone(), 1..20_usize).prop_map(|(at, length)| Cut::Delete(at, length)),
        2 => (at.clone(), 1..40_usize).prop_map(|(at, length)| Cut::Double(at, length)),
        1 => at.clone().prop_map(Cut::End),
        12 => (at, proptest::sample::select(&NUMBERS[..]))
            .prop_map(|(at, number)| Cut::Number(at, number)),
    ]
}

fn mutilated(bytes: &[u8], cuts: &[Cut]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for cut in cuts {
        let place = |at: &f64| (at * bytes.len() as f64) as usize;
        match cut {
            Cut::Replace(at, new) => {
                let at = place(at);
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = *new;
                }
            }
            Cut::Insert(at, text) => {
                let at = place(at);
                bytes.splice(at..at, text.bytes());
            }
            Cut::Delete(at, length) => {
                let at = place(at);
                let end = (at + length).min(bytes.len());
                bytes.drain(at..end);
            }
            Cut::Double(at, length) => {
                let at = place(at);
                let end = (at + length).min(bytes.len());
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            Cut::End(at) => bytes.truncate(place(at)),
            Cut::Number(at, number) => {
                let at = place(at);
                let begin = bytes[at..].iter().position(u8::is_ascii_digit);
                let begin = begin.map_or(bytes.len(), |begin| at + begin);
                let of_number = |byte: &&u8| byte.is_ascii_digit() || b".e-".contains(byte);
                let length = bytes[begin..].iter().take_while(of_number).count();
                bytes.splice(begin..begin + length, number.bytes());
            }
        }
    }
    bytes
}

/// Decisions, if any fall, must be whole.
fn train_and_decide(folder: &Place, model: &str, recording: &str) -> Result<(), TestCaseError> {
    let path = |name: &str| folder.path(name);
    let mut models = vec![model];
    for (tables, out) in [(Tables::Single, "single"), (Tables::Joint, "joint")] {
        let arguments = train::Arguments {
            data: vec![path(recording)],
            channels: CHANNELS.map(str::to_owned),
            out: path(out),
            rate: Some(2000),
            unknown: None,
            scene: None,
            plot: Some(path("plot.svg")).filter(|_| tables == Tables::Joint),
            how: How {
                bins: Some(10),
                smooth: Some(1.0),
                block: Some(2),
                ..How::of(tables)
            },
        };
        if train::train(&arguments).is_ok() {
            models.push(out);
        }
    }
    for model in models {
        for rule in [
            Rule::Sequential { threshold: 0.6 },
            Rule::Window { samples: 20 },
        ] {
            let out = path("d.csv");
            let (model, data) = (path(model), path(recording));
            let quiet = Verbosity::Quiet;
            if classify::classify(&model, &data, CHANNELS, rule, &out, quiet).is_ok() {
                for d in parsed(&out) {
                    prop_assert!(d.samples >= 2);
                    prop_assert!(d.posterior > 0.0 && d.posterior <= 1.0, "{d:?}");
                }
            }
        }
    }
    Ok(())
}

fn parsed(path: &Path) -> Vec<Decided> {
    let text = std::fs::read_to_string(path).unwrap();
    // Labels may have become anything that a table can hold.
    if text.contains('"') {
        return Vec::new();
    }
    decisions(&text)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn recordings_are_refused_or_understood(cuts in vec(cut(), 1..4)) {
        let place = Place::new();
        place.write("m", model(2, 2, true));
        place.write("r.csv", mutilated(RECORDING.as_bytes(), &cuts));
        train_and_decide(&place, "m", "r.csv")?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, ..ProptestConfig::default() })]

    /// The same through the program itself.
    #[test]
    fn the_program_ends_as_it_says(cuts in vec(cut(), 1..4), which in 0..3_usize) {
        let text = format!("{TEXTURED}{SEQUENTIAL}");
        let place = Place::with(&[("s.toml", &text), ("r.csv", RECORDING)]);
        place.write("the.model", model(2, 20, true));
        let name = ["s.toml", "r.csv", "the.model"][which];
        let bytes = mutilated(&place.bytes(name), &cuts);
        // A duration may have become a day.
        let long = |scene: Scene| scene.ticks() > 20_000 || scene.whiskers() > 2;
        let scene = Scene::from_str(name, &String::from_utf8_lossy(&bytes));
        prop_assume!(!scene.is_ok_and(long));
        place.write(name, bytes);
        let classify = "classify --model the.model --data r.csv --rule window --window 20 --out d";
        let commands = [
            "run s.toml --out out",
            "train --data r.csv --out trained",
            classify,
        ];
        for command in commands {
            let ran = place.run(command);
            prop_assert!(matches!(ran.status, Some(0 | 2)), "{}: {:?}", command, ran);
            prop_assert!((ran.status == Some(2)) == ran.stderr.contains("host-sim: "), "{ran:?}");
        }
        let partial = |path: &std::path::PathBuf| path.to_string_lossy().ends_with(".partial");
        prop_assert!(!place.content().keys().any(partial));
    }
}
