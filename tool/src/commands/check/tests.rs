//! Modules with one thing wrong, each of which is named.

use std::f64::consts::TAU;

use wire::{Flags, TickRecord};

use super::*;
use crate::commands::calibrate::tests::SCENE;
use crate::source::{Alter, Altered, GOOD, parsed, scene_file};

const HOW: &[&str] = &["--seconds", "12", "--out", "unused"];

fn signs(alter: Alter) -> Vec<&'static str> {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let arguments: Arguments = parsed(&[HOW, &["--sim", scene.to_str().unwrap()]].concat());
    let simulation = || Box::new(Simulated::of(&scene).unwrap());
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

/// Another code of x; true, as the record is not lost.
fn shift(record: &mut TickRecord, codes: f64) -> bool {
    let [x, _] = record.codes();
    let code = (f64::from(x) + codes).round().clamp(0.0, 16_383.0);
    record.x = (code as u16) << 2;
    true
}

fn invalidate(record: &mut TickRecord) -> bool {
    record.flags = record.flags.without(Flags::VALID);
    true
}

fn noise(record: &TickRecord) -> f64 {
    let mixed = record.sequence.wrapping_mul(0x9E37_79B9).rotate_left(15);
    f64::from(mixed.wrapping_mul(0x85EB_CA6B)) / f64::from(u32::MAX) * 2.0 - 1.0
}

/// Whether a sign is among those that are found as it should be.
type IsThere = fn(&[&str], &str) -> bool;
const ALONE: IsThere = |signs, sign| signs == [sign];
const FIRST: IsThere = |signs, sign| signs[0] == sign;
const AMONG: IsThere = |signs, sign| signs.contains(&sign);

fn following(record: &TickRecord) -> f64 {
    2.0 * f64::from(wire::degrees(record.measured)) - 100.0
}

#[test]
fn what_is_wrong_is_named() {
    let is_named = |sign: &str, is_there: IsThere, alter: Alter| {
        let signs = signs(alter);
        assert!(is_there(&signs, sign), "{sign}: {signs:?}");
    };
    is_named("tilt", ALONE, |of, _| shift(of, 900.0));
    is_named("gap", FIRST, |of, _| shift(of, 40.0 * noise(of)));
    let waves: Alter = |of, t_s| shift(of, 12.0 * (TAU * 6.0 * t_s).sin());
    is_named("a field that changes", AMONG, waves);
    is_named("drift", AMONG, |of, t_s| shift(of, 6.0 * t_s));
    let neighbour = "a neighbour's field, or a magnet off the axis";
    is_named(neighbour, AMONG, |of, _| shift(of, following(of)));
    let at_end: Alter = |of, _| of.sequence % 50 > 0 || shift(of, 16_383.0);
    is_named("saturation", AMONG, at_end);
    let invalid: Alter = |of, _| of.sequence % 100 > 0 || invalidate(of);
    is_named("line errors", ALONE, invalid);
    let lost = "the PC or the line does not keep up";
    is_named(lost, ALONE, |of, _| of.sequence % 1_000 > 0);
}

/// Whatever shaft it has, and whether its scene has a world or not.
#[test]
fn a_whisker_in_the_air_needs_no_look() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |name: &str| scene_file(name).with_extension("toml");
    for (module, world) in [
        ("bench", "textures"),
        ("bench", "whisker"),
        ("textures", "textures"),
        ("whisker", "whisker"),
    ] {
        let of_world = std::fs::read_to_string(scene(world)).unwrap();
        let lines = of_world.lines().map(|line| match line {
            line if line.starts_with("obstacle_deg") => "obstacle_deg = [200.0]",
            line => line,
        });
        let air = folder.path().join("air.toml");
        std::fs::write(&air, lines.collect::<Vec<_>>().join("\n")).unwrap();
        let module = scene(module);
        let [sim, world_file] = [&module, &air].map(|path| path.to_str().unwrap());
        let where_it_is = ["--sim", sim, "--world", world_file];
        let arguments: Arguments = parsed(&[HOW, &where_it_is].concat());
        let seen = Seen::of(arguments.which.source.open(0).unwrap(), &arguments).unwrap();
        let simulated = Box::new(Simulated::in_the_air(&module).unwrap());
        let simulated = Seen::of(simulated, &arguments).unwrap();
        let found = findings(&seen.watched, &simulated.watched);
        let off: Vec<_> = found.iter().filter(|finding| finding.is_off()).collect();
        assert!(off.is_empty(), "{module:?} {world}: {off:?}");
    }
}
