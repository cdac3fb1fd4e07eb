//! Frames that are good in themselves and yet are no readings of a whisker: frozen, jumping,
//! stuck, or too often missing. The motor goes off, and nothing is decided.

use crate::played::{
    HOLD, Played, RECOVER, TICK_HZ, angles, extent, free, lost, play, scene, textured, undisturbed,
};
use firmware::{Event, SensorFault};
use host_sim::bus::{Slave, WireFault};
use host_sim::loaded::Loaded;
use host_sim::run::Run;
use mlx90333::FrameError;
use scene::Scene;

/// Ticks of `frozen_s` by default.
const FROZEN: u64 = TICK_HZ / 4;
/// When a fault begins, while the left side protracts.
const START: u64 = 1440;

fn slave(run: &mut Run) -> &mut Slave {
    run.slave_mut(0).unwrap()
}

fn befallen(scene: &Scene, length: u64, fault: impl Fn(u64) -> Option<WireFault>) -> Played {
    play(scene, length, |tick, run| slave(run).set_fault(fault(tick)))
}

#[track_caller]
fn is_off(played: &Played, ticks: std::ops::Range<u64>) {
    let course = angles(played, 0);
    let off = &course[ticks.start as usize + 200..ticks.end as usize];
    assert!(extent(off) < 0.01, "it is driven");
}

#[test]
fn frozen_frames_are_a_fault_until_they_change() {
    let (scene, mended, length) = (free(1), START + 2 * TICK_HZ, START + 3 * TICK_HZ);
    let frozen = |tick| (START..mended).contains(&tick).then_some(WireFault::Frozen);
    let played = befallen(&scene, length, frozen);
    let (tick, fault, back) = lost(&played);
    assert_eq!((tick, fault), (START + FROZEN, SensorFault::Frozen));
    assert_eq!(back, Some(mended + RECOVER - 1));
    is_off(&played, tick..mended);
    // A repeat counts for as long as a reading is held, and then none does.
    let is_lost = START + HOLD..mended;
    let heard = played.heard.iter();
    assert_eq!(heard.filter(|(tick, _)| is_lost.contains(tick)).count(), 0);
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

/// The data line held low from the second byte on: the sum is right.
#[test]
fn a_line_that_is_low_after_the_first_byte_is_no_reading() {
    let low = |tick| (tick >= START).then_some(WireFault::LowAfterStart);
    let played = befallen(&free(1), START + TICK_HZ, low);
    let (tick, fault, _) = lost(&played);
    let stuck = SensorFault::Frame(FrameError::StuckWords);
    assert_eq!((tick, fault), (START + HOLD, stuck));
    is_off(&played, tick..START + TICK_HZ);
}

/// One jump is bridged; what jumps about for 0.1 s is no whisker.
#[test]
fn jumps_are_bridged_and_then_a_fault() {
    let scene = free(1);
    let far = WireFault::Shift(0x7000);
    let once = befallen(&scene, START + 400, |tick| (tick == START).then_some(far));
    assert_eq!(once.events, []);
    let [before, after] = [START - 1, START].map(|tick| once.heard[tick as usize].1);
    assert_eq!(before, after, "the reading before it is held");

    let about = |tick| (tick >= START && tick % 2 == 0).then_some(far);
    let played = befallen(&scene, START + TICK_HZ, about);
    let (tick, fault, _) = lost(&played);
    assert_eq!(fault, SensorFault::Jump);
    assert!(tick - START < TICK_HZ / 10, "{tick}");
    is_off(&played, tick..START + TICK_HZ);
}

#[test]
fn a_line_that_loses_every_second_frame_is_a_fault() {
    let every_second = |tick| (tick >= START && tick % 2 == 0).then_some(WireFault::Silent);
    let played = befallen(&free(1), START + TICK_HZ, every_second);
    let (tick, fault, _) = lost(&played);
    assert_eq!(fault, SensorFault::Often(18));
    assert!(tick - START < TICK_HZ / 10, "{tick}");
    is_off(&played, tick..START + TICK_HZ);
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
    let path = crate::common::project("scenes/textures.toml");
    let loaded = Loaded::new(&path).unwrap();
    for fault in [WireFault::Frozen, WireFault::LowAfterStart] {
        for start in (0..10).map(|n| 3 * TICK_HZ + n * 107) {
            let mut run = Run::new(&loaded.scene, loaded.classifier().unwrap()).unwrap();
            let (mut sound, mut late) = (0, Vec::new());
            for tick in 0..start + 4 * TICK_HZ {
                slave(&mut run).set_fault((tick >= start).then_some(fault));
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
