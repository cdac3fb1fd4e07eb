//! What kernels get: numbers, frames and codes that differ from call to call.

use mlx90333::{FRAME_LEN, Faults, SumRule, Word, encode};
use whisking::Real;

/// Two arguments, passed in the registers that as many single ones have.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Two<R>(pub R, pub R);

/// Three arguments.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Three<R>(pub R, pub R, pub R);

/// A number from `from` to `to`, well spread over the calls: the fractional
/// parts of multiples of the golden ratio, which fall into the largest gaps.
fn spread(call: u32, from: f64, to: f64) -> f64 {
    let fraction = f64::from(call.wrapping_mul(0x9E37_79B9)) / f64::from(u32::MAX);
    from + (to - from) * fraction
}

/// The same in a number format.
pub fn number<R: Real>(from: f64, to: f64) -> impl Fn(u32) -> R {
    move |call| R::from_f64(spread(call, from, to))
}

/// Two numbers from `from` to `to` that do not follow each other.
pub fn pair<R: Real>(from: f64, to: f64) -> impl Fn(u32) -> Two<R> {
    let number = number(from, to);
    move |call| Two(number(call), number(call.wrapping_mul(7)))
}

/// A muscle's gain, and the drive before and after, which goes up and down
/// once in a thousand calls.
pub fn drives<R: Real>() -> impl Fn(u32) -> Three<R> {
    let drive = |call: u32| {
        let phase = f64::from(call % 1000) / 500.0;
        R::from_f64(if phase < 1.0 { phase } else { 2.0 - phase })
    };
    let gain = number(1.0, 1.45);
    move |call| Three(gain(call), drive(call), drive(call + 1))
}

/// Sensor codes over the models' range and a little beyond.
pub fn codes(call: u32) -> Two<i32> {
    let code = |call| spread(call, 1_000.0, 15_000.0) as i32;
    Two(code(call), code(call.wrapping_mul(7)))
}

/// A frame of the sensor, in memory.
pub fn frame(call: u32) -> &'static [u8; FRAME_LEN] {
    static FRAMES: [[u8; FRAME_LEN]; 128] = {
        let mut frames = [[0; FRAME_LEN]; 128];
        let mut i = 0;
        while i < frames.len() {
            // Not both words zero, which no sensor sends.
            let word = (i as u16 + 1).wrapping_mul(40_503);
            let (x, y) = (Word::new(word), Word::new(word.rotate_left(7)));
            frames[i] = encode::alpha_beta(x, y, Faults::NONE, SumRule::SumB1B6);
            i += 1;
        }
        frames
    };
    &FRAMES[call as usize % FRAMES.len()]
}

/// Codes for the detector of touches: noise of a few, and a touch in a quarter of the time.
pub fn felt(call: u32) -> Two<u16> {
    let deflection = if call % 400 < 300 { 0.0 } else { 2_000.0 };
    let code = |call| (8_192.0 + spread(call, -5.0, 5.0)) as u16;
    Two(code(call) + deflection as u16, code(call.wrapping_mul(7)))
}
