//! Hall codes and the count: the tracker is exact up to its speed limit and faults above.

use crate::pins::CODES;
use proptest::prelude::*;
use whisking::motor::{Fault, HallTracker};

#[test]
fn half_a_turn_is_counted_the_way_it_last_moved() {
    for (codes, counts) in [([1, 3, 4], 4), ([3, 1, 6], -4), ([1, 1, 6], 3)] {
        let mut tracker = HallTracker::new(9);
        for code in codes {
            tracker.update(code).unwrap();
        }
        assert_eq!(tracker.counts(), counts, "{codes:?}");
    }
}

#[test]
fn an_impossible_code_changes_nothing() {
    let mut tracker = HallTracker::new(2);
    tracker.update(1).unwrap();
    tracker.update(2).unwrap();
    let before = tracker;
    for code in [0, 7, 8, 255] {
        assert_eq!(tracker.update(code), Err(Fault::InvalidHall(code)));
        assert_eq!(tracker, before);
    }
    // The skip before it still counts.
    assert_eq!(tracker.update(4), Err(Fault::SkippedSector));
    assert_eq!(tracker.counts(), 4);
    tracker.forget_skips();
    assert!(tracker.update(1).is_ok());
}

#[test]
fn a_limit_of_zero_is_a_limit_of_one() {
    let mut tracker = HallTracker::new(0);
    for code in [1, 1, 3, 1] {
        assert!(tracker.update(code).is_ok());
    }
    assert_eq!(tracker.update(2), Err(Fault::SkippedSector));
}

proptest! {
    /// The speed limit as documented: no fault up to 2 − 1/N sectors a tick, a
    /// fault above, and the count exact to the last.
    #[test]
    fn tracker_limits_speed(
        limit in 1_u8..8,
        start in 0_i32..6000,
        speed in 0_i32..2990,
        forward: bool,
    ) {
        // In thousandths of a sector.
        let mut tracker = HallTracker::new(limit);
        let sector = |at: i32| at.div_euclid(1000);
        let velocity = if forward { speed } else { -speed };
        let mut seen = Ok(());
        let mut at = start;
        for _ in 0..3000 {
            let code = CODES[sector(at).rem_euclid(6) as usize];
            seen = tracker.update(code).map(drop);
            if velocity.abs() <= 2000 {
                prop_assert_eq!(tracker.counts(), sector(at) - sector(start));
            }
            if seen.is_err() {
                break;
            }
            at += velocity;
        }
        let fault = i64::from(speed) * i64::from(limit) > 1000 * (2 * i64::from(limit) - 1);
        prop_assert_eq!(seen, if fault { Err(Fault::SkippedSector) } else { Ok(()) });
    }
}
