//! The stall guard by itself, against a plain run-length count.

use proptest::prelude::*;
use proptest::sample::select;
use whisking::motor::{Duty, StallConfig, StallGuard};

#[test]
fn the_count_does_not_wrap() {
    let config = StallConfig {
        ticks: u16::MAX,
        threshold: Duty::ZERO,
    };
    let mut guard = StallGuard::default();
    let first = (1..=200_000).find(|_| guard.update(config, Duty::FULL, false));
    assert_eq!(first, Some(u32::from(u16::MAX)));
    assert!((0..200_000).all(|_| guard.update(config, Duty::FULL, false)));
}

/// A duty, the threshold of the test below and its neighbours more often than their share.
fn q15() -> impl Strategy<Value = i16> {
    let edges = vec![0, 16_384, 16_385, -16_384, -16_385, i16::MAX, i16::MIN];
    prop_oneof![any::<i16>(), select(edges)]
}

proptest! {
    /// Driven above the threshold, either way and standing still, for so many ticks, of which
    /// none are one; at full drive as the threshold never.
    #[test]
    fn stalled_exactly_at_the_end_of_a_still_run(
        ticks in 0_u16..6,
        threshold in prop_oneof![0_i16..=i16::MAX, select(vec![16_384, i16::MAX])],
        input in proptest::collection::vec((q15(), any::<bool>()), 0..60),
    ) {
        let threshold = Duty::from_q15(threshold);
        let config = StallConfig { ticks, threshold };
        let mut guard = StallGuard::default();
        let still = |&(q15, moved): &(i16, bool)| {
            !moved && i32::from(q15).abs().min(32_767) > i32::from(threshold.q15())
        };
        for (i, &(q15, moved)) in input.iter().enumerate() {
            let stalled = guard.update(config, Duty::from_q15(q15), moved);
            let run = input[..=i].iter().rev().take_while(|x| still(x)).count();
            prop_assert_eq!(stalled, run >= usize::from(ticks.max(1)));
        }
    }
}
