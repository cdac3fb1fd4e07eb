//! Fixed point against the reference in double precision, on sensor codes of
//! any spread, in windows.

use crate::reference::bayes::{self, Rule};
use crate::reference::recording::Sample;
use proptest::prelude::*;
use tactile::Window;
use tactile::train::{Options, Trainer};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The same winners with the same posterior, for any bins, smoothing and
    /// number of classes.
    #[test]
    fn fixed_point_agrees_with_double_precision(
        classes in 2_usize..=9,
        bins in 1_usize..200,
        smooth in 0.0_f64..10.0,
        data in prop::collection::vec((0.0_f64..1.0, 0_i32..4096, 0_i32..4096), 300..600),
    ) {
        let sample = |&(place, x, y): &(f64, i32, i32)| {
            let class = (place * classes as f64) as i32;
            // Classes differ in the spread of x and the level of y.
            let [x, y] = [f64::from(x / (1 + class)), f64::from(y / 2 + 200 * class)];
            Sample { label: format!("k{class}"), trial: String::new(), x, y }
        };
        let recording: Vec<Sample> = data.iter().map(sample).collect();
        let mut trainer = Trainer::new(2, Options { bins, smooth, block: 5 }).unwrap();
        for sample in &recording {
            trainer.add(&sample.label, &sample.channels()).unwrap();
        }
        prop_assume!(trainer.names().len() == classes);
        let model = trainer.train().unwrap();
        let quantisers = [0, 1].map(|channel| model.quantiser(channel).unwrap());
        let codes = |sample: &Sample| [0, 1].map(|c| quantisers[c].code_from_f64(sample.channels()[c]));
        // To be classified as one stream, whatever the labels.
        let unlabelled = |sample: &Sample| Sample { label: String::new(), ..sample.clone() };
        let stream: Vec<Sample> = recording.iter().map(unlabelled).collect();

        let reference = bayes::train(&recording, bins, smooth, 5);
        let exact = bayes::classify(&reference, &stream, Rule::Window(15));
        let mut window = Window::new(model.view(), 15).unwrap();
        let fixed = stream.iter().filter_map(|sample| window.push(&codes(sample)).unwrap());
        let fixed: Vec<_> = fixed.collect();
        prop_assert_eq!(fixed.len(), exact.len());
        for (f, e) in fixed.iter().zip(&exact) {
            // Three block means of two channels, each entry up to 2⁻¹¹ bit off:
            // in odds at most 2 · 6 · 2⁻¹¹ bit, in p a quarter of that times
            // ln 2. Where two classes are that close, the winner may differ,
            // its posterior may not.
            prop_assert_eq!(f.samples() as usize, e.samples);
            prop_assert!((f.posterior().to_f64() - e.posterior).abs() < 1.1e-3);
            if trainer.names()[f.leader()] != e.decision {
                prop_assert!(e.posterior < 0.502);
            }
        }
    }
}
