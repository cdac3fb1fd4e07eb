//! Sensors that fail while the module runs: short faults are bridged, long ones
//! switch the motor of that whisker off, and nothing else suffers.

use crate::played::{
    HOLD, RECOVER, TICK_HZ, angles, apart, extent, free, is_unaffected, lost, play, play_once,
    scene, setpoints, undisturbed,
};
use firmware::design_parameters::{Plausible, sensor_limits};
use firmware::{Event, Place, SensorFault};
use host_sim::bus::{Slave, WireFault};
use host_sim::run::Run;
use mlx90333::{Faults, FrameError};
use scene::Scene;

/// Bad frames in succession that are bridged: each takes a tick, and those after it in which
/// the sensor is left alone.
const FRAMES: u64 = {
    let limits = sensor_limits(TICK_HZ as u32, Plausible::ANY);
    HOLD / (1 + limits.resync as u64)
};

/// A tick at which the left side protracts fastest, at 0.35 degrees a tick.
const AMID: u64 = 1440;

/// Every fault of the wire with the number of its report.
const WIRE: [(WireFault, u8); 8] = [
    (WireFault::Silent, 18),
    (WireFault::LineLow, 19),
    (WireFault::BadSum, 21),
    (WireFault::Bus, 17),
    (WireFault::Flip(0), 20),
    (WireFault::Flip(8), 21),
    (WireFault::Flip(47), 21),
    (WireFault::Flip(63), 21),
];

/// θ' exactly, before obstacles on both sides.
fn touching() -> Scene {
    let plant = "kind = \"ideal\"\nobstacle_deg = [60.0, 60.0]\nstiffness = 0.02\n";
    scene(1, plant, "")
}

fn slave(run: &mut Run, n: usize) -> &mut Slave {
    run.slave_mut(n).unwrap()
}

#[test]
fn short_faults_are_bridged() {
    let scene = free(1);
    let length = AMID + 1000;
    let sound = undisturbed(&scene, length);
    let course = angles(&sound, 0);
    for (fault, _) in WIRE {
        for frames in [1, FRAMES] {
            let played = play_once(&scene, length, AMID, |run| {
                slave(run, 0).inject(fault, frames as u32);
            });
            assert_eq!(played.events, [], "{fault:?}");
            let found = angles(&played, 0);
            let bad = &found[AMID as usize..][..HOLD as usize];
            assert!(extent(bad) > 3.0, "{fault:?}: the motor stopped");
            assert!(apart(&found, &course) < 0.05, "{fault:?}");
            is_unaffected(&played, &sound, 1);
        }
    }
    let played = play(&scene, length, |tick, run| match tick {
        AMID => slave(run, 0).set_error_word(Faults::FIELD_TOO_LOW),
        _ if tick == AMID + HOLD => slave(run, 0).set_error_word(Faults::NONE),
        _ => {}
    });
    assert_eq!(played.events, []);
    assert!(apart(&angles(&played, 0), &course) < 0.05);
}

#[test]
fn long_faults_switch_the_motor_off_until_the_sensor_is_back() {
    let scene = free(1);
    let (mended, length) = (AMID + 1000, AMID + 2000);
    let sound = undisturbed(&scene, length);
    for (fault, code) in WIRE {
        let played = play(&scene, length, |tick, run| match tick {
            AMID => slave(run, 0).set_fault(Some(fault)),
            _ if tick == mended => slave(run, 0).set_fault(None),
            _ => {}
        });
        let (off, back) = (AMID + HOLD, mended + RECOVER - 1);
        let (first, found, second) = lost(&played);
        let found = (first, second, found.code());
        assert_eq!(found, (off, Some(back), code), "{fault:?}");

        // Off: friction and the shorted winding stop it, though θ' goes on.
        let off = off as usize + 200..back as usize;
        let course = angles(&played, 0);
        let driven = extent(&course[off.clone()]);
        assert!(driven < 0.01, "{fault:?}: {driven}");
        assert!(extent(&setpoints(&played)[off]) > 40.0);

        // Back: within 0.3 s it whisks as if nothing had been.
        let again = back as usize + 600..;
        let expected = angles(&sound, 0);
        assert!(extent(&course[again.clone()]) > 40.0);
        let apart = apart(&course[again.clone()], &expected[again]);
        assert!(apart < 0.2, "{fault:?}");
        is_unaffected(&played, &sound, 1);
    }
}

#[test]
fn the_sensor_s_own_report_is_logged_bit_by_bit() {
    let scene = touching();
    for bit in 0..16 {
        let faults = Faults::new(1 << bit);
        let played = play(&scene, 400, |tick, run| match tick {
            200 => slave(run, 1).set_error_word(faults),
            300 => slave(run, 1).set_error_word(Faults::NONE),
            _ => {}
        });
        let place = Place::new(1, 0);
        let fault = SensorFault::Frame(FrameError::Sensor(faults));
        assert_eq!(fault.code(), 22);
        let expected = [
            (200 + HOLD, Event::SensorLost(place, fault)),
            (300 + RECOVER - 1, Event::SensorBack(place)),
        ];
        assert_eq!(played.events, expected);
        // With the frame as it came, which has the report in B5 and B6.
        let [(tick, of, frame)] = played.frames[..] else {
            panic!("{:?}", played.frames);
        };
        assert_eq!((tick, of), (200 + HOLD, place));
        assert_eq!([frame[5], frame[6]], faults.bits().to_le_bytes());
    }
}

/// With motors that are exact, so that only contact shows the fault.
#[test]
fn a_faulty_sensor_feels_nothing() {
    let scene = touching();
    let sound = undisturbed(&scene, 2000);
    let start = sound.rows.iter().position(|row| row.contact[0] > 0.5);
    let start = start.unwrap() as u64;
    for (fault, code) in WIRE {
        let played = play(&scene, 2000, |tick, run| match tick {
            _ if tick == start => slave(run, 0).set_fault(Some(fault)),
            _ if tick == start + 300 => slave(run, 0).set_fault(None),
            _ => {}
        });
        let (_, found, back) = lost(&played);
        assert_eq!((found.code(), back.is_some()), (code, true), "{fault:?}");
        let contact = |tick: u64| played.rows[tick as usize].contact[0];
        // The last good reading is held, then there is none, and contact starts from zero.
        let (lost, back) = (start + HOLD, start + 300 + RECOVER - 1);
        assert!(contact(lost - 1) > 0.5);
        assert!((lost..back).all(|tick| contact(tick) == 0.0), "{fault:?}");
        assert!((lost..lost + 100).all(|tick| sound.rows[tick as usize].contact[0] > 0.5));
        is_unaffected(&played, &sound, 1);
        // The classifier gets nothing while the sensor is not believed.
        let mut heard = played.heard.iter();
        assert!(!heard.any(|(tick, _)| (lost..back).contains(tick)));
        assert_eq!(played.heard.len() as u64, 2000 - (300 - HOLD + RECOVER - 1));
    }
}

#[test]
fn one_of_twenty_four_leaves_the_others_alone() {
    let scene = free(12);
    let sound = undisturbed(&scene, 2000);
    let played = play_once(&scene, 2000, AMID, |run| {
        slave(run, 7).set_fault(Some(WireFault::Silent));
    });
    let place = Place::new(0, 7);
    let fault = SensorFault::Frame(FrameError::NoSensor);
    let expected = [(AMID + HOLD, Event::SensorLost(place, fault))];
    assert_eq!(played.events, expected);
    assert!(apart(&angles(&played, 0), &angles(&sound, 0)) < 0.2);
    is_unaffected(&played, &sound, 1);
}

#[test]
fn all_of_twenty_four_fail_and_come_back() {
    let set = |fault: Option<WireFault>| {
        move |run: &mut Run| {
            (0..24).for_each(|n| slave(run, n).set_fault(fault));
            assert!(run.slave_mut(24).is_none());
        }
    };
    let played = play(&free(12), 1500, |tick, run| match tick {
        500 => set(Some(WireFault::LineLow))(run),
        1000 => set(None)(run),
        _ => {}
    });
    let fault = SensorFault::Frame(FrameError::LineLow);
    let places = || (0..2).flat_map(|side| (0..12).map(move |whisker| Place { side, whisker }));
    let lost = places().map(|place| (500 + HOLD, Event::SensorLost(place, fault)));
    let back = places().map(|place| (1000 + RECOVER - 1, Event::SensorBack(place)));
    assert_eq!(played.events, lost.chain(back).collect::<Vec<_>>());
}
