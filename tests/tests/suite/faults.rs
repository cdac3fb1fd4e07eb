//! Sensors that fail while the module runs: short faults are bridged, long ones
//! switch the motor of that whisker off, nothing else suffers, and nothing is decided. Among them
//! are frames that are good in themselves and yet are no readings of a whisker: frozen, jumping,
//! stuck, or too often missing.

use crate::common::project;
use crate::played::{
    HOLD, RECOVER, TICK_HZ, angles, apart, extent, free, is_unaffected, lost, play, play_once,
    scene, setpoints, textured, undisturbed,
};
use firmware::design_parameters::{Plausible, sensor_limits};
use firmware::{Event, Place, SensorFault};
use host_sim::bus::{Slave, WireFault};
use host_sim::loaded::Loaded;
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

/// Ticks of `frozen_s` by default.
const FROZEN: u64 = TICK_HZ / 4;
/// Where no whisker gets in a tick.
const FAR: WireFault = WireFault::Shift(0x7000);
/// After how many ticks faults are too many, at least and at most.
const SOON: [u64; 2] = [HOLD, TICK_HZ / 10];

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

/// A line that is so from [`AMID`] on, in every tick or every second one; what it is found to be,
/// after how many ticks, and how many before [`RECOVER`] good ones its sensor is back: the first
/// good one counts, or comes some ticks after a bad one. A data line that is held low from the
/// second byte on has the right sum.
#[test]
fn long_faults_switch_the_motor_off_until_the_sensor_is_back() {
    let scene = free(1);
    let (mended, length) = (AMID + 2 * TICK_HZ, AMID + 3 * TICK_HZ);
    let sound = undisturbed(&scene, length);
    let of_wire = WIRE.map(|(line, code)| (line, 1, code, None, [HOLD; 2], 1..=1));
    let other = |line, every, fault: SensorFault, after| {
        (line, every, fault.code(), Some(fault), after, 0..=every)
    };
    let stuck = SensorFault::Frame(FrameError::StuckWords);
    for (line, every, code, fault, [least, most], early) in of_wire.into_iter().chain([
        other(WireFault::Frozen, 1, SensorFault::Frozen, [FROZEN; 2]),
        other(WireFault::LowAfterStart, 1, stuck, [HOLD; 2]),
        other(FAR, 2, SensorFault::Jump, SOON),
        other(WireFault::Silent, 2, SensorFault::Often(18), SOON),
    ]) {
        let played = play(&scene, length, |tick, run| {
            let is_so = (AMID..mended).contains(&tick) && tick % every == 0;
            slave(run, 0).set_fault(is_so.then_some(line));
        });
        let (off, found, back) = lost(&played);
        assert_eq!(found.code(), code, "{line:?}");
        assert!(fault.is_none_or(|fault| fault == found), "{found:?}");
        assert!((least..=most).contains(&(off - AMID)), "{line:?}: {off}");
        let back = back.unwrap();
        assert!(
            early.contains(&(mended + RECOVER - back)),
            "{line:?}: {back}"
        );

        // Off: friction and the shorted winding stop it, though θ' goes on.
        let rest = off as usize + 200..mended as usize;
        let course = angles(&played, 0);
        let driven = extent(&course[rest.clone()]);
        assert!(driven < 0.01, "{line:?}: {driven}");
        assert!(extent(&setpoints(&played)[rest]) > 40.0);
        // A repeat counts for as long as a reading is held, and then none does.
        let none = if every == 1 { AMID + HOLD } else { off };
        let mut heard = played.heard.iter();
        assert!(!heard.any(|(tick, _)| (none..mended).contains(tick)));

        // Back: within 0.3 s it whisks as if nothing had been.
        let again = back as usize + 600..;
        let expected = angles(&sound, 0);
        assert!(extent(&course[again.clone()]) > 40.0);
        let apart = apart(&course[again.clone()], &expected[again]);
        assert!(apart < 0.2, "{line:?}");
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

#[test]
fn one_jump_is_bridged() {
    let once = play(&free(1), AMID + 400, |tick, run| {
        slave(run, 0).set_fault((tick == AMID).then_some(FAR));
    });
    assert_eq!(once.events, []);
    let [before, after] = [AMID - 1, AMID].map(|tick| once.heard[tick as usize].1);
    assert_eq!(before, after, "the reading before it is held");
}

/// A sensor without noise above its resolution, before nothing and where nothing moves.
#[test]
fn sensors_that_have_nothing_to_feel_are_not_frozen() {
    let passive = "name = \"still\"\ntick_hz = 2000\nduration_s = 5\nseed = 1\n\
                   [head]\nwhiskers_per_side = 1\n[plant]\nkind = \"ideal\"\n";
    let passive = Scene::from_str("still.toml", passive).unwrap();
    for scene in [passive, scene(1, "kind = \"ideal\"\n", "")] {
        let played = undisturbed(&scene, 5 * TICK_HZ);
        assert_eq!(played.events, []);
    }
}

/// A whisker that is bent as far and as fast as one can be is believed.
#[test]
fn no_contact_is_a_jump() {
    for shaft in ["biotact-front", "biotact-middle", "biotact-rear"] {
        let plant = textured(100.0).replace("\"textured\"", "\"whisker\"");
        let scene = scene(1, &format!("{plant}shaft = \"{shaft}\"\n"), "");
        let played = undisturbed(&scene, 10 * TICK_HZ);
        assert_eq!(played.events, [], "{shaft}");
        let jumps = played.rows.windows(2);
        let largest = jumps.map(|rows| (rows[1].x[0] - rows[0].x[0]).abs());
        let largest = largest.fold(0.0, f64::max);
        assert!(largest > 500.0, "{shaft} is hardly touched: {largest}");
        // Nine tenths of the limit at this rate.
        assert!(largest < 5_530.0, "{shaft}: {largest}");
        let heard = played.heard.len() as u64;
        assert_eq!(heard, 10 * TICK_HZ, "{shaft}: a frame was not believed");
        let sent = |tick: &u64| played.rows[*tick as usize].x[0] as u16;
        let taken = played.heard.iter();
        assert!(taken.clone().all(|(tick, codes)| codes[0] == sent(tick)));
    }
}

/// The main job with the left sensor frozen, or its line low after the first byte, at any
/// point of a whisk: no decision later than a reading is held.
#[test]
fn nothing_is_decided_by_readings_that_are_none() {
    let path = project("scenes/textures.toml");
    let loaded = Loaded::new(&path).unwrap();
    for fault in [WireFault::Frozen, WireFault::LowAfterStart] {
        for start in (0..10).map(|n| 3 * TICK_HZ + n * 107) {
            let mut run = Run::new(&loaded.scene, loaded.classifier().unwrap()).unwrap();
            let (mut sound, mut late) = (0, Vec::new());
            for tick in 0..start + 4 * TICK_HZ {
                slave(&mut run, 0).set_fault((tick >= start).then_some(fault));
                run.tick();
                let decided = |event: &&Event| matches!(event, Event::Decision(..));
                if run.events().iter().find(decided).is_some() {
                    sound += u32::from(tick < start);
                    if tick >= start + HOLD {
                        late.push(tick - start);
                    }
                }
            }
            assert!(sound > 5, "{sound} decisions before");
            assert_eq!(late, [], "{fault:?} at {start}");
        }
    }
}
