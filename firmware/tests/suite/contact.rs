//! Contact of a side (BIOTACT eq. 9): the largest |H50(x)| of its whiskers,
//! whichever of them is bent and whichever way.

use firmware::{BusError, FrameSource};
use mlx90333::{FRAME_LEN, Word};
use proptest::prelude::*;
use whisking::filter;

use crate::hardware::{Bent, feeling, passive};

const REST: u16 = 0x8000;

fn contact(words: [[u16; 2]; 2]) -> [f64; 2] {
    let h50 = filter::Config::<f64>::new(50.0, 2000.0).unwrap();
    let config = feeling(Some(h50));
    let mut module = passive(&config, words.into_iter().flatten().map(Bent));
    module.tick(&config, &mut |event| panic!("{event:?}"));
    module.contact()
}

/// What one tick of H50 leaves of a reading of `code`: the first value of its
/// impulse response, by scipy.signal.butter(3, 50, fs=2000).
fn felt(code: i16) -> f64 {
    4.165_461_390_757_6e-4 * f64::from(code) / 8191.0
}

#[test]
fn the_most_bent_whisker_of_a_side_counts_wherever_it_stands() {
    // 0xC000 is 4096 above the middle, 0x9000 is 1024.
    for (side, code) in [
        ([0xC000, REST], 4096),
        ([REST, 0xC000], 4096),
        ([0xC000, 0x9000], 4096),
        ([0x9000, 0xC000], 4096),
        ([REST, REST], 0),
    ] {
        for [left, right] in [
            contact([side, [REST; 2]]),
            // The other side is felt by itself.
            {
                let [left, right] = contact([[REST; 2], side]);
                [right, left]
            },
        ] {
            assert!((left - felt(code)).abs() < 1e-12, "{side:x?}: {left}");
            assert_eq!(right, 0.0, "{side:x?}");
        }
    }
}

#[test]
fn a_whisker_is_felt_whichever_way_it_is_bent() {
    // 0x4000 is 4096 below the middle.
    for side in [[0x4000, REST], [REST, 0x4000], [0x4000, 0x9000]] {
        let [left, _] = contact([side, [REST; 2]]);
        assert!((left - felt(4096)).abs() < 1e-12, "{side:x?}: {left}");
    }
}

/// The lowest code, −8192, counts as −8191: full scale and no more.
#[test]
fn the_lowest_reading_is_full_scale() {
    let [left, _] = contact([[0x0000, REST], [REST; 2]]);
    assert!((left - felt(8191)).abs() < 1e-12, "{left}");
}

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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn whiskers_with_a_fault_have_no_part_in_contact_and_are_reset(
        words in prop::collection::vec(
            prop::collection::vec(prop::option::weighted(0.6, any::<u16>()), 60),
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
