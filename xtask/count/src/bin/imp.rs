//! A sample of one vibrissa's IMP (PSIK section 3.1): a vibration with a peak
//! every twenty samples, windows of 200. A pad takes 33 of these.
#![cfg_attr(target_os = "none", no_std, no_main)]

use classifiers::imp::{Band, Imp, ImpState};
use count::arguments::Two;
use count::samples::spread;

/// The paper's rule, and one that leaves noise of some codes out.
struct Vibrissa {
    imp: Imp<1>,
    state: ImpState<1>,
}

impl Vibrissa {
    fn new(band: u16) -> Self {
        let imp = Imp::new(200, Band::new(band)).expect("a window");
        let state = imp.state();
        Self { imp, state }
    }

    /// The IMP, after the last sample of a window; 0 after others.
    #[inline]
    fn push(&mut self, x: i32, y: i32) -> u32 {
        // Codes are of 14 bits.
        let codes = [[x as i16, y as i16]];
        self.imp
            .push(&mut self.state, &codes)
            .map_or(0, |[imp]| imp)
    }
}

/// A triangle with noise of ±10 codes, and a steady y.
fn codes(call: u32) -> Two<i32> {
    let place = (call % 20) as i32;
    let noise = spread(call, -10.0, 10.0) as i32;
    Two(3000 - 200 * (place - 10).abs() + noise, 500)
}

count::program!(
    ("integer": "imp push one vibrissa",
        (codes: Two<i32>, vibrissa: &mut Vibrissa) -> u32 { vibrissa.push(codes.0, codes.1) },
        codes, Vibrissa::new(0)),
    ("integer": "imp push with a band one vibrissa",
        (codes: Two<i32>, vibrissa: &mut Vibrissa) -> u32 { vibrissa.push(codes.0, codes.1) },
        codes, Vibrissa::new(40)),
);
