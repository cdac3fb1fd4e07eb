//! A noisy line: frames lost and bits inverted at random, for as long as the
//! module runs.

use crate::played::{
    HOLD, Played, TICK_HZ, angles, apart, extent, free, play_once, scene, textured, undisturbed,
};
use firmware::Event;
use firmware::design_parameters::{Plausible, sensor_limits};

/// What the module took for the readings of the left whisker, tick by tick:
/// frames as they were, frames bridged, and what no sensor sent.
fn readings(played: &Played) -> [usize; 3] {
    let mut counts = [0; 3];
    let mut last = [8192; 2];
    for (tick, heard) in &played.heard {
        let row = &played.rows[*tick as usize];
        let sent = [row.x[0] as u16, row.y[0] as u16];
        let kind = if *heard == sent {
            0
        } else if *heard == last {
            1
        } else {
            2
        };
        counts[kind] += 1;
        last = *heard;
    }
    counts
}

/// In the worst of bearable air: one frame in a hundred is lost, another has a
/// bit inverted.
#[test]
fn a_disturbed_line_is_borne() {
    let rcp = "[rcp]\ngain = 0.7\ntau_s = 0.0625\n";
    let scene = scene(1, &textured(100.0), rcp);
    let length = 20 * TICK_HZ;
    let disturbed = |lost, flipped| {
        play_once(&scene, length, 0, |run| {
            for (n, seed) in (0..2).zip(1..) {
                run.slave_mut(n).unwrap().disturb(lost, flipped, seed);
            }
        })
    };
    let sound = undisturbed(&scene, length);
    assert_eq!(readings(&sound), [length as usize, 0, 0]);

    let played = disturbed(0.01, 0.01);
    assert_eq!(played.events, []);
    let [taken, bridged, invented] = readings(&played);
    println!("{taken} readings taken, {bridged} bridged, {invented} that no sensor sent");
    assert_eq!(invented, 0);
    // After a bad frame the sensor is left alone for some ticks, which are bridged too.
    let alone = f64::from(sensor_limits(TICK_HZ as u32, Plausible::ANY).resync);
    let bad = bridged as f64 / (taken as f64 * (1.0 + alone) + bridged as f64);
    assert!((0.017..0.023).contains(&bad), "{bad}");
    // It whisks on as it would have: contact is late by some ticks at most.
    for side in 0..2 {
        let apart = apart(&angles(&played, side), &angles(&sound, side));
        println!("side {side}: at most {apart:.2} degrees off the undisturbed course");
        assert!(apart < 1.0, "{apart}");
    }
    for row in &played.rows {
        let values = row.pairs();
        assert!(values.as_flattened().iter().all(|value| value.is_finite()));
    }

    // One bit inverted in every frame: none is believed.
    let [taken, bridged, invented] = readings(&disturbed(0.0, 1.0));
    assert_eq!([taken + bridged, invented], [HOLD as usize, 0]);
}

/// Half of all frames bad: lost once, and not up and down from then on.
#[test]
fn a_line_that_is_mostly_noise_is_given_up_once() {
    let played = play_once(&free(1), 10 * TICK_HZ, 0, |run| {
        (0..2).for_each(|n| run.slave_mut(n).unwrap().disturb(0.3, 0.3, 5));
    });
    let lost = |(_, event): &(u64, Event)| matches!(event, Event::SensorLost(..));
    assert_eq!(played.events.len(), 2, "{:?}", played.events);
    assert!(played.events.iter().all(lost));
    let course = angles(&played, 0);
    assert!(extent(&course[course.len() / 2..]) < 0.01);
}
