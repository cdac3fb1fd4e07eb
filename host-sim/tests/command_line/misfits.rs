//! Recordings that do not fit the model are reported with file and line, and classified.

use crate::common::{Place, RECORDING, says};

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
