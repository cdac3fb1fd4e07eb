//! A sensor whose zero has moved, in a module that finds the new one by itself.

use std::ops::Range;

use firmware::{Event, SensorFault};
use host_sim::bus::WireFault;

use crate::played::{LEFT, Played, TICK_HZ, play_once, scene, textured, undisturbed};

/// A silence, in ticks of the scenes below.
const SILENCE: u64 = 2 * TICK_HZ;

/// Plays a scene with an obstacle at `at_deg`, in which the left sensor reads `zero` at rest,
/// which changes by `drift` a second, in codes.
fn play_with(at_deg: f64, ticks: u64, zero: [f64; 2], drift: [f64; 2]) -> Played {
    let keys = "[sensor]\nzero_after_s = 2\nzero_calm = 0.1\n";
    undisturbed(&scene(1, &plant(at_deg, zero, drift), keys), ticks)
}

fn plant(at_deg: f64, zero: [f64; 2], drift: [f64; 2]) -> String {
    let keys = format!("zero_codes = [{zero:?}, [0, 0]]\nzero_drift = [{drift:?}, [0, 0]]\n");
    textured(at_deg) + &keys
}

/// Codes from mid-scale that the module takes for the left sensor's in some ticks, on average.
fn mean(played: &Played, ticks: Range<u64>) -> [f64; 2] {
    let heard = played.heard.iter().filter(|(tick, _)| ticks.contains(tick));
    let codes: Vec<[u16; 2]> = heard.map(|(_, codes)| *codes).collect();
    [0, 1].map(|axis: usize| {
        let sum: f64 = codes.iter().map(|codes| f64::from(codes[axis])).sum();
        sum / codes.len() as f64 - 8192.0
    })
}

#[test]
fn in_free_air_the_zero_is_found_after_a_silence() {
    let played = play_with(300.0, 5 * SILENCE, [90.0, -40.0], [0.0; 2]);
    let [(tick, Event::ZeroMoved(LEFT, [x, y]))] = played.events[..] else {
        panic!("{:?}", played.events);
    };
    assert!((90 - x).abs() <= 2 && (-40 - y).abs() <= 1, "{x}, {y}");
    assert_eq!(tick, SILENCE - 1);
    let [x, y] = mean(&played, 1000..tick);
    assert!((x - 90.0).abs() < 3.0 && (y + 40.0).abs() < 1.0, "{x}, {y}");
    let [x, y] = mean(&played, tick + 1..5 * SILENCE);
    assert!(x.abs() < 3.0 && y.abs() < 1.0, "{x}, {y}");
    // The trace has what the sensor sends.
    let sent = &played.rows[1000..];
    let sent = sent.iter().map(|row| row.x[0]).sum::<f64>() / sent.len() as f64;
    assert!((sent - 8282.0).abs() < 3.0, "{sent}");
}

#[test]
fn a_zero_that_drifts_is_followed() {
    // 100 codes in forty seconds.
    let ticks = 20 * SILENCE;
    let played = play_with(300.0, ticks, [0.0; 2], [2.5, 0.0]);
    for n in 2..20 {
        let [x, y] = mean(&played, n * SILENCE..(n + 1) * SILENCE);
        // Behind by a silence and a half, 7.5 codes, and by less than the step of eight.
        let is_near = (-1.0..15.6).contains(&x) && y.abs() < 1.0;
        assert!(is_near, "silence {n}: {x}, {y}");
    }
    assert!(played.events.len() > 5, "{:?}", played.events);
}

#[test]
fn a_zero_beyond_the_bound_is_left_alone() {
    for zero in [[170.0, 0.0], [0.0, -170.0]] {
        let played = play_with(300.0, 3 * SILENCE, zero, [0.0; 2]);
        assert_eq!(played.events, []);
        let [x, y] = mean(&played, 1000..3 * SILENCE);
        let off = [x - zero[0], y - zero[1]].map(f64::abs);
        assert!(off[0] < 3.0 && off[1] < 1.0, "{off:?}");
    }
}

#[test]
fn while_it_touches_something_in_every_whisk_there_is_no_silence() {
    let played = play_with(90.0, 5 * SILENCE, [90.0, -40.0], [0.0; 2]);
    let touching = played.rows.iter().filter(|row| row.contact[0] > 0.2);
    assert!(touching.count() > 1000);
    let of_left = |event: &&(u64, Event)| matches!(event.1, Event::ZeroMoved(LEFT, _));
    assert_eq!(played.events.iter().find(of_left), None);
}

#[test]
fn frozen_words_stay_a_fault_and_move_no_zero() {
    let keys = "[sensor]\nzero_after_s = 0.5\nzero_calm = 0.1\nfrozen_s = 1\n";
    let drifting = plant(300.0, [0.0; 2], [60.0, 0.0]);
    let scene = scene(1, &drifting, keys);
    let played = play_once(&scene, 4 * TICK_HZ, TICK_HZ + 10, |run| {
        run.slave_mut(0).unwrap().set_fault(Some(WireFault::Frozen));
    });
    let lost = |event: &(u64, Event)| {
        matches!(event.1, Event::SensorLost(LEFT, SensorFault::Frozen)).then_some(event.0)
    };
    let lost: Vec<u64> = played.events.iter().filter_map(lost).collect();
    // One second after the last word that was another.
    assert_eq!(lost, [2 * TICK_HZ + 10]);
}
