//! Modules with one thing wrong, each of which is named.

use std::f64::consts::TAU;
use std::path::PathBuf;

use clap::Parser;
use wire::{Flags, TickRecord};

use super::*;
use crate::commands::calibrate::tests::SCENE;
use crate::source::{Alter, Altered, GOOD};

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    arguments: Arguments,
}

/// The signs of what is found of such a module.
fn signs(alter: Alter) -> Vec<&'static str> {
    let folder = tempfile::tempdir().unwrap();
    let scene: PathBuf = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let words = ["check", "--seconds", "12", "--out", "unused", "--sim"];
    let words = words.iter().map(std::ffi::OsString::from);
    let Line { arguments } = Line::parse_from(words.chain([scene.clone().into_os_string()]));
    let simulation = || SourceChoice::simulation(&scene).unwrap();
    let module = Box::new(Altered {
        module: simulation(),
        alter,
        around: GOOD,
    });
    let seen = Seen::of(module, &arguments).unwrap();
    let simulated = Seen::of(simulation(), &arguments).unwrap();
    // It was at rest as its motor was switched off, and not on its way.
    let last = simulated.watched.samples.last().unwrap();
    assert!((last.measured_deg - 50.0).abs() < 2.0, "{last:?}");
    let found = findings(&seen.watched, &simulated.watched);
    let text = seen.report(&seen.origin, &found);
    let mut signs: Vec<&str> = Vec::new();
    for finding in found.iter().filter(|finding| finding.is_off()) {
        assert!(text.contains(finding.sign), "{text}");
        let sign = finding.sign.split(':').next().unwrap();
        if !signs.contains(&sign) {
            signs.push(sign);
        }
    }
    signs
}

fn shift(record: &mut TickRecord, codes: f64) {
    let [x, _] = record.codes();
    let code = (f64::from(x) + codes).round().clamp(0.0, 16_383.0);
    record.x = (code as u16) << 2;
}

/// A number between −1 and 1 that differs from tick to tick.
fn noise(record: &TickRecord) -> f64 {
    let mixed = record.sequence.wrapping_mul(0x9E37_79B9).rotate_left(15);
    f64::from(mixed.wrapping_mul(0x85EB_CA6B)) / f64::from(u32::MAX) * 2.0 - 1.0
}

#[test]
fn what_is_wrong_is_named() {
    let tilted = signs(|record, _| {
        shift(record, 900.0);
        true
    });
    assert_eq!(tilted, ["tilt"]);
    let weak = signs(|record, _| {
        shift(record, 40.0 * noise(record));
        true
    });
    assert_eq!(weak[0], "gap", "{weak:?}");
    let mains = signs(|record, t_s| {
        shift(record, 12.0 * (TAU * 6.0 * t_s).sin());
        true
    });
    assert!(mains.contains(&"a field that changes"), "{mains:?}");
    let drifts = signs(|record, t_s| {
        shift(record, 6.0 * t_s);
        true
    });
    assert!(drifts.contains(&"drift"), "{drifts:?}");
    let neighbour = signs(|record, _| {
        shift(
            record,
            2.0 * f64::from(wire::degrees(record.measured)) - 100.0,
        );
        true
    });
    assert!(
        neighbour.contains(&"a neighbour's field, or a magnet off the axis"),
        "{neighbour:?}"
    );
    let saturated = signs(|record, _| {
        if record.sequence % 50 == 0 {
            shift(record, 16_383.0);
        }
        true
    });
    assert!(saturated.contains(&"saturation"), "{saturated:?}");
    let noisy_line = signs(|record, _| {
        if record.sequence % 100 == 0 {
            record.flags = record.flags.without(Flags::VALID);
        }
        true
    });
    assert_eq!(noisy_line, ["line errors"]);
}

#[test]
fn records_that_are_lost_are_counted() {
    let lost = signs(|record, _| record.sequence % 1_000 != 0);
    assert_eq!(lost, ["the PC or the line does not keep up"]);
}
