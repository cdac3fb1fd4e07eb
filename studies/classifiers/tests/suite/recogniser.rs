//! Recognisers answer as what they wrap, and refuse what does not fit.

use classifiers::StationaryRule;
use classifiers::recogniser::{Bayes, Outcome, Picked, Recogniser, first_outcome, outcomes, pick};
use tactile::train::{Options, Trainer};
use tactile::{Sequential, SequentialRule, Threshold, WindowRule};

/// Channel 0 tells nothing, channel 1 is 0 or 1 but for one sample in ten.
fn samples(class: usize) -> Vec<f64> {
    (0..600)
        .flat_map(|n| {
            let y = if n % 10 == 0 { 1 - class } else { class };
            [f64::from(n % 7), y as f64 * 100.0]
        })
        .collect()
}

#[test]
fn rules_answer_as_they_do_without_a_wrapper() {
    let options = Options {
        block: 5,
        smooth: 1.0,
        ..Options::default()
    };
    let mut trainer = Trainer::new(2, options).unwrap();
    let mut single = Trainer::new(1, options).unwrap();
    for class in 0..2 {
        let name = format!("{class}");
        for sample in samples(class).chunks_exact(2) {
            trainer.add(&name, sample).unwrap();
            single.add(&name, &sample[1..]).unwrap();
        }
    }
    let (buf, single) = (trainer.train().unwrap(), single.train().unwrap());
    let (model, single) = (buf.view(), single.view());
    let threshold = Threshold::new(0.99).unwrap();
    for class in 0..2 {
        let segment = samples(class);
        let mut direct = Sequential::new(model, threshold).unwrap();
        let quantisers = [0, 1].map(|c| model.quantiser(c).unwrap());
        let expected: Vec<Outcome> = segment
            .chunks_exact(2)
            .filter_map(|s| {
                let codes = [0, 1].map(|c| quantisers[c].code_from_f64(s[c]));
                direct.push(&codes).unwrap().map(Outcome::from)
            })
            .collect();
        let mut sequential = Bayes::<SequentialRule>::new(model, threshold).unwrap();
        assert!(expected.len() > 10 && expected.iter().all(|o| o.class == class));
        assert_eq!(outcomes(&mut sequential, &segment, 2), expected);
        assert_eq!(
            first_outcome(&mut sequential, &segment, 2),
            Some(expected[0])
        );

        let whole = Some(Outcome {
            class,
            samples: 600,
        });
        let mut stationary = Bayes::<StationaryRule>::new(model, ()).unwrap();
        assert_eq!(first_outcome(&mut stationary, &segment, 2), whole);
        let mut y = Picked::new(Bayes::<StationaryRule>::new(single, ()).unwrap(), &[1]);
        assert_eq!(first_outcome(&mut y, &segment, 2), whole);
        let mut x = Picked::new(Bayes::<StationaryRule>::new(single, ()).unwrap(), &[0]);
        assert_eq!(first_outcome(&mut x, &segment, 2).unwrap().class, 0);

        let mut window = Bayes::<WindowRule>::new(model, 60).unwrap();
        let windows = outcomes(&mut window, &segment, 2);
        assert_eq!(windows.len(), 10);
        assert!(windows.iter().all(|o| (o.class, o.samples) == (class, 60)));
    }
}

#[test]
fn a_sample_of_other_channels_is_not_taken() {
    let mut trainer = Trainer::new(2, Options::default()).unwrap();
    trainer.add("a", &[0.0, 0.0]).unwrap();
    trainer.add("b", &[900.0, 900.0]).unwrap();
    let buf = trainer.train().unwrap();
    let mut r = Bayes::<StationaryRule>::new(buf.view(), ()).unwrap();
    assert_eq!(r.push(&[0.0]), None);
    assert_eq!(r.push(&[0.0; 3]), None);
    assert_eq!(r.finish(), None, "nothing was taken");
    r.push(&[900.0, 900.0]);
    let mut missing = Picked::new(r, &[0, 2]);
    missing.push(&[0.0, 0.0]);
    assert_eq!(missing.finish().map(|o| (o.class, o.samples)), Some((1, 1)));
}

#[test]
fn picked_channels_keep_their_order() {
    let segment = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(pick(&segment, 3, &[2, 0]), [3.0, 1.0, 6.0, 4.0]);
    assert!(pick(&segment, 3, &[3]).is_empty());
    assert!(pick(&segment, 0, &[]).is_empty());
}
