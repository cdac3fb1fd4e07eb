//! Every way of looking channels up gives the same bits: the code of a board
//! for one and two channels, its groups of three for more, and the loop for
//! any number.

mod common;

use common::model;
use proptest::prelude::*;
use tactile::dynamic::{self, Classifier};
use tactile::{Decision, Stationary, Threshold};

/// All decisions of a stream and the posteriors at its end.
fn run(mut c: Box<dyn Classifier + '_>, codes: &[Vec<i32>]) -> (Vec<Decision>, Vec<f64>) {
    let mut decisions: Vec<_> = codes.iter().filter_map(|s| c.push(s).unwrap()).collect();
    let posteriors = c.posteriors();
    decisions.extend(c.finish());
    (decisions, posteriors)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A channel that says nothing changes nothing: two channels by the code
    /// of a board, and the same with a third one by the loop over channels.
    /// Odd and even numbers of classes.
    #[test]
    fn any_number_of_channels_gives_the_same_bits(
        classes in 2_usize..=32,
        table in prop::collection::vec(0.0_f64..19.9, 8 * 2 * 32),
        codes in prop::collection::vec((-100_i32..1100, any::<i32>()), 200),
    ) {
        let entry = |bin: usize, channel: usize, class: usize| -table[(bin * 2 + channel) * 32 + class];
        let two = model(classes, 2, 8, 10, entry);
        let three = model(classes, 3, 8, 10, |bin, channel, class| {
            if channel < 2 { entry(bin, channel, class) } else { -7.0 }
        });
        let (two, three) = (two.model().unwrap(), three.model().unwrap());
        let pairs: Vec<Vec<i32>> = codes.iter().map(|&(x, y)| vec![x, y]).collect();
        let triples: Vec<Vec<i32>> = codes.iter().map(|&(x, y)| vec![x, y, x ^ y]).collect();
        let threshold = Threshold::new(0.9).unwrap();
        let a = run(dynamic::sequential(&two, threshold).unwrap(), &pairs);
        let b = run(dynamic::sequential(&three, threshold).unwrap(), &triples);
        // Rarely no decision falls in twenty blocks; such a case compares nothing.
        prop_assume!(!a.0.is_empty());
        prop_assert_eq!(a, b);
        prop_assert_eq!(
            run(dynamic::window(&two, 30).unwrap(), &pairs),
            run(dynamic::window(&three, 30).unwrap(), &triples)
        );
        prop_assert_eq!(
            run(dynamic::stationary(&two).unwrap(), &pairs),
            run(dynamic::stationary(&three).unwrap(), &triples)
        );
    }

    /// Twelve and seven channels of a board (groups of three, and a rest)
    /// against the loop.
    #[test]
    fn grouped_channels_give_the_same_bits(
        table in prop::collection::vec(0.0_f64..19.9, 8 * 12 * 9),
        codes in prop::collection::vec(prop::array::uniform12(-100_i32..1100), 60),
    ) {
        fn check<const C: usize>(table: &[f64], codes: &[[i32; 12]]) -> Result<(), TestCaseError> {
            let buf = model(9, C, 8, 5, |bin, channel, class| -table[(bin * 12 + channel) * 9 + class]);
            let model = buf.model().unwrap();
            let rule = Stationary::<C, 9>::new(&model).unwrap();
            let mut state = rule.state();
            let mut any = dynamic::stationary(&model).unwrap();
            for sample in codes {
                let sample: [i32; C] = std::array::from_fn(|c| sample[c]);
                rule.push(&mut state, &sample);
                any.push(&sample).unwrap();
                prop_assert!(any.push(&sample[1..]).is_err());
            }
            prop_assert_eq!(rule.finish(&mut state), any.finish());
            Ok(())
        }
        check::<12>(&table, &codes)?;
        check::<7>(&table, &codes)?;
        check::<2>(&table, &codes)?;
    }
}
