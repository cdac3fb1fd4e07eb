//! Motors drawn at random, with what is no fault: none is lost.

use crate::encoder_faults::{GIVEN_UP, UNLIMITED, cycle, model};
use crate::played::{LEFT, TICK_HZ, alone, play};
use firmware::Event;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

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
const MOTORS: u64 = 24;

/// Motors lost, of those of a row, and with any fault: speed and time constant anywhere within
/// 30 % of what the scene says, from 0.05 to 14 Hz.
fn tried(friction: f64, play_deg: f64, hand: Hand) -> [usize; 2] {
    let mut found = [0; 2];
    let mut random = Xoshiro256PlusPlus::seed_from_u64(35);
    let mut within = || 0.7 + 0.6 * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    for n in 0..MOTORS {
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
