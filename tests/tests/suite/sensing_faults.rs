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
/// Where no whisker gets in a tick.
const FAR: WireFault = WireFault::Shift(0x7000);
/// After how many ticks faults are too many, at least and at most.
const SOON: [u64; 2] = [HOLD, TICK_HZ / 10];

fn slave(run: &mut Run) -> &mut Slave {
    run.slave_mut(0).unwrap()
}

fn befallen(scene: &Scene, length: u64, fault: impl Fn(u64) -> Option<WireFault>) -> Played {
    play(scene, length, |tick, run| slave(run).set_fault(fault(tick)))
}

/// A line that is so from [`START`] on, in every tick or every second one; what it is found to be,
/// and after how many ticks. A data line that is held low from the second byte on has the right
/// sum.
#[test]
fn what_is_no_reading_switches_the_motor_off_until_it_is_one() {
    let (scene, mended, length) = (free(1), START + 2 * TICK_HZ, START + 3 * TICK_HZ);
    let stuck = SensorFault::Frame(FrameError::StuckWords);
    for (line, every, found, [least, most]) in [
        (WireFault::Frozen, 1, SensorFault::Frozen, [FROZEN; 2]),
        (WireFault::LowAfterStart, 1, stuck, [HOLD; 2]),
        (FAR, 2, SensorFault::Jump, SOON),
        (WireFault::Silent, 2, SensorFault::Often(18), SOON),
    ] {
        let played = befallen(&scene, length, |tick| {
            let is_so = (START..mended).contains(&tick) && tick % every == 0;
            is_so.then_some(line)
        });
        let (tick, fault, back) = lost(&played);
        assert_eq!(fault, found);
        let after = tick - START;
        assert!((least..=most).contains(&after), "{line:?}: {after}");
        // The first good one counts, or comes some ticks after a bad one.
        let expected = mended + RECOVER - every..=mended + RECOVER;
        assert!(expected.contains(&back.unwrap()), "{line:?}: {back:?}");
        let course = angles(&played, 0);
        let off = &course[tick as usize + 200..mended as usize];
        assert!(extent(off) < 0.01, "{line:?}: it is driven");
        // A repeat counts for as long as a reading is held, and then none does.
        let none = if every == 1 { START + HOLD } else { tick };
        let mut heard = played.heard.iter();
        assert!(!heard.any(|(tick, _)| (none..mended).contains(tick)));
    }
}

#[test]
fn one_jump_is_bridged() {
    let once = befallen(&free(1), START + 400, |tick| (tick == START).then_some(FAR));
    assert_eq!(once.events, []);
    let [before, after] = [START - 1, START].map(|tick| once.heard[tick as usize].1);
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
