//! A module whose whiskers have TMAG5170s: it feels what they are bent by, as noisily as such a
//! sensor does.

use crate::played::{play_once, scene, textured, undisturbed};
use firmware::Event;
use host_sim::bus::tmag5170::LineFault;
use scene::Scene;

fn tilted() -> Scene {
    let more = "[rcp]\ngain = 0.7\ntau_s = 0.0625\n[sensor]\nmodel = \"tmag5170\"\n";
    scene(1, &textured(90.0), more)
}

/// RMS of the noise of x, codes: two fields of 0.025 √(32/4) mT, of which that along Z counts
/// by the tilt alone, on 60 mT, and a full scale of 0.15 in 8191 codes.
const NOISE: f64 = 2.0 * 0.025 * 2.828_427 / 60.0 / 0.15 * 8191.0;

#[test]
fn it_feels_what_it_is_bent_by() {
    let played = undisturbed(&tilted(), 8000);
    assert!(played.events.is_empty(), "{:?}", played.events);
    let (mut bent, mut rest, mut product, mut square) = (0_u32, Vec::new(), 0.0, 0.0);
    for (tick, codes) in &played.heard {
        let row = &played.rows[*tick as usize];
        let given = [row.x[0], row.y[0]].map(|code| code - 8192.0);
        let [x, y] = codes.map(|code| f64::from(code) - 8192.0);
        // The first ticks configure the sensor.
        if *tick < 10 {
            continue;
        }
        if given[0].abs() > 2000.0 && given[0].abs() < 7000.0 {
            bent += 1;
            product += x * given[0];
            square += given[0] * given[0];
        } else if given.iter().all(|code| code.abs() < 500.0) {
            rest.push([x - given[0], y - given[1]]);
        }
    }
    assert!(bent > 500 && rest.len() > 500, "{bent} {}", rest.len());
    // tan(0.15) is 0.8 % more than 0.15, and a sensor with the wrong sign has −1.
    let gain = product / square;
    assert!((gain - 1.004).abs() < 0.01, "{gain}");
    for axis in 0..2 {
        let of_axis = rest.iter().map(|codes| codes[axis] * codes[axis]);
        let rms = (of_axis.sum::<f64>() / rest.len() as f64).sqrt();
        assert!((rms / NOISE - 1.0).abs() < 0.1, "{rms} {NOISE}");
    }
}

/// What the end of the range means is said once, as a limit, and the whisker feels nothing.
#[test]
fn a_magnet_that_is_too_near_is_a_limit_and_no_contact() {
    let played = play_once(&tilted(), 16_000, 2_000, |run| {
        let slave = run.tmag_mut(0).unwrap();
        slave.set_fault(Some(LineFault::NearField));
    });
    let said: Vec<&Event> = played.events.iter().map(|(_, event)| event).collect();
    assert_eq!(said, [&Event::Limit(36)]);
    let [(at, _)] = played.events[..] else {
        panic!("{said:?}");
    };
    let contact = |tick: u64| played.rows[tick as usize].contact[0];
    assert!((2_000..at).any(|tick| contact(tick) > 0.0));
    assert!((at + 2..16_000).all(|tick| contact(tick) == 0.0));
}
