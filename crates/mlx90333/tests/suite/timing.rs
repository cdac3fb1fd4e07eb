//! The time on the wire, and how the durations hang together.

use mlx90333::timing::{
    BYTE_GAP_FAST_NS, BYTE_GAP_SAFE_NS, CLOCK_COMFORTABLE_HZ, CLOCK_MAX_HZ, SS_HIGH_US,
    START_UP_US, START_UP_WAIT_US, frame_time_ns,
};

#[test]
fn frame_times_by_hand() {
    assert_eq!(frame_time_ns(400_000, 0), 160_000);
    assert_eq!(frame_time_ns(400_000, BYTE_GAP_FAST_NS), 247_500);
    assert_eq!(frame_time_ns(400_000, BYTE_GAP_SAFE_NS), 510_000);
    assert_eq!(frame_time_ns(CLOCK_MAX_HZ, BYTE_GAP_FAST_NS), 287_500);
    assert_eq!(frame_time_ns(CLOCK_MAX_HZ, BYTE_GAP_SAFE_NS), 550_000);
    assert_eq!(frame_time_ns(CLOCK_COMFORTABLE_HZ, 0), 400_000);
}

#[test]
fn frame_time_at_the_ends_of_the_range() {
    assert_eq!(frame_time_ns(0, 0), u64::MAX);
    // 64/3 s, rounded up.
    assert_eq!(frame_time_ns(3, 0), 21_333_333_334);
    let longest = 64_000_000_000 + 7 * u64::from(u32::MAX);
    assert_eq!(frame_time_ns(1, u32::MAX), longest);
}

#[test]
fn waiting_for_start_up_covers_the_idle_select() {
    const { assert!(START_UP_WAIT_US >= START_UP_US + SS_HIGH_US) };
}
