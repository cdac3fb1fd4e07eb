//! Templates against the sum of the definition, and the board's against the PC's.

use classifiers::Error;
use classifiers::recogniser::{Recogniser, first_outcome};
use classifiers::template::Template;
use classifiers::template_train::{TemplateTrainer, Templates};
use proptest::prelude::*;

const CHANNELS: usize = 2;
const CLASSES: usize = 3;
const WINDOW: usize = 5;

/// Two signals a class; what each is made of is up to the caller.
fn trained(value: impl Fn(usize, usize, usize) -> f64) -> Templates {
    let mut trainer = TemplateTrainer::new(CHANNELS, WINDOW).unwrap();
    for class in 0..CLASSES {
        for repeat in 0..2 {
            let signal: Vec<f64> = (0..WINDOW * CHANNELS)
                .map(|n| value(class, repeat, n))
                .collect();
            trainer.add(class, &signal).unwrap();
        }
    }
    trainer.train().unwrap()
}

#[test]
fn a_case_worked_by_hand() {
    let mut trainer = TemplateTrainer::new(1, 3).unwrap();
    trainer.add(0, &[0.0, 2.0, 4.0]).unwrap();
    trainer.add(0, &[2.0, 2.0, 0.0, 99.0]).unwrap();
    trainer.add(1, &[5.0, 5.0, 5.0]).unwrap();
    let templates = trainer.train().unwrap();
    assert_eq!(templates.mean(0), Some(&[1.0, 2.0, 2.0][..]));
    // (3 − 1)² + (3 − 2)² + (4 − 2)² = 9; 4 + 4 + 1 = 9; then 9.0 and 8.
    assert_eq!(templates.errors(&[3.0, 3.0, 4.0]), [9.0, 9.0]);
    let named = |signal: &[f64]| {
        let outcome = first_outcome(&mut templates.recogniser(), signal, 1).unwrap();
        (outcome.class, outcome.samples)
    };
    assert_eq!(named(&[3.0, 3.0, 4.0]), (0, 3), "the first of equals");
    assert_eq!(named(&[3.0, 3.0, 5.0]), (1, 3));
    assert_eq!(
        named(&[3.0, 4.0]),
        (1, 2),
        "a shorter signal by what it has"
    );
    assert_eq!(named(&[3.0, 3.0]), (0, 2));
}

proptest! {
    /// Whole numbers of the sensor's 14 bits: a board that reads the raw codes
    /// decides as the PC, to the bit, and as the exact sum to rounding.
    #[test]
    fn board_pc_and_definition_agree(
        signals in prop::collection::vec(0_u16..16384, CLASSES * 2 * WINDOW * CHANNELS),
        heard in prop::collection::vec(0_u16..16384, WINDOW * CHANNELS),
    ) {
        let templates = trained(|class, repeat, n| {
            f64::from(signals[(class * 2 + repeat) * WINDOW * CHANNELS + n])
        });
        let board = Template::<CHANNELS, CLASSES>::new(templates.table()).unwrap();
        prop_assert_eq!(board.window(), WINDOW);
        let mut state = board.state();
        let mut pc = templates.recogniser();
        let quantiser = templates.quantisers()[0];
        prop_assert!(quantiser.takes_raw());
        let samples: Vec<&[u16]> = heard.chunks(CHANNELS).collect();
        for (n, sample) in samples.iter().enumerate() {
            let codes = [0, 1].map(|c| quantiser.code_from_raw(i32::from(sample[c])) as i16);
            let real = [0, 1].map(|c| f64::from(sample[c]));
            let (board, pc) = (board.push(&mut state, &codes), pc.push(&real));
            prop_assert_eq!(board.map(|c| (c.class(), c.samples())), pc.map(|o| (o.class, o.samples)));
            prop_assert_eq!(board.is_some(), n + 1 == WINDOW);
        }
        // All but the last sample, whose decision clears the sums: exact sums
        // in codes against the exact means.
        for sample in &samples[..WINDOW - 1] {
            let codes = [0, 1].map(|c| quantiser.code_from_raw(i32::from(sample[c])) as i16);
            board.push(&mut state, &codes);
        }
        let part: Vec<f64> = heard[..(WINDOW - 1) * CHANNELS].iter().copied().map(f64::from).collect();
        let unit = f64::from(1 << quantiser.exponent);
        for (class, (&found, exact)) in state.errors().iter().zip(templates.errors(&part)).enumerate() {
            let mean = templates.mean(class).unwrap();
            let bound: f64 = part.iter().zip(mean).map(|(x, t)| (x - t).abs() * unit + 0.25).sum();
            let off = (found as f64 - exact * unit * unit).abs();
            prop_assert!(off <= bound + 1e-6, "{class}: {off} {bound}");
        }
    }

    /// Real numbers of any size: where the exact errors are clearly apart the
    /// integers choose the same.
    #[test]
    fn real_numbers_are_scaled(
        scale in -30_i32..30,
        offset in -1e3_f64..1e3,
        heard in prop::collection::vec(-1.0_f64..1.0, WINDOW * CHANNELS),
        signals in prop::collection::vec(-1.0_f64..1.0, CLASSES * 2 * WINDOW * CHANNELS),
    ) {
        let unit = 10_f64.powi(scale);
        let value = |x: f64, n: usize| (x + offset * (n % 2) as f64) * unit;
        let templates = trained(|class, repeat, n| {
            value(signals[(class * 2 + repeat) * WINDOW * CHANNELS + n], n)
        });
        let heard: Vec<f64> = heard.iter().enumerate().map(|(n, &x)| value(x, n)).collect();
        let errors = templates.errors(&heard);
        let mut order: Vec<usize> = (0..CLASSES).collect();
        order.sort_by(|&a, &b| errors[a].total_cmp(&errors[b]));
        let apart = (errors[order[1]] - errors[order[0]]) / (unit * unit);
        // Codes are 2⁻¹⁴ of the unit or finer, and differences below two units.
        prop_assume!(apart > 20.0 * 2.0 / 16384.0);
        let found = first_outcome(&mut templates.recogniser(), &heard, CHANNELS).unwrap();
        prop_assert_eq!(found.class, order[0]);
    }
}

#[test]
fn far_outside_the_range_codes_saturate() {
    let templates = trained(|class, _, n| if n % 2 == 0 { class as f64 } else { 0.25 });
    let mut recogniser = templates.recogniser();
    for far in [1e300, f64::INFINITY] {
        let found = first_outcome(&mut recogniser, &[far; WINDOW * CHANNELS], CHANNELS);
        assert_eq!(found.map(|o| o.class), Some(2));
        let found = first_outcome(&mut recogniser, &[-far; WINDOW * CHANNELS], CHANNELS);
        assert_eq!(found.map(|o| o.class), Some(0));
    }
    assert_eq!(recogniser.push(&[0.0; 3]), None);
    assert_eq!(recogniser.finish(), None);
}

#[test]
fn the_widest_window_of_codes_adds_up() {
    // The largest difference there is, in all 24 channels.
    let table = [i16::MIN; 24 * 2];
    let template = Template::<24, 2>::new(&table).unwrap();
    let mut state = template.state();
    let choice = template.push(&mut state, &[i16::MAX; 24]).unwrap();
    assert_eq!((choice.class(), choice.samples()), (0, 1));
    let two = [table, [0; 48]].concat();
    let template = Template::<24, 2>::new(&two).unwrap();
    template.push(&mut state, &[i16::MAX; 24]);
    assert_eq!(state.errors(), &[24 * 65535 * 65535; 2]);
    assert_eq!(template.finish(&mut template.state()), None);
}

#[test]
fn what_is_wrong_is_named() {
    assert_eq!(TemplateTrainer::new(0, 5).err(), Some(Error::Channels));
    assert_eq!(TemplateTrainer::new(2, 0).err(), Some(Error::Window(0)));
    assert!(TemplateTrainer::new(2, usize::MAX).is_err());
    let mut trainer = TemplateTrainer::new(2, 2).unwrap();
    assert_eq!(trainer.train().err(), Some(Error::NoSamples));
    let short = Error::Short {
        found: 1,
        needed: 2,
    };
    assert_eq!(trainer.add(0, &[0.0; 2]), Err(short));
    let ragged = Error::Ragged {
        values: 5,
        channels: 2,
    };
    assert_eq!(trainer.add(0, &[0.0; 5]), Err(ragged));
    let bad = Error::NotFinite {
        sample: 1,
        channel: 0,
    };
    assert_eq!(trainer.add(0, &[0.0, 0.0, f64::NAN, 0.0]), Err(bad));
    assert_eq!(trainer.add(1 << 16, &[0.0; 4]), Err(Error::Class(1 << 16)));
    trainer.add(1, &[0.0; 4]).unwrap();
    assert_eq!(trainer.train().err(), Some(Error::Empty { class: 0 }));
    trainer.add(0, &[f64::MAX, 0.0, -f64::MAX, 0.0]).unwrap();
    assert_eq!(trainer.train().err(), Some(Error::Range));
    let shape = Error::Table {
        words: 5,
        a_sample: 4,
    };
    assert_eq!(Template::<2, 2>::new(&[0; 5]).err(), Some(shape));
    assert!(Template::<2, 2>::new(&[]).is_err());
    assert!(Template::<0, 2>::new(&[0; 4]).is_err());
}
