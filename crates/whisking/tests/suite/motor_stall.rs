//! The stall guard by itself, against a plain run-length count.

use proptest::prelude::*;
use whisking::motor::{Duty, StallConfig, StallGuard};

const HALF: StallConfig = StallConfig {
    ticks: 3,
    threshold: Duty::from_q15(16_384),
};

#[test]
fn trips_on_the_last_of_the_ticks_in_either_direction() {
    for duty in [Duty::from_q15(16_385), Duty::from_q15(-16_385)] {
        let mut guard = StallGuard::default();
        let seen: Vec<bool> = (0..5).map(|_| guard.update(HALF, duty, false)).collect();
        assert_eq!(seen, [false, false, true, true, true]);
        assert!(!guard.update(HALF, duty, true));
    }
}

#[test]
fn it_says_how_long_the_motor_has_stood_still() {
    let mut guard = StallGuard::default();
    for state in [
        StallGuard::Still { ticks: 1 },
        StallGuard::Still { ticks: 2 },
        StallGuard::Stalled,
    ] {
        guard.update(HALF, Duty::FULL, false);
        assert_eq!(guard, state);
    }
    for free in [(Duty::FULL, true), (Duty::ZERO, false)] {
        guard.update(HALF, free.0, free.1);
        assert_eq!(guard, StallGuard::Free);
        guard = StallGuard::Stalled;
    }
}

#[test]
fn the_threshold_itself_does_not_count() {
    let mut guard = StallGuard::default();
    assert!((0..100).all(|_| !guard.update(HALF, HALF.threshold, false)));
}

#[test]
fn zero_ticks_is_one_tick() {
    let mut guard = StallGuard::default();
    let config = StallConfig { ticks: 0, ..HALF };
    assert!(!guard.update(config, Duty::ZERO, false));
    assert!(guard.update(config, Duty::FULL, false));
}

#[test]
fn a_full_threshold_switches_the_guard_off() {
    let config = StallConfig {
        ticks: 1,
        threshold: Duty::FULL,
    };
    assert!(!StallGuard::default().update(config, Duty::FULL, false));
}

#[test]
fn a_new_guard_starts_over() {
    let mut guard = StallGuard::default();
    guard.update(HALF, Duty::FULL, false);
    guard.update(HALF, Duty::FULL, false);
    guard = StallGuard::default();
    let seen = [(); 3].map(|()| guard.update(HALF, Duty::FULL, false));
    assert_eq!(seen, [false, false, true]);
}

#[test]
fn the_count_does_not_wrap() {
    let config = StallConfig {
        ticks: u16::MAX,
        ..HALF
    };
    let mut guard = StallGuard::default();
    let first = (1..=200_000).find(|_| guard.update(config, Duty::FULL, false));
    assert_eq!(first, Some(u32::from(u16::MAX)));
    assert!((0..200_000).all(|_| guard.update(config, Duty::FULL, false)));
}

proptest! {
    #[test]
    fn stalled_exactly_at_the_end_of_a_still_run(
        ticks in 1_u16..6,
        threshold in 0_i16..=i16::MAX,
        input in proptest::collection::vec((any::<i16>(), any::<bool>()), 0..60),
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
            prop_assert_eq!(stalled, run >= usize::from(ticks));
        }
    }
}
