//! Motors and encoders that do what they should not: what moves is found out by the
//! encoder, and switched off.

use crate::played::{
    LEFT, Played, TICK_HZ, angles, error_deg, extent, free_with, play, play_once, undisturbed,
};
use firmware::{Event, FAULTS, HELD};
use host_sim::motor::Wire;
use scene::Scene;
use whisking::motor::{FOLLOWING_S, Fault};

fn free_at(frequency_hz: f64, motor: &str) -> Scene {
    let mut scene = free_with(motor);
    scene.whisking.as_mut().unwrap().frequency_hz = frequency_hz;
    scene
}

/// Nothing may befall the right motor.
#[track_caller]
fn faults(played: &Played) -> Vec<(u64, Fault)> {
    let fault = |(tick, event): &(u64, Event)| match event {
        Event::MotorFault(LEFT, fault) => Some((*tick, *fault)),
        Event::MotorRetry(LEFT) | Event::MotorGivenUp(LEFT) => None,
        other => panic!("{other:?}"),
    };
    played.events.iter().filter_map(fault).collect()
}

/// Where the left whisker is from a tick on, as the encoder would say it if it could.
fn turned_by(played: &Played, from: u64) -> f64 {
    extent(&angles(played, 0)[from as usize..])
}

#[test]
fn sound_motors_have_no_fault_at_any_frequency() {
    for frequency_hz in [0.5, 2.0, 4.0, 8.0] {
        // Well within the default limits.
        let narrow = "following_limit_deg = 25\ncontinuous_duty = 0.25\n";
        let played = undisturbed(&free_at(frequency_hz, narrow), 20 * TICK_HZ);
        assert_eq!(played.events, [], "{frequency_hz} Hz");
        assert!(turned_by(&played, TICK_HZ) > 20.0, "it whisks");
    }
}

/// Wired the wrong way round from the start, where nothing jumps.
#[test]
fn a_motor_wired_backwards_is_given_up() {
    for frequency_hz in [0.5, 2.0, 8.0] {
        let scene = free_at(frequency_hz, "");
        let played = play_once(&scene, 20 * TICK_HZ, 0, |run| {
            run.motor_mut(0).unwrap().cut(Wire::EncoderChannels);
        });
        let found = faults(&played);
        assert_eq!(found.len(), FAULTS, "{frequency_hz} Hz: {found:?}");
        let given_up = played.events.last().unwrap();
        assert_eq!(given_up, &(found[FAULTS - 1].0, Event::MotorGivenUp(LEFT)));
        let off = given_up.0 as usize + 200;
        assert!(extent(&angles(&played, 0)[off..]) < 0.01, "it is driven");
        assert!(turned_by(&played, 0) < 360.0, "{frequency_hz} Hz");
    }
}

#[test]
fn a_motor_that_was_given_up_runs_when_it_is_cleared() {
    let scene = free_at(2.0, "");
    let (held, cleared) = (3 * TICK_HZ, 15 * TICK_HZ);
    let played = play(&scene, 20 * TICK_HZ, |tick, run| {
        let holds = (held..cleared).contains(&tick);
        run.motor_mut(0).unwrap().block(holds);
        if tick == cleared {
            let done = run.module_mut().command(0, firmware::Command::Clear);
            done.unwrap();
        }
    });
    assert_eq!(faults(&played).len(), usize::from(HELD));
    let last = played.events.last().unwrap();
    let is_given_up = last.1 == Event::MotorGivenUp(LEFT);
    assert!(last.0 < cleared && is_given_up, "{last:?}");
    let whisks = turned_by(&played, cleared + TICK_HZ);
    assert!(whisks > 20.0, "{whisks}");
}

/// A whisker that is held is let go within the time of the following error and a tick.
#[test]
fn a_whisker_that_is_held_is_not_driven_for_long() {
    let limit = 10.0;
    // The guard of the encoder would be first.
    let motor = format!("following_limit_deg = {limit:?}\nunmoved_duty = 2\n");
    let scene = free_at(2.0, &motor);
    let start = 3 * TICK_HZ;
    let played = play(&scene, start + TICK_HZ, |tick, run| {
        run.motor_mut(0).unwrap().block(tick >= start);
    });
    let found = faults(&played);
    let &(first, fault) = found.first().expect("a fault");
    assert_eq!(fault, Fault::Following);
    let rows = played.rows.iter();
    let mut errors = rows.map(error_deg);
    let left = errors.position(|error| error > limit).unwrap() as u64;
    let lasted = (first - left) as f64 / TICK_HZ as f64;
    assert!((FOLLOWING_S..0.045).contains(&lasted), "{lasted} s");
}

/// Held with less than half of the duty, which no stall guard sees.
#[test]
fn a_winding_that_is_driven_for_ever_is_spared() {
    let motor = "kp = 0.02\nduty_limit = 1.0\ncontinuous_duty = 0.2\n\
                 following_limit_deg = 360\nunmoved_duty = 2\n";
    let scene = free_at(2.0, motor);
    let played = play(&scene, 20 * TICK_HZ, |tick, run| {
        run.motor_mut(0).unwrap().block(tick >= 2500);
    });
    let found = faults(&played);
    assert_eq!(found.first().map(|(_, fault)| *fault), Some(Fault::Heat));
    let sound = undisturbed(&scene, 20 * TICK_HZ);
    assert_eq!(sound.events, [], "whisking trips no guard");
}
