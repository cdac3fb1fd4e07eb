//! Files that were mutilated at random: refused or taken, but never a panic, a
//! signal or a number that is not finite.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use scene::Scene;

use crate::common::{Place, RECORDING, decisions};

#[derive(Debug, Clone)]
struct Cut {
    /// Where, as a share of the file.
    at: f64,
    /// How many are left out; `None`: the next number.
    length: Option<usize>,
    new: &'static str,
}

/// Ends of ranges, and what lies within most.
const NUMBERS: [&str; 16] = [
    "0", "1", "2", "12", "25", "100", "360", "20000", "100000", "0.5", "1.5", "0.999999", "0.05",
    "1e-6", "-1.5", "-360",
];

/// What is most likely to upset a reader.
const BITS: [&str; 19] = [
    "", "-", "0", "9", "1e308", "nan", "inf", ",", "\n", "\"", "[", "]", "\u{0}", "=", "\u{feff}",
    ".", "e-320", "\u{7f}", "trial",
];

fn cut() -> impl Strategy<Value = Cut> {
    let number = (Just(None), select(&NUMBERS[..]));
    let lengths = prop_oneof![Just(0), 1..20_usize, Just(usize::MAX)];
    let other = (lengths.prop_map(Some), select(&BITS[..]));
    let cut = |(at, (length, new))| Cut { at, length, new };
    (0.0..1.0_f64, prop_oneof![number, other]).prop_map(cut)
}

fn mutilated(mut bytes: Vec<u8>, cuts: &[Cut]) -> Vec<u8> {
    for cut in cuts {
        let mut begin = (cut.at * bytes.len() as f64) as usize;
        let length = cut.length.unwrap_or_else(|| {
            let digit = bytes[begin..].iter().position(u8::is_ascii_digit);
            begin = digit.map_or(bytes.len(), |digit| begin + digit);
            let of_number = |byte: &&u8| byte.is_ascii_digit() || b".e-".contains(byte);
            bytes[begin..].iter().take_while(of_number).count()
        });
        let end = begin.saturating_add(length).min(bytes.len());
        bytes.splice(begin..end, cut.new.bytes());
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn the_program_ends_as_it_says(cuts in vec(cut(), 1..4), which in 0..3_usize) {
        let place = Place::classifying();
        place.write("r.csv", RECORDING);
        let name = ["s.toml", "r.csv", "the.model"][which];
        let bytes = mutilated(place.bytes(name), &cuts);
        // A duration may have become a day.
        let long = |scene: Scene| scene.ticks() > 20_000 || scene.whiskers() > 2;
        let scene = Scene::from_str(name, &String::from_utf8_lossy(&bytes));
        prop_assume!(!scene.is_ok_and(long));
        place.write(name, bytes);
        let classify = "classify --data r.csv --rule sequential --threshold 0.6 --out d --model";
        for command in [
            "run s.toml --out out",
            "train --data r.csv --block 2 --out joint --plot plot.svg",
            "train --data r.csv --tables single --block 2 --out single",
            &format!("{classify} joint"),
            &format!("{classify} single"),
            &format!("{classify} the.model"),
        ] {
            let ran = place.run(command);
            prop_assert!(matches!(ran.status, Some(0 | 2)), "{}: {:?}", command, ran);
            prop_assert!((ran.status == Some(2)) == ran.stderr.contains("host-sim: "), "{ran:?}");
        }
        let content = place.content();
        for (path, bytes) in &content {
            let name = path.file_name().unwrap().to_string_lossy();
            prop_assert!(!name.ends_with(".partial"));
            // Labels may have become anything that a table can hold.
            let text = String::from_utf8_lossy(bytes.as_deref().unwrap_or_default());
            if name == "d" && !text.contains('"') {
                for d in decisions(&text) {
                    prop_assert!(d.samples >= 2, "{d:?}");
                    prop_assert!(d.posterior > 0.0 && d.posterior <= 1.0, "{d:?}");
                }
            }
        }
    }
}
