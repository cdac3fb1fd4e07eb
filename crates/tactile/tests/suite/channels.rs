//! Any number of channels and classes gives the same bits.

use crate::common::model;
use proptest::prelude::*;
use tactile::{
    Decision, DecisionRule, NaiveBayes, Posteriors, SequentialRule, Threshold, WindowRule,
};

/// All decisions of a stream and the posteriors at its end.
fn run<R: DecisionRule>(
    mut c: NaiveBayes<R, &[u32]>,
    codes: &[Vec<i32>],
) -> (Vec<Decision>, Posteriors) {
    let mut decisions: Vec<_> = codes.iter().filter_map(|s| c.push(s).unwrap()).collect();
    let posteriors = c.posteriors();
    decisions.extend(c.finish());
    (decisions, posteriors)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A channel that says nothing changes nothing. Odd and even numbers of
    /// classes.
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
        let (two, three) = (two.view(), three.view());
        let pairs: Vec<Vec<i32>> = codes.iter().map(|&(x, y)| vec![x, y]).collect();
        let triples: Vec<Vec<i32>> = codes.iter().map(|&(x, y)| vec![x, y, x ^ y]).collect();
        let threshold = Threshold::new(0.9).unwrap();
        let sequential = |model, codes| run(NaiveBayes::<SequentialRule, _>::new(model, threshold).unwrap(), codes);
        let a = sequential(two, &pairs);
        // Rarely no decision falls in twenty blocks; such a case compares nothing.
        prop_assume!(!a.0.is_empty());
        prop_assert_eq!(a, sequential(three, &triples));
        let window = |model, codes| run(NaiveBayes::<WindowRule, _>::new(model, 30).unwrap(), codes);
        prop_assert_eq!(window(two, &pairs), window(three, &triples));
    }
}
