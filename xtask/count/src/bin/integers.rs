//! Frames, the detector of touches, and the classifier.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::classifier::{classifier, push};
use count::samples::{Two, codes, felt, frame};
use count::{kernel, model};
use mlx90333::{Decoder, FRAME_LEN};
use tactile::{Sequential, TouchDetector};

count::program!(integers);

fn integers() {
    kernel!([] "integer", "frame decode",
        (bytes: &[u8; FRAME_LEN], _: &mut ()) -> u32 {
            match Decoder::new().decode(bytes) {
                Ok(frame) => {
                    u32::from(frame.first.raw()) << 16 | u32::from(frame.second.raw())
                }
                Err(_) => 0,
            }
        },
        frame, ());
    kernel!([] "integer", "touch detector",
        (codes: Two<u16>, detector: &mut TouchDetector) -> u32 { step(detector, codes) },
        felt, learnt());
    for (name, model) in [
        ("classifier push K=4", model!("open4")),
        ("classifier push K=9", model!("open9")),
        ("classifier push and end of block K=4", model!("block4")),
        ("classifier push and end of block K=9", model!("block9")),
        ("joint classifier push K=4", model!("joint4")),
    ] {
        kernel!([] "integer", name,
            (codes: Two<i32>, classifier: &mut Sequential) -> u32 {
                push(classifier, [codes.0, codes.1])
            },
            codes, classifier(model));
    }
    kernel!([] "integer", "joint classifier in the air K=4",
        (codes: Two<i32>, classifier: &mut Sequential) -> u32 {
            classifier.pass(&[codes.0, codes.1]).is_ok().into()
        },
        codes, classifier(model!("joint4")));
}

fn learnt() -> TouchDetector {
    let mut detector = TouchDetector::new();
    for call in 0..2_000 {
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
