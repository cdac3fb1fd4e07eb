//! Calibrating whiskers whose motor, encoder and way are known.

use host_sim::motor::Wire;
use wire::WhiskerId;

use super::*;
use crate::conversation::Conversation;
use crate::source::{Simulated, chosen};

/// A whisker in free air; a motor is added where there is one.
pub(in crate::commands) const SCENE: &str = r#"name = "free"
tick_hz = 2000
duration_s = 60.0
seed = 1
[head]
whiskers_per_side = 1
sides = "left"
[whisking]
frequency_hz = 2.0
integrator = "exact"
coupling = false
noise = 0.005
gain = 1.0
start = [[1.0, 0.0]]
"#;

/// What a calibration of the scene with `more` says, with that wire the wrong way.
fn calibrated(more: &str, wire: Option<Wire>) -> Result<(Results, Vec<Sample>), Error> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, format!("{SCENE}{more}")).unwrap();
    let mut simulated = Simulated::of(&path).unwrap();
    let source = chosen(&["--sim", path.to_str().unwrap()]);
    let tuner = Tuner::open(&path, &source).unwrap();
    let motor = tuner.scene().motor.as_ref().unwrap();
    if let Some(wire) = wire {
        simulated.run.motor_mut(0).unwrap().cut(wire);
    }
    let mut module = Conversation::new(Box::new(simulated));
    let mut whisker = Listening::new(&mut module, 0).unwrap();
    let mut results = Results::default();
    let samples = all(&mut whisker, &tuner, motor, &mut results)?;
    // Nothing is driven then.
    whisker.go_on().unwrap();
    let last = whisker.watch(0.05, |_| true).unwrap();
    assert_eq!(last.last().unwrap().duty, 0.0);
    Ok((results, samples))
}

fn near(found: f64, expected: f64, share: f64) {
    let off = (found / expected - 1.0).abs();
    assert!(off < share, "{found}, expected {expected}");
}

#[test]
fn the_simulated_motor_is_found_as_it_was_made() {
    let (results, samples) = calibrated("", None).unwrap();
    let motor = results.motor.unwrap();
    // k U/R ÷ (k²/R + b), at the whisker; J ÷ (k²/R + b); τ_c R/(k U): of the motor's settings.
    near(motor.speed_deg_s, 12_449.0, 0.03);
    near(motor.tau_s, 0.0481, 0.03);
    near(motor.friction, 0.05, 0.04);
    // Friction over kp = 1 degree is what it can be away from its setpoint at rest.
    assert!((0.2..1.1).contains(&results.left_deg.unwrap()));
    assert_eq!(results.range_deg, Some([30.0, 160.0]));
    let zero = results.zero.unwrap();
    for channel in &zero.channels {
        assert!(channel.offset().abs() < 0.01, "{channel:?}");
        assert!((0.3..30.0).contains(&channel.sd), "{channel:?}");
    }
    assert_eq!(zero.invalid, 0);
    assert!(samples.len() > 6_000);
    assert!(table(&samples).lines().count() == samples.len() + 1);
}

#[test]
fn a_stop_within_the_range_is_found_and_kept_away_from() {
    let motor = "[motor]\nrest = \"find\"\nstop_deg = 40.0\n";
    let (results, samples) = calibrated(motor, None).unwrap();
    let [low, high] = results.range_deg.unwrap();
    assert!((low - 40.0).abs() < 1.0 && high == 160.0, "{low} {high}");
    assert!(samples.iter().all(|sample| sample.setpoint_deg > 41.0));
}

#[test]
fn a_motor_or_an_encoder_that_is_wired_wrongly_ends_it() {
    let refusal = |wire| calibrated("", Some(wire)).unwrap_err().to_string();
    for wire in [Wire::EncoderChannels, Wire::Windings] {
        let refusal = refusal(wire);
        assert!(refusal.starts_with("direction: moved "), "{refusal}");
        let exchange = "exchange the encoder's channels";
        assert!(refusal.contains(exchange), "{refusal}");
    }
    for wire in [Wire::Winding(0), Wire::Encoder] {
        let refusal = refusal(wire);
        let open = ["direction: stays where it is", "a fault: "];
        let is_so = open.iter().any(|begins| refusal.starts_with(begins));
        assert!(is_so, "{wire:?}: {refusal}");
    }
}

#[test]
fn the_zero_that_the_module_finds_is_the_sensors_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let more = "[sensor]\nzero_after_s = 1\n[plant]\nkind = \"ideal\"\nzero_codes = [[120, -70]]\n";
    std::fs::write(&path, format!("{SCENE}{more}")).unwrap();
    let mut simulated = Simulated::of(&path).unwrap();
    simulated.run.tick();
    let mut module = Conversation::new(Box::new(simulated));
    let left = WhiskerId::default();
    assert_eq!(module.zero(left).unwrap(), Some([0, 0]));
    let right = WhiskerId { side: 1, number: 0 };
    assert_eq!(module.zero(right).unwrap(), None, "there is none");

    let mut whisker = Listening::new(&mut module, 0).unwrap();
    for found in ["while it is found", "afterwards"] {
        let samples = whisker.watch(2.5, |_| true).unwrap();
        for sample in &samples {
            let [x, y] = sample.codes;
            let is_so = x.abs_diff(8312) <= 1 && y.abs_diff(8122) <= 1;
            assert!(is_so, "{found}: {sample:?}");
        }
    }
    assert_eq!(whisker.module().zero(left).unwrap(), Some([120, -70]));
}
