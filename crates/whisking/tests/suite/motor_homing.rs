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

/// Homes a whisker that moves by `step` counts a tick with the drive, between a stop and
/// another, and starts at a count; the encoder sees what `seen` makes of it.
fn home(
    [stop, other]: [i32; 2],
    start: i32,
    step: i32,
    seen: impl Fn(i32) -> i32,
) -> Result<(i32, u32), (Fault, u32)> {
    let (config, guards) = (settings().build(TICK_HZ), guards());
    let (mut at, mut before) = (start, seen(start));
    let mut homing = Homing::new(before);
    for tick in 1..10_000 {
        let counts = seen(at);
        match homing.step(&config, &guards, counts, counts - before) {
            Ok(Homed::At(home)) => return Ok((home, tick)),
            Ok(Homed::Not(duty)) => {
                assert_eq!(duty.magnitude(), Duty::from_f32(0.1).magnitude());
                let moved = if duty.is_forward() { step } else { -step };
                at = (at + moved).clamp(stop, other);
            }
            Err(fault) => return Err((fault, tick)),
        }
        before = counts;
    }
    panic!("it never ends");
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
    let (_, ticks) = home([0, 600], 0, 4, |at| at).unwrap();
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
