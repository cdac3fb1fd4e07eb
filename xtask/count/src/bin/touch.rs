//! A sample for the detector of touches, which has learnt the air before.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::samples::spread;
use tactile::TouchDetector;

/// Samples until the detector tells touches, and more.
const LEARNING: u32 = 2_000;

count::program!(
    ("integer": "touch detector",
        (codes: Two<u16>, detector: &mut TouchDetector) -> u32 {
            step(detector, codes)
        },
        felt, learnt()),
);

/// Noise of a few codes, and a touch in a quarter of the time.
fn felt(call: u32) -> Two<u16> {
    let deflection = if call % 400 < 300 { 0.0 } else { 2_000.0 };
    let code = |call| (8_192.0 + spread(call, -5.0, 5.0)) as u16;
    Two(code(call) + deflection as u16, code(call.wrapping_mul(7)))
}

fn learnt() -> TouchDetector {
    let mut detector = TouchDetector::new();
    for call in 0..LEARNING {
        step(&mut detector, felt(call % 300));
    }
    detector
}

/// Calls the detector from one place, as a tick does.
#[inline(never)]
fn step(detector: &mut TouchDetector, Two(x, y): Two<u16>) -> u32 {
    let touching = detector.step([x, y]);
    touching.number.into()
}
