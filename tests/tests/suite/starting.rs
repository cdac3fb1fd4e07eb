//! How a module starts: armed or not, where its whiskers are, and how softly they set off.

use crate::played::{
    LEFT, Played, TICK_HZ, angles, extent, farthest, faults, free_with, play, setpoints,
    undisturbed,
};
use firmware::{Event, FAULTS};
use host_sim::bus::WireFault;
use host_sim::motor::{SimMotor, Wire};
use whisking::motor::Fault;

/// Whiskers that look for their stop once they are armed, in tick [`ARMED`].
const FIND: &str = "rest = \"find\"\narm = \"on-command\"\n";
const ARMED: u64 = 10;

fn speeds_deg_s(played: &Played) -> Vec<f64> {
    let angles = angles(played, 0);
    let steps = angles.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    steps.map(|step| step * TICK_HZ as f64).collect()
}

#[test]
fn a_module_that_is_not_armed_computes_on_with_its_motors_off() {
    let second = TICK_HZ as usize;
    let scene = free_with("arm = \"on-command\"\n");
    let played = play(&scene, 6 * TICK_HZ, |tick, run| {
        run.arm((2..4).contains(&(tick / TICK_HZ)));
    });
    assert_eq!(played.events, []);
    let angles = angles(&played, 0);
    assert_eq!(extent(&angles[..2 * second]), 0.0, "it is driven");
    let generator = &setpoints(&played)[..2 * second];
    assert!(extent(generator) > 20.0, "the pattern generator goes on");
    assert_eq!(played.heard.len(), 6 * second, "it is listened to");
    assert!(extent(&angles[3 * second..4 * second]) > 20.0, "it whisks");
    assert!(extent(&angles[4 * second + 400..]) < 0.01, "it is driven");
}

/// Whoever arms a motor that is off says that its whisker is at rest.
#[test]
fn rest_is_where_the_whisker_is_when_it_is_armed() {
    let scene = free_with("arm = \"on-command\"\n");
    let played = play(&scene, 4 * TICK_HZ, |tick, run| match tick {
        // Somebody plays with it, and brings it back.
        10 => run.motor_mut(0).unwrap().turn_to_deg(120.0),
        500 => run.motor_mut(0).unwrap().turn_to_deg(50.0),
        1000 => run.arm(true),
        _ => {}
    });
    assert_eq!(played.events, []);
    assert!(farthest(&played, 2 * TICK_HZ) < 25.0);
}

/// A whisker that was turned while its motor was off comes back no faster than it whisks and
/// approaches its setpoint.
#[test]
fn a_whisker_sets_off_softly_from_where_it_is() {
    let scene = free_with("");
    let fastest = |played: &Played| speeds_deg_s(played).into_iter().fold(0.0, f64::max);
    let sound = fastest(&undisturbed(&scene, 4 * TICK_HZ));
    let (lost, turned, back) = (2 * TICK_HZ, 2 * TICK_HZ + 400, 2 * TICK_HZ + 600);
    let played = play(&scene, 4 * TICK_HZ, |tick, run| {
        let slave = run.slave_mut(0).unwrap();
        slave.set_fault((lost..back).contains(&tick).then_some(WireFault::Silent));
        if tick == turned {
            run.motor_mut(0).unwrap().turn_to_deg(150.0);
        }
    });
    assert_eq!(faults(&played), []);
    let last = played.events.last().map(|(_, event)| *event);
    assert_eq!(last, Some(Event::SensorBack(LEFT)));
    let after = speeds_deg_s(&played).split_off(turned as usize + 1);
    let after = after.into_iter().fold(0.0, f64::max);
    assert!(after < sound + 600.0, "{after} of {sound} degrees a second");
    assert!(farthest(&played, 3 * TICK_HZ) < 25.0, "it is back");
}

/// A whisker that looks for its stop once it is armed; what is done to its motor before the first
/// tick.
fn finds(ticks: u64, befall: impl Fn(&mut SimMotor)) -> Played {
    play(&free_with(FIND), ticks, |tick, run| match tick {
        0 => befall(run.motor_mut(0).unwrap()),
        ARMED => run.arm(true),
        _ => {}
    })
}

#[test]
fn rest_is_found_wherever_a_whisker_is() {
    for start_deg in [30.0, 31.0, 50.0, 100.0, 160.0] {
        let played = finds(4 * TICK_HZ, |motor| motor.turn_to_deg(start_deg));
        assert_eq!(played.events, [], "{start_deg}");
        let mut heard = played.heard.iter().map(|(tick, _)| *tick);
        let first = heard.find(|tick| *tick > ARMED).unwrap();
        let expected = ARMED + TICK_HZ / 10..2 * TICK_HZ;
        assert!(expected.contains(&first), "heard in tick {first}");
        let error = farthest(&played, 5 * TICK_HZ / 2);
        assert!(error < 25.0, "{start_deg}: {error} from its setpoint");
        // Not as if rest were where it was.
        let lowest = angles(&played, 0).into_iter().fold(f64::MAX, f64::min);
        assert!((lowest - 30.0).abs() < 0.1, "{start_deg}: {lowest}");
    }
}

#[test]
fn homing_ends_by_a_fault_where_the_encoder_does_not_tell_the_truth() {
    for wire in [Wire::Encoder, Wire::EncoderChannels, Wire::Winding(0)] {
        let played = finds(10 * TICK_HZ, |motor| {
            motor.turn_to_deg(100.0);
            motor.cut(wire);
        });
        let found = faults(&played);
        assert_eq!(found.len(), FAULTS, "{wire:?}: {found:?}");
        let expected = match wire {
            Wire::EncoderChannels => [Fault::Runaway, Fault::Encoder],
            _ => [Fault::Encoder; 2],
        };
        let mut kinds = found.iter().map(|(_, fault)| fault);
        assert!(kinds.all(|fault| expected.contains(fault)), "{found:?}");
        assert!(found[0].0 < TICK_HZ, "{wire:?}: {found:?}");
        assert!(extent(&angles(&played, 0)) < 200.0, "{wire:?}");
    }
}

#[test]
fn homing_restarts_after_a_sensor_was_lost() {
    let scene = free_with("rest = \"find\"\n");
    let (lost, back) = (100, 400);
    let played = play(&scene, 4 * TICK_HZ, |tick, run| {
        let slave = run.slave_mut(0).unwrap();
        slave.set_fault((lost..back).contains(&tick).then_some(WireFault::Silent));
    });
    let off = &angles(&played, 0)[lost as usize + 200..back as usize];
    assert!(extent(off) < 0.01, "it is driven");
    assert!(farthest(&played, 5 * TICK_HZ / 2) < 25.0, "it whisks");
}
