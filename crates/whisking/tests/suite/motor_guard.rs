//! The guards of a motor's motion by themselves, each against what it says of itself.

use proptest::prelude::*;
use whisking::motor::{
    Duty, FOLLOWING_S, Fault, GuardConfig, GuardSettings, Guards, Heat, ModelSettings, Moved,
    STALL_S,
};

/// A tenth of a degree a count, 2000 ticks a second.
const SETTINGS: GuardSettings = GuardSettings {
    degrees_per_count: 0.1,
    hard_duty: 0.5,
    model: None,
    following_deg: 30.0,
    top_speed_deg_s: 10_000.0,
    travel_deg: [30.0, 160.0],
    continuous_duty: 0.25,
};
const MODEL: ModelSettings = ModelSettings {
    speed_deg_s: 12_000.0,
    time_constant_s: 0.048,
    friction_duty: 0.06,
    duty_limit: 1.0,
    slew_per_s: 400.0,
};
const TICK_HZ: f64 = 2000.0;
/// Ticks of the two durations.
const FOLLOWING: usize = (FOLLOWING_S * TICK_HZ) as usize;
const STALL: usize = (STALL_S * TICK_HZ) as usize;
const HARD: Duty = Duty::from_q15(20_000);

fn config() -> GuardConfig<f64> {
    SETTINGS.build(TICK_HZ)
}

/// The tick, from 0, in which a guard trips, and its fault: of duty, error, angle and
/// movement by tick.
fn trips(ticks: usize, motion: impl Fn(usize) -> (Duty, f64, i32, i32)) -> Option<(usize, Fault)> {
    let mut guards = Guards::default();
    (0..ticks).find_map(|tick| {
        let (duty, error, at, moved) = motion(tick);
        let found = guards.check(&config(), seen(duty, error, at, moved));
        found.err().map(|fault| (tick, fault))
    })
}

/// A tick, of whose velocity nothing is asked.
fn seen(duty: Duty, error: f64, at: i32, counts: i32) -> Moved<f64> {
    Moved {
        duty: i32::from(duty.q15()) << 9,
        error,
        velocity: 0.0,
        at,
        counts,
    }
}

fn reversed(duty: Duty) -> Duty {
    Duty::from_q15(-duty.q15())
}

#[test]
fn a_following_error_may_last_so_long() {
    // 30 degrees are 0.3.
    assert_eq!(trips(1000, |_| (Duty::ZERO, 0.3, 0, 0)), None);
    for error in [0.301, -0.301] {
        let found = trips(1000, |_| (Duty::ZERO, error, 0, 0));
        assert_eq!(found, Some((FOLLOWING, Fault::Following)));
        // A tick within it, and it begins again.
        let found = trips(1000, |tick| {
            let error = if tick == 50 { 0.0 } else { error };
            (Duty::ZERO, error, 0, 0)
        });
        assert_eq!(found, Some((51 + FOLLOWING, Fault::Following)));
    }
}

#[test]
fn an_angle_beyond_its_travel_is_a_fault_at_once() {
    // Rest is 50 degrees: 200 counts down, 1100 up.
    for (at, fault) in [
        (-200, None),
        (1100, None),
        (-201, Some((0, Fault::Travel))),
        (1101, Some((0, Fault::Travel))),
        (i32::MIN, Some((0, Fault::Travel))),
        (i32::MAX, Some((0, Fault::Travel))),
    ] {
        assert_eq!(trips(1, |_| (Duty::ZERO, 0.0, at, 0)), fault, "{at}");
    }
}

#[test]
fn what_moves_against_the_drive_or_too_fast_runs_away() {
    // 45 degrees are 450 counts: at 10 a tick in the 46th. Turning the drive round and
    // moving against it again is the same.
    for turns in [usize::MAX, 7] {
        let found = trips(1000, |tick| {
            let forward = tick / turns % 2 == 0;
            let duty = if forward { HARD } else { reversed(HARD) };
            (duty, 0.0, 0, if forward { -10 } else { 10 })
        });
        assert_eq!(found, Some((45, Fault::Runaway)), "{turns}");
    }
    // With the drive, or against a soft one: nothing.
    for duty in [HARD, Duty::from_q15(-16_000)] {
        assert_eq!(trips(1000, |_| (duty, 0.0, 0, 10)), None);
    }
    // 5 degrees a tick are 10,000 a second: 50 counts.
    assert_eq!(trips(1, |_| (HARD, 0.0, 0, 50)), None);
    for moved in [51, -51, i32::MIN, i32::MAX] {
        let found = trips(1, |_| (Duty::ZERO, 0.0, 0, moved));
        assert_eq!(found, Some((0, Fault::Runaway)));
    }
}

#[test]
fn standing_still_is_a_stall_one_way_and_a_silent_encoder_both_ways() {
    for duty in [HARD, reversed(HARD)] {
        // A rotor on an edge flickers by a count.
        let found = trips(1000, |tick| (duty, 0.0, 0, [1, -1][tick % 2]));
        assert_eq!(found, Some((STALL - 1, Fault::Stall)));
    }
    // 8 Hz: the drive turns round every 125 ticks, and is hard in two thirds of them.
    let found = trips(1000, |tick| {
        let hard = tick % 125 < 83;
        let duty = [HARD, reversed(HARD)][tick / 125 % 2];
        (if hard { duty } else { Duty::ZERO }, 0.0, 0, 0)
    });
    // Four stretches of 83, and 68 of the fifth.
    assert_eq!(found, Some((500 + STALL - 4 * 83 - 1, Fault::Encoder)));
    // Pushing slowly: three counts in a hundred ticks.
    let slow = |tick: usize| (HARD, 0.0, 0, i32::from(tick.is_multiple_of(33)));
    assert_eq!(trips(20_000, slow), None);
}

#[test]
fn a_winding_bears_its_continuous_duty_for_ever_and_no_more() {
    let hot = |q15: i16, ticks: usize| {
        let mut heat = Heat::default();
        let duty = Duty::from_q15(q15);
        (0..ticks).find(|_| heat.check(&config(), duty).is_err())
    };
    assert_eq!(hot(8_191, 2_000_000), None);
    assert!(hot(8_400, 2_000_000).is_some());
    // Of full duty: −τ ln(1 − 0.25²), τ = 2^14 ticks.
    let closed = -f64::from(1 << 14) * (1.0_f64 - 0.0625).ln();
    for q15 in [i16::MAX, -i16::MAX] {
        let found = hot(q15, 2_000_000).unwrap() as f64;
        assert!((found / closed - 1.0).abs() < 0.01, "{found} {closed}");
    }
}

proptest! {
    /// Nothing that a motor, an encoder or a bit that flips can give makes a guard panic.
    #[test]
    fn no_motion_is_too_much(
        motion in proptest::collection::vec(
            (any::<i32>(), any::<f32>(), any::<f32>(), any::<i32>(), any::<i32>()), 1..200
        ),
        shift: u8,
    ) {
        let model = Some(MODEL);
        let settings = GuardSettings { model, ..SETTINGS };
        let config = GuardConfig { heat_shift: shift, ..settings.build::<f32>(TICK_HZ) };
        let (mut guards, mut heat) = (Guards::default(), Heat::default());
        for (duty, error, velocity, at, counts) in motion {
            let seen = Moved { duty, error, velocity, at, counts };
            let _ = guards.check(&config, seen);
            let _ = heat.check(&config, Duty::from_q15(duty as i16));
        }
    }
}
