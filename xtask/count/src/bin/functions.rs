//! The elementary functions of a tick, and what a user would pick instead.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::samples::{Two, number, pair, spread};
use count::{Format, kernel};
use whisking::Fix;

count::program!(functions);

fn functions() {
    each::<f32>();
    each::<f64>();
    each::<Fix>();
    peers();
}

#[inline(never)]
fn each<R: Format>() {
    kernel!([R] R::NAME, "drive",
        (x: R, _: &mut ()) -> R { whisking::muscle::drive(x) },
        number::<R>(-1.5, 1.5), ());
    kernel!([R] R::NAME, "exp_neg_square",
        (x: R, _: &mut ()) -> R { x.exp_neg_square() },
        number::<R>(-1.5, 1.5), ());
    kernel!([R] R::NAME, "unit",
        (at: Two<R>, unit: &mut [R; 2]) {
            if let Some(found) = R::unit(at.0, at.1) {
                *unit = found;
            }
        },
        pair::<R>(-1.5, 1.5), [R::ZERO; 2]);
}

fn peers() {
    let signed = |call| spread(call, -3.0, 3.0) as f32;
    let positive = |call| spread(call, 0.01, 4.5) as f32;
    kernel!([] "f32", "peer: libm tanhf",
        (x: f32, _: &mut ()) -> f32 { libm::tanhf(x) }, signed, ());
    kernel!([] "f32", "peer: libm expf",
        (x: f32, _: &mut ()) -> f32 { libm::expf(x) }, signed, ());
    kernel!([] "f32", "peer: libm sqrtf",
        (x: f32, _: &mut ()) -> f32 { libm::sqrtf(x) }, positive, ());
    kernel!([] "f32", "peer: micromath tanh by exp",
        (x: f32, _: &mut ()) -> f32 {
            let e = micromath::F32Ext::exp(x + x);
            (e - 1.0) / (e + 1.0)
        },
        signed, ());
    kernel!([] "f32", "peer: micromath exp",
        (x: f32, _: &mut ()) -> f32 { micromath::F32Ext::exp(x) }, signed, ());
    kernel!([] "f32", "peer: micromath invsqrt",
        (x: f32, _: &mut ()) -> f32 { micromath::F32Ext::invsqrt(x) }, positive, ());
}
