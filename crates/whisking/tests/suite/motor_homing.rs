//! Homing against a stop: which way it drives, and what it takes for a stop.

use whisking::motor::{Duty, Fault, GuardConfig, GuardSettings, Homed, Homing, HomingSettings};

const TICK_HZ: f64 = 1000.0;
/// Counts a degree.
const COUNTS: i32 = 10;

fn settings() -> HomingSettings {
    HomingSettings {
        degrees_per_count: 1.0 / f64::from(COUNTS),
        duty: 0.1,
        stop_deg: 30.0,
        max_deg: 150.0,
        far_stop_deg: None,
        every_s: 30.0,
        calm: 0.05,
    }
}

fn guards() -> GuardConfig<f32> {
    let degrees_per_count = 1.0 / f64::from(COUNTS);
    GuardSettings {
        degrees_per_count,
        top_speed_deg_s: 10_000.0,
        ..GuardSettings::NONE
    }
    .build(TICK_HZ)
}

/// A whisker between a stop and another that moves by `step` counts a tick with the drive.
struct Whisker {
    stops: [i32; 2],
    start: i32,
    step: i32,
    /// Home where it was found last, if it is known.
    known: Option<i32>,
}

impl Whisker {
    fn home(
        &self,
        settings: HomingSettings,
        seen: impl Fn(i32) -> i32,
        stop: impl Fn(u32) -> i32,
    ) -> Result<(i32, u32), (Fault, u32)> {
        let (config, guards) = (settings.build(TICK_HZ), guards());
        let (mut at, mut before) = (self.start, seen(self.start));
        let mut homing = Homing::new(before, self.known);
        for tick in 1..10_000 {
            let counts = seen(at);
            match homing.step(&config, &guards, counts, counts.wrapping_sub(before)) {
                Ok(Homed::At(home)) => return Ok((home, tick)),
                Ok(Homed::Not(duty)) => {
                    assert_eq!(duty.magnitude(), Duty::from_f32(0.1).magnitude());
                    let moved = if duty.is_forward() {
                        self.step
                    } else {
                        -self.step
                    };
                    at = (at + moved).min(self.stops[1]).max(stop(tick));
                }
                Err(fault) => return Err((fault, tick)),
            }
            before = counts;
        }
        panic!("it never ends");
    }
}

/// Homes one between a stop and another that starts at a count, whose home is not known; the
/// encoder sees what `seen` makes of it.
fn home(
    stops: [i32; 2],
    start: i32,
    step: i32,
    seen: impl Fn(i32) -> i32,
) -> Result<(i32, u32), (Fault, u32)> {
    let whisker = Whisker {
        stops,
        start,
        step,
        known: None,
    };
    whisker.home(settings(), seen, |_| stops[0])
}

/// The same, where home was at a count.
fn home_again(stops: [i32; 2], start: i32, known: i32) -> Result<(i32, u32), (Fault, u32)> {
    let whisker = Whisker {
        stops,
        start,
        step: 4,
        known: Some(known),
    };
    whisker.home(settings(), |at| at, |_| stops[0])
}

#[test]
fn the_stop_is_where_it_stands_still() {
    // 20 degrees from the stop to rest, wherever the encoder began to count.
    for start in [-700, -699, -500, 0, 600] {
        let (found, _) = home([-700, 600], start, 4, |at| at).unwrap();
        assert_eq!(found, -700 + 20 * COUNTS, "{start}");
    }
    let near = i32::MAX - 100;
    let wrapped = home([-700, 600], 0, 4, |at| near.wrapping_add(at)).unwrap();
    assert_eq!(wrapped.0, near.wrapping_add(-500));
}

#[test]
fn it_does_not_press_for_long() {
    // At the stop at once: the way forward and back, and a tenth of a second of standing still.
    let (_, ticks) = home_again([0, 600], 0, 200).unwrap();
    assert!((100..150).contains(&ticks), "{ticks}");
}

#[test]
fn an_encoder_that_tells_nothing_is_a_fault() {
    assert_eq!(home([-700, 600], 0, 4, |_| 5), Err((Fault::Encoder, 200)));
    // Nor does one that flickers.
    let flickers = home([-700, 600], 0, 4, |at| at / 4 % 2);
    assert_eq!(flickers.unwrap_err().0, Fault::Encoder);
    assert_eq!(home([0, 0], 0, 4, |at| at).unwrap_err().0, Fault::Encoder);
}

#[test]
fn an_encoder_that_counts_backwards_is_a_fault() {
    // 45 degrees against the drive.
    let (fault, ticks) = home([-700, 900], 0, 4, |at| -at).unwrap_err();
    assert_eq!(fault, Fault::Runaway);
    assert!(ticks < 130, "{ticks}");
    // Near a stop it has no room to run.
    assert_eq!(
        home([-700, 100], 0, 4, |at| -at).unwrap_err().0,
        Fault::Runaway
    );
    assert_eq!(
        home([-300, 100], 0, 4, |at| -at).unwrap_err().0,
        Fault::Encoder
    );
}

#[test]
fn a_whisker_that_never_stops_is_given_up_in_time() {
    let (fault, ticks) = home([i32::MIN / 2, 600], 0, 4, |at| at).unwrap_err();
    assert_eq!((fault, ticks), (Fault::Homing, 3001));
    // Faster than the motor can be.
    let (fault, ticks) = home([-700, 600], 0, 101, |at| at).unwrap_err();
    assert_eq!((fault, ticks), (Fault::Runaway, 2));
}

#[test]
fn a_hand_is_not_the_stop() {
    let whisker = Whisker {
        stops: [-700, 600],
        start: 300,
        step: 4,
        known: None,
    };
    // It holds the whisker back from a count for two seconds, which leaves it too little range.
    for hand in [-550, -400, 0, 250] {
        let held = |tick| if tick < 2000 { hand } else { -700 };
        let (fault, ticks) = whisker.home(settings(), |at| at, held).unwrap_err();
        assert_eq!(fault, Fault::Homing, "{hand}");
        assert!(ticks < 1000, "{hand}: {ticks}");
    }
    // Nearer to the stop than the range is to the other one it is found where that is known.
    let held = |tick| if tick < 2000 { -660 } else { -700 };
    let taken = whisker.home(settings(), |at| at, held).unwrap();
    assert_eq!(taken.0, -660 + 20 * COUNTS);
    let known = HomingSettings {
        far_stop_deg: Some(160.0),
        ..settings()
    };
    assert_eq!(
        whisker.home(known, |at| at, held).unwrap_err().0,
        Fault::Homing
    );
    let sound = whisker.home(known, |at| at, |_| -700).unwrap();
    assert_eq!(sound.0, -500);
}

#[test]
fn a_range_without_its_far_stop_is_a_fault() {
    let known = HomingSettings {
        far_stop_deg: Some(160.0),
        ..settings()
    };
    for (far, is_found) in [(560, false), (571, true), (629, true), (640, false)] {
        let whisker = Whisker {
            stops: [-700, far],
            start: 0,
            step: 4,
            known: None,
        };
        let found = whisker.home(known, |at| at, |_| -700);
        assert_eq!(found.is_ok(), is_found, "{far}: {found:?}");
    }
    // An encoder that loses half its counts sees a short range.
    let halved = home([-700, 600], 0, 4, |at| at / 2);
    assert_eq!(halved.unwrap_err().0, Fault::Homing);
}

#[test]
fn a_stop_elsewhere_than_before_is_a_fault() {
    for (by, is_found) in [
        (0, true),
        (10, true),
        (-10, true),
        (11, false),
        (-11, false),
    ] {
        let found = home_again([-700, 600], 0, -500 + by);
        match found {
            Ok((home, ticks)) => {
                assert!(is_found && home == -500, "{by}: {home}");
                assert!(ticks < 320, "it does not go through its range: {ticks}");
            }
            Err((fault, _)) => assert!(!is_found && fault == Fault::LostCounts, "{by}: {fault}"),
        }
    }
    // Counts wrap.
    let whisker = Whisker {
        stops: [-700, 600],
        start: 0,
        step: 4,
        known: Some(i32::MIN + 9),
    };
    let near = i32::MAX - 100;
    let wrapped = whisker.home(
        settings(),
        |at| near.wrapping_add(at).wrapping_add(500),
        |_| -700,
    );
    assert_eq!(wrapped.unwrap_err().0, Fault::LostCounts);
}
