//! Encoders that stand still, and motors that are not as the scene has them: the ones are off before
//! the whisker is far, the others are no fault.

use crate::played::{
    LEFT, TICK_HZ, alone, error_deg, play, play_once, play_until_given_up, setpoints,
};
use firmware::Event;
use host_sim::motor::{EncoderFlaws, SimMotor, Wire};
use host_sim::trace::Row;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Of motors that are not as their model: how many times as fast, and as slow to be so.
const MOTORS: [(f64, f64); 5] = [(1.0, 1.0), (0.7, 1.0), (1.3, 1.0), (1.0, 0.7), (1.0, 1.3)];

const NONE: EncoderFlaws = EncoderFlaws::NONE;

const GIVEN_UP: Event = Event::MotorGivenUp(LEFT);

/// A whisk, ticks.
fn cycle(frequency_hz: f64) -> u64 {
    (TICK_HZ as f64 / frequency_hz) as u64
}

/// Limits that ask less of a motor: one that is weaker than its model is hotter, and farther behind.
const UNLIMITED: &str = "following_limit_deg = 60\ncontinuous_duty = 0.9\n";

/// An encoder that has flaws from somewhere in a whisk on, or stands still with them, for twelve
/// seconds at most. Whatever the frequency and wherever in a whisk (every second eighth of it, from
/// `first` on): the motor is driven for 100 ms beyond 5 degrees at most, comes no more than 20 degrees
/// outside of its whisk, and is given up.
fn is_off_in_time(flaws: EncoderFlaws, is_stuck: bool, friction: f64, motor: &str, first: u32) {
    for frequency_hz in [0.5, 1.0, 2.0, 4.0, 8.0, 12.0] {
        for phase in (first..8).step_by(2).map(|n| f64::from(n) / 8.0) {
            let cycle = cycle(frequency_hz);
            let start = TICK_HZ + cycle + (phase * cycle as f64) as u64;
            let scene = alone(frequency_hz, motor);
            let played = play_until_given_up(&scene, start + 12 * TICK_HZ, |tick, run| {
                let motor = run.motor_mut(0).unwrap();
                motor.set_friction(friction);
                if tick == start {
                    if is_stuck {
                        motor.cut(Wire::Encoder);
                    }
                    motor.set_encoder(flaws);
                }
            });
            let case = format!("{flaws:?}, {frequency_hz} Hz at {phase}, {friction}, {motor}");
            let is_fault = |event: &Event| matches!(event, Event::MotorFault(LEFT, _));
            let mut after = played.events.iter().filter(|(tick, _)| *tick >= start);
            let (off, _) = after.find(|(_, event)| is_fault(event)).unwrap();
            let rows = &played.rows[start as usize..];
            let driven = rows.iter().take((off - start) as usize);
            let far = driven.filter(|row| error_deg(row) > 5.0).count();
            let far_ms = far as f64 * 1e3 / TICK_HZ as f64;
            assert!(far_ms <= 100.0, "{case}: {far_ms} ms");
            let whisk = &setpoints(&played)[(start - cycle) as usize..];
            let [lowest, highest] =
                [f64::min, f64::max].map(|end| whisk.iter().copied().reduce(end).unwrap());
            let outside = |row: &Row| (lowest - row.angle_deg[0]).max(row.angle_deg[0] - highest);
            let outside_deg = rows.iter().map(outside).fold(0.0, f64::max);
            assert!(outside_deg <= 20.0, "{case}: {outside_deg}");
            let last = played.events.last().map(|(_, event)| *event);
            assert_eq!(last, Some(GIVEN_UP), "{case}");
        }
    }
}

#[test]
fn a_motor_whose_encoder_stands_still_or_jitters_is_off_before_the_whisker_is_far() {
    for (friction, first) in [(1.0, 0), (4.0, 1)] {
        for jitter in [0, 2, 3] {
            let jittering = EncoderFlaws { jitter, ..NONE };
            is_off_in_time(jittering, true, friction, "", first);
        }
    }
}

/// An encoder that counts the other way is found as soon, whatever the motor is.
#[test]
fn a_motor_whose_encoder_counts_the_other_way_is_off_before_the_whisker_is_far() {
    for (speed, time_constant) in MOTORS {
        let motor = model(speed, time_constant) + "continuous_duty = 0.9\n";
        for (friction, first) in [(1.0, 0), (2.0, 1), (4.0, 0)] {
            let backwards = EncoderFlaws {
                scale: -1.0,
                ..NONE
            };
            is_off_in_time(backwards, false, friction, &motor, first);
        }
    }
}

/// How far a whisker whose encoder has a loose contact comes to be from where it is taken to be,
/// while it is driven, degrees; the contact opens or closes every 16 ticks in the mean.
fn loose(frequency_hz: f64, seed: u64) -> f64 {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut displaced_deg: f64 = 0.0;
    let played = play_until_given_up(&alone(frequency_hz, ""), 30 * TICK_HZ, |tick, run| {
        let motor = run.motor_mut(0).unwrap();
        if tick > TICK_HZ && random.next_u64().is_multiple_of(8) {
            if random.next_u64().is_multiple_of(2) {
                motor.mend(Wire::Encoder);
            } else {
                motor.cut(Wire::Encoder);
            }
        }
        if motor.effort() > 0.0 {
            displaced_deg = displaced_deg.max(motor.displaced_deg().abs());
        }
    });
    let last = played.events.last().map(|(_, event)| *event);
    assert_eq!(last, Some(GIVEN_UP), "{frequency_hz} Hz, seed {seed}");
    displaced_deg
}

/// An encoder with a loose contact loses what the whisker turns meanwhile, now one way and now the
/// other: nearly always its motor is given up before the whisker can be pressed on its stops, 60
/// degrees from its whisk.
#[test]
fn a_motor_whose_encoder_has_a_loose_contact_is_given_up_near_its_whisk() {
    let mut found = Vec::new();
    for frequency_hz in [0.5, 2.0, 5.0, 8.0, 12.0] {
        found.extend((100..116).map(|seed| loose(frequency_hz, seed)));
    }
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    let far = found.iter().filter(|degrees| **degrees > 45.0).count();
    println!("loose contact: {mean:.1} degrees in the mean, {far} of 80 above 45");
    assert!(mean < 20.0 && far <= 4, "{mean}, {far}");
}

/// Keys of a scene by which its motor is so many times as fast, and as slow to be so, as its
/// model.
fn model(speed: f64, time_constant: f64) -> String {
    format!(
        "top_speed_deg_s = {:?}\ntime_constant_s = {:?}\n",
        15_000.0 / speed,
        0.048 / time_constant
    )
}

/// Whatever a scene says of a motor, it may be 30 % off, with friction up to four times that of
/// the model, and nothing is a fault. All at once may cost a test that fails, and no motor.
#[test]
fn motors_that_are_not_as_the_scene_has_them_have_no_fault() {
    let all_at_once = (0.7, 1.3);
    for (speed, time_constant) in MOTORS.into_iter().chain([all_at_once]) {
        for friction in [1.0, 2.0, 4.0] {
            for frequency_hz in [0.05, 0.2, 0.5, 2.0, 5.0, 8.0, 14.0] {
                // The model is wrong instead of the motor.
                let motor = model(speed, time_constant) + UNLIMITED;
                let scene = alone(frequency_hz, &motor);
                let ticks = TICK_HZ * 2 + 2 * cycle(frequency_hz).min(10 * TICK_HZ);
                let played = play(&scene, ticks, |_, run| {
                    run.motor_mut(0).unwrap().set_friction(friction);
                });
                let case = format!("{frequency_hz} Hz, {speed}, {time_constant}, {friction}");
                if (speed, time_constant) == all_at_once && friction == 4.0 {
                    let is_lost = played.events.iter().any(|(_, event)| *event == GIVEN_UP);
                    assert!(!is_lost, "{case}: {:?}", played.events);
                } else {
                    assert_eq!(played.events, [], "{case}");
                }
            }
        }
    }
}

/// Friction that becomes four times as large, a supply of 4.5 V, a soft hand.
#[test]
fn what_makes_a_whisker_heavy_while_it_runs_is_no_fault() {
    type Change = fn(&mut SimMotor);
    let changes: [(&str, Change); 5] = [
        ("friction", |motor| motor.set_friction(4.0)),
        ("supply", |motor| motor.set_supply_v(Some(4.5))),
        ("hand", |motor| motor.set_load_nm(1.5e-3)),
        ("hand back", |motor| motor.set_load_nm(-1.5e-3)),
        ("no friction", |motor| motor.set_friction(0.0)),
    ];
    for (name, change) in changes {
        for frequency_hz in [0.2, 0.5, 2.0, 5.0, 8.0] {
            let (scene, at) = (alone(frequency_hz, ""), 3 * TICK_HZ + 321);
            let played = play_once(&scene, 6 * TICK_HZ, at, |run| {
                change(run.motor_mut(0).unwrap());
            });
            assert_eq!(played.events, [], "{name} at {frequency_hz} Hz");
        }
    }
}

/// What is done to a whisker that is no fault.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Hand {
    None,
    /// A soft one pushes with so much, N·m, for half of each second.
    Soft(f64),
    /// A finger holds it for 0.3 s each second.
    Finger,
}

/// So many motors at random are tried in each row.
const DRAWN: u64 = 24;

/// Motors lost, of those of a row, and with any fault: speed and time constant anywhere within
/// 30 % of what the scene says, from 0.05 to 14 Hz.
fn tried(friction: f64, play_deg: f64, hand: Hand) -> [usize; 2] {
    let mut found = [0; 2];
    let mut random = Xoshiro256PlusPlus::seed_from_u64(35);
    let mut within = || 0.7 + 0.6 * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    for n in 0..DRAWN {
        let frequency_hz = [0.05, 0.2, 0.5, 2.0, 8.0, 14.0][n as usize % 6];
        // The model is wrong instead of the motor.
        let motor = model(within(), within()) + UNLIMITED;
        let ticks = TICK_HZ * 2 + (2 * cycle(frequency_hz)).clamp(8 * TICK_HZ, 20 * TICK_HZ);
        let played = play(&alone(frequency_hz, &motor), ticks, |tick, run| {
            let motor = run.motor_mut(0).unwrap();
            if tick == 0 {
                motor.set_play_deg(play_deg);
                motor.set_friction(friction);
            }
            let holds = tick > TICK_HZ && tick % TICK_HZ < 3 * TICK_HZ / 10;
            let pushes = tick > TICK_HZ && tick % TICK_HZ < TICK_HZ / 2;
            match hand {
                Hand::None => {}
                Hand::Soft(torque_nm) => motor.set_load_nm(if pushes { torque_nm } else { 0.0 }),
                Hand::Finger => motor.block(holds),
            }
        });
        let has = |wanted: fn(&Event) -> bool| played.events.iter().any(|(_, event)| wanted(event));
        found[0] += usize::from(has(|event| *event == GIVEN_UP));
        found[1] += usize::from(has(|event| matches!(event, Event::MotorFault(LEFT, _))));
    }
    found
}

#[test]
fn no_motor_of_24_is_lost_whatever_its_friction_its_play_and_what_touches_it() {
    println!("hand, friction, play: lost, with a fault");
    for hand in [
        Hand::None,
        Hand::Soft(1.5e-3),
        Hand::Soft(-1.5e-3),
        Hand::Finger,
    ] {
        for friction in [1.0, 2.0, 4.0] {
            for play_deg in [0.0, 1.0, 3.0] {
                let [lost, faults] = tried(friction, play_deg, hand);
                let row = format!("{hand:?}, {friction}, {play_deg}: {lost}, {faults}");
                println!("{row}");
                assert_eq!(lost, 0, "{row}");
                assert_eq!(faults > 0, hand == Hand::Finger, "{row}");
            }
        }
    }
}
