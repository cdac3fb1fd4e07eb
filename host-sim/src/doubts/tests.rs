use super::{Doubt, doubts, outliers};
use crate::recording::{CHANNELS, read};

fn found(tables: &[(&str, &str)]) -> Vec<Doubt> {
    let read = |(name, rows): &(&str, &str)| {
        let table = format!("label,trial,x,y\n{rows}");
        (
            (*name).to_owned(),
            read(table.as_bytes(), CHANNELS).unwrap(),
        )
    };
    doubts(&tables.iter().map(read).collect::<Vec<_>>(), CHANNELS)
}

/// Samples that never repeat, from a place in their sequence.
fn rows(label: &str, trial: usize, range: std::ops::Range<u32>) -> String {
    let row = |n: u32| {
        let x = n.wrapping_mul(0x9E37_79B9) >> 20;
        format!("{label},{trial},{x},{}\n", x / 3)
    };
    range.map(row).collect()
}

#[test]
fn what_stands_apart_does_not_make_the_scale() {
    let table = format!(
        "label,trial,x,y\n{}a,1,4294967295,-1e300\n",
        rows("a", 1, 0..100)
    );
    let streams = read(table.as_bytes(), CHANNELS).unwrap();
    let recordings = [("r".to_owned(), streams)];
    let tamed = outliers::tamed(&recordings).unwrap();
    let samples = &tamed[0].1[0].samples;
    let most = samples[..100]
        .iter()
        .map(|sample| sample[0])
        .fold(0.0, f64::max);
    assert_eq!(samples[100], [most, 0.0]);
    assert_eq!(samples[..100], recordings[0].1[0].samples[..100]);
    assert!(outliers::tamed(&tamed).is_none());
}

#[test]
fn trials_that_overlap_are_found() {
    let overlapping = [
        rows("a", 1, 0..400),
        rows("a", 2, 100..500),
        rows("b", 1, 900..1300),
    ];
    let doubt = found(&[("r.csv", &overlapping.concat())]);
    assert_eq!(doubt.len(), 1, "{doubt:?}");
    let said = "75 % of trial \"1\" of \"a\" is, sample for sample, in trial \"2\" of \"a\" too";
    assert!(doubt[0].said.starts_with(said), "{doubt:?}");
    let apart = [rows("a", 1, 0..400), rows("a", 2, 400..800)];
    assert_eq!(found(&[("r.csv", &apart.concat())]), []);
}

#[test]
fn what_rests_is_equal_by_chance() {
    let resting = "a,1,8192,8192\n".repeat(200) + &"a,2,8192,8192\n".repeat(200);
    assert_eq!(found(&[("r.csv", &resting)]), []);
}
