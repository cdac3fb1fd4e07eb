//! What a user would pick instead, counted in the same way.
#![cfg_attr(target_os = "none", no_std, no_main)]

use biquad::{Biquad as _, Coefficients, DirectForm2Transposed};
use dsp_fixedpoint::Q32;
use dsp_process::SplitProcess;
use idsp::iir::{Biquad, Cascade, DirectForm};
use micromath::F32Ext;

use count::samples::spread;

count::program!(
    ("f32": "peer: libm tanhf", (x: f32, _: &mut ()) -> f32 { libm::tanhf(x) }, signed, ()),
    ("f32": "peer: libm expf", (x: f32, _: &mut ()) -> f32 { libm::expf(x) }, signed, ()),
    ("f32": "peer: libm sqrtf", (x: f32, _: &mut ()) -> f32 { libm::sqrtf(x) }, positive, ()),
    ("f32": "peer: micromath tanh by exp",
        (x: f32, _: &mut ()) -> f32 {
            let e = F32Ext::exp(x + x);
            (e - 1.0) / (e + 1.0)
        }, signed, ()),
    ("f32": "peer: micromath exp",
        (x: f32, _: &mut ()) -> f32 { F32Ext::exp(x) }, signed, ()),
    ("f32": "peer: micromath invsqrt",
        (x: f32, _: &mut ()) -> f32 { F32Ext::invsqrt(x) }, positive, ()),
    ("f32": "peer: biquad h50",
        (x: f32, [first, second]: &mut Sections) -> f32 { second.run(first.run(x)) },
        signed, single()),
    ("q30": "peer: idsp h50",
        (x: i32, state: &mut DirectForm<i32, 2>) -> i32 { CASCADE.process(state, x) },
        |call| (spread(call, -1.0, 1.0) * Q30) as i32, DirectForm::default()),
);

/// H50 at 2 kHz as two second-order sections b0, b1, b2, a1, a2 (denominator
/// 1 + a1/z + a2/z²): the bilinear transform, pre-warped.
const SECTIONS: [[f64; 5]; 2] = [
    [
        0.072_959_657_268_266_67,
        0.072_959_657_268_266_67,
        0.0,
        -0.854_080_685_463_466_6,
        0.0,
    ],
    [
        0.005_709_266_664_235_299,
        0.011_418_533_328_470_598,
        0.005_709_266_664_235_299,
        -1.832_076_711_084_677,
        0.854_913_777_741_618,
    ],
];

type Sections = [DirectForm2Transposed<f32>; 2];

fn single() -> Sections {
    SECTIONS.map(|section| {
        let [b0, b1, b2, a1, a2] = section.map(|c| c as f32);
        DirectForm2Transposed::new(Coefficients { a1, a2, b0, b1, b2 })
    })
}

const Q30: f64 = 1_073_741_824.0;

const CASCADE: Cascade<[Biquad<Q32<30>>; 2]> =
    Cascade([section(SECTIONS[0]), section(SECTIONS[1])]);

const fn section([b0, b1, b2, a1, a2]: [f64; 5]) -> Biquad<Q32<30>> {
    Biquad {
        ba: [fixed(b0), fixed(b1), fixed(b2), fixed(-a1), fixed(-a2)],
    }
}

const fn fixed(x: f64) -> Q32<30> {
    Q32::from_bits((x * Q30) as i32)
}

fn signed(call: u32) -> f32 {
    spread(call, -3.0, 3.0) as f32
}

fn positive(call: u32) -> f32 {
    spread(call, 0.01, 4.5) as f32
}

#[cfg(test)]
mod tests {
    use biquad::Biquad as _;

    use super::{CASCADE, DirectForm, Q30, SplitProcess, single, spread};
    use count::format::{Format, parts};
    use whisking::filter::State;

    #[test]
    fn the_peers_do_the_same_work() {
        let [mut first, mut second] = single();
        let mut fixed = DirectForm::default();
        let h50 = parts::<f64>(f64::LONE).h50;
        let mut ours = State::default();
        for n in 0..1000 {
            let x = spread(n, -1.0, 1.0);
            let truth = h50.process(&mut ours, x);
            let float = f64::from(second.run(first.run(x as f32)));
            let integer = f64::from(CASCADE.process(&mut fixed, (x * Q30) as i32)) / Q30;
            assert!((float - truth).abs() < 1e-4, "{n}: {float} {truth}");
            assert!((integer - truth).abs() < 1e-4, "{n}: {integer} {truth}");
        }
    }
}
