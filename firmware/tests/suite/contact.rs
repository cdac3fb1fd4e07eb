//! Contact of a side (BIOTACT eq. 9): the largest |H50(x)| of its whiskers,
//! whichever of them is bent and whichever way.

use firmware::{BusError, FrameSource};
use mlx90333::{FRAME_LEN, Word};
use proptest::prelude::*;
use whisking::filter;

use crate::hardware::{Bent, feeling, passive};

struct Sent(std::vec::IntoIter<Option<u16>>);

impl FrameSource for Sent {
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        let word = self.0.next().flatten();
        word.map_or(Ok(None), |word| Bent(word).take())
    }
}

/// The contact of a whisker alone that sends `words`, by [`feeling`]'s limits: one bad
/// frame is bridged, a good one ends a fault; the filter is then reset.
fn contacts(h50: &filter::Config<f64>, words: &[Option<u16>]) -> Vec<f64> {
    let (mut state, mut held, mut bad) = (filter::State::default(), 0.0, 0);
    let contact = |word: &Option<u16>| {
        bad = if word.is_some() { 0 } else { bad + 1 };
        if let Some(word) = word {
            let code = Word::new(*word).signed14().max(-8191);
            held = f64::from(code) / 8191.0;
        }
        if bad > 1 {
            (state, held) = (filter::State::default(), 0.0);
            return 0.0;
        }
        h50.process(&mut state, held).abs()
    };
    words.iter().map(contact).collect()
}

/// Any word, and the lowest, −8192, which counts as −8191: full scale and no more.
fn word() -> impl Strategy<Value = u16> {
    prop_oneof![9 => any::<u16>(), 1 => Just(0)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn whiskers_with_a_fault_have_no_part_in_contact_and_are_reset(
        words in prop::collection::vec(
            prop::collection::vec(prop::option::weighted(0.6, word()), 60),
            4,
        ),
    ) {
        let h50 = filter::Config::<f64>::new(50.0, 2000.0).unwrap();
        let sent = |n: usize| Sent(words[n].clone().into_iter());
        let config = feeling(Some(h50));
        let mut module = passive(&config, (0..4).map(sent));
        let alone: Vec<Vec<f64>> = words.iter().map(|words| contacts(&h50, words)).collect();
        for tick in 0..60 {
            module.tick(&config, &mut |_| {});
            for (found, alone) in module.contact().into_iter().zip(alone.chunks(2)) {
                let expected = alone[0][tick].max(alone[1][tick]);
                prop_assert!((found - expected).abs() < 1e-12, "{tick}: {found} {expected}");
            }
        }
    }
}
