//! Homing against a stop: which way it drives, and what it takes for a stop.

use whisking::motor::{Duty, Fault, GuardConfig, GuardSettings, Homed, Homing, HomingSettings};

const TICK_HZ: f64 = 1000.0;
/// Counts a degree.
const COUNTS: i32 = 10;

const SETTINGS: HomingSettings = HomingSettings {
    degrees_per_count: 1.0 / COUNTS as f64,
    duty: 0.1,
    stop_deg: 30.0,
    max_deg: 150.0,
    far_stop_deg: None,
    every_s: 30.0,
    calm: 0.05,
};

const FAR_KNOWN: HomingSettings = HomingSettings {
    far_stop_deg: Some(160.0),
    ..SETTINGS
};

fn guards() -> GuardConfig<f32> {
    GuardSettings {
        degrees_per_count: SETTINGS.degrees_per_count,
        top_speed_deg_s: 10_000.0,
        ..GuardSettings::NONE
    }
    .build(TICK_HZ)
}

type Found = Result<(i32, u32), (Fault, u32)>;

/// A whisker between a stop and another that moves by `step` counts a tick with the drive.
#[derive(Clone, Copy)]
struct Whisker {
    stops: [i32; 2],
    start: i32,
    step: i32,
    /// Home where it was found last, if it is known.
    known: Option<i32>,
    settings: HomingSettings,
}

const WHISKER: Whisker = Whisker {
    stops: [-700, 600],
    start: 0,
    step: 4,
    known: None,
    settings: SETTINGS,
};

impl Whisker {
    /// What is found, and in which tick, where the encoder sees what `seen` makes of a count.
    fn home(self, seen: impl Fn(i32) -> i32) -> Found {
        self.held(seen, |_| self.stops[0])
    }

    /// The same, where something else may be the stop in a tick.
    fn held(self, seen: impl Fn(i32) -> i32, stop: impl Fn(u32) -> i32) -> Found {
        let (config, guards) = (self.settings.build(TICK_HZ), guards());
        let (mut at, mut before) = (self.start, seen(self.start));
        let mut homing = Homing::new(before, self.known);
        for tick in 1..10_000 {
            let counts = seen(at);
            match homing.step(&config, &guards, counts, counts.wrapping_sub(before)) {
                Ok(Homed::At(home)) => return Ok((home, tick)),
                Ok(Homed::Not(duty)) => {
                    assert_eq!(duty.magnitude(), Duty::from_f32(0.1).magnitude());
                    let way = if duty.is_forward() { 1 } else { -1 };
                    at = (at + way * self.step).min(self.stops[1]).max(stop(tick));
                }
                Err(fault) => return Err((fault, tick)),
            }
            before = counts;
        }
        panic!("it never ends");
    }

    fn fault(self, seen: impl Fn(i32) -> i32) -> Fault {
        self.home(seen).unwrap_err().0
    }
}

const fn as_it_is(at: i32) -> i32 {
    at
}

#[test]
fn the_stop_is_where_it_stands_still() {
    // 20 degrees from the stop to rest, wherever the encoder began to count.
    for start in [-700, -699, -500, 0, 600] {
        let (found, _) = Whisker { start, ..WHISKER }.home(as_it_is).unwrap();
        assert_eq!(found, -700 + 20 * COUNTS, "{start}");
    }
    let near = i32::MAX - 100;
    let (wrapped, _) = WHISKER.home(|at| near.wrapping_add(at)).unwrap();
    assert_eq!(wrapped, near.wrapping_add(-500));
}

#[test]
fn it_does_not_press_for_long() {
    // At the stop at once: the way forward and back, and a tenth of a second of standing still.
    let at_stop = Whisker {
        stops: [0, 600],
        known: Some(200),
        ..WHISKER
    };
    let (_, ticks) = at_stop.home(as_it_is).unwrap();
    assert!((100..150).contains(&ticks), "{ticks}");
}

#[test]
fn an_encoder_that_tells_nothing_is_a_fault() {
    assert_eq!(WHISKER.home(|_| 5), Err((Fault::Encoder, 200)));
    // Nor does one that flickers.
    assert_eq!(WHISKER.fault(|at| at / 4 % 2), Fault::Encoder);
    let stops = [0, 0];
    assert_eq!(Whisker { stops, ..WHISKER }.fault(as_it_is), Fault::Encoder);
}

#[test]
fn an_encoder_that_counts_backwards_is_a_fault() {
    // 45 degrees against the drive; near a stop it has no room to run.
    for (stops, fault, within) in [
        ([-700, 900], Fault::Runaway, 130),
        ([-700, 100], Fault::Runaway, 10_000),
        ([-300, 100], Fault::Encoder, 10_000),
    ] {
        let (found, ticks) = Whisker { stops, ..WHISKER }.home(|at| -at).unwrap_err();
        assert_eq!(found, fault, "{stops:?}");
        assert!(ticks < within, "{stops:?}: {ticks}");
    }
}

#[test]
fn a_whisker_that_never_stops_is_given_up_in_time() {
    let stops = [i32::MIN / 2, 600];
    let endless = Whisker { stops, ..WHISKER };
    assert_eq!(endless.home(as_it_is), Err((Fault::Homing, 3001)));
    // Faster than the motor can be.
    let step = 101;
    let fast = Whisker { step, ..WHISKER };
    assert_eq!(fast.home(as_it_is), Err((Fault::Runaway, 2)));
}

#[test]
fn a_hand_is_not_the_stop() {
    let start = 300;
    let whisker = Whisker { start, ..WHISKER };
    let held_at = |hand| move |tick| if tick < 2000 { hand } else { -700 };
    // It holds the whisker back from a count for two seconds, which leaves it too little range.
    for hand in [-550, -400, 0, 250] {
        let (fault, ticks) = whisker.held(as_it_is, held_at(hand)).unwrap_err();
        assert_eq!(fault, Fault::Homing, "{hand}");
        assert!(ticks < 1000, "{hand}: {ticks}");
    }
    // Nearer to the stop than the range is to the other one it is found where that is known.
    let (taken, _) = whisker.held(as_it_is, held_at(-660)).unwrap();
    assert_eq!(taken, -660 + 20 * COUNTS);
    let settings = FAR_KNOWN;
    let known = Whisker {
        settings,
        ..whisker
    };
    let refused = known.held(as_it_is, held_at(-660));
    assert_eq!(refused.unwrap_err().0, Fault::Homing);
    assert_eq!(known.home(as_it_is).unwrap().0, -500);
}

#[test]
fn a_range_without_its_far_stop_is_a_fault() {
    for (far, is_found) in [(560, false), (571, true), (629, true), (640, false)] {
        let whisker = Whisker {
            stops: [-700, far],
            settings: FAR_KNOWN,
            ..WHISKER
        };
        let found = whisker.home(as_it_is);
        assert_eq!(found.is_ok(), is_found, "{far}: {found:?}");
    }
    // An encoder that loses half its counts sees a short range.
    assert_eq!(WHISKER.fault(|at| at / 2), Fault::Homing);
}

#[test]
fn a_stop_elsewhere_than_before_is_a_fault() {
    let at = |known| {
        let known = Some(known);
        Whisker { known, ..WHISKER }
    };
    for by in [0, 10, -10] {
        let (home, ticks) = at(-500 + by).home(as_it_is).unwrap();
        assert_eq!(home, -500, "{by}");
        assert!(ticks < 320, "it does not go through its range: {ticks}");
    }
    for by in [11, -11] {
        assert_eq!(at(-500 + by).fault(as_it_is), Fault::LostCounts, "{by}");
    }
    // Counts wrap.
    let near = i32::MAX - 100;
    let wrapping = |at: i32| near.wrapping_add(at).wrapping_add(500);
    assert_eq!(at(i32::MIN + 9).fault(wrapping), Fault::LostCounts);
}
