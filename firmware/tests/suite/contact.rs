//! Contact of a side (BIOTACT eq. 9): the largest |H50(x)| of its whiskers,
//! whichever of them is bent and whichever way.

use firmware::{Module, Passive};
use whisking::{Present, filter};

use crate::hardware::{Bent, NoClock, feeling};

const REST: u16 = 0x8000;

/// Contact of both sides after one tick of whiskers at these words.
fn contact(words: [[u16; 2]; 2]) -> [f64; 2] {
    let h50 = filter::Config::<f64>::new(50.0, 2000.0).unwrap();
    let config = feeling(Present(h50));
    let sources = words.map(|side| side.map(Bent));
    let mut module = Module::new(sources, Passive, (), NoClock);
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
