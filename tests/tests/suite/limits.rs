//! Whatever limits a board takes: a motor whose encoder stands still is not driven for long.

use proptest::prelude::*;

use crate::played::{BOARD, TICK_HZ, alone_with, play_until_given_up};
use firmware::{Config, Event, decode, encode};
use host_sim::motor::{EncoderFlaws, Wire};
use scene::Scene;

/// With more duty than this, in the mean of so many ticks, a motor is driven: the most that may be
/// expected to go into friction, and some. (What jumps to and fro with an encoder that jitters turns
/// none.)
const DRIVEN: f64 = 0.27;
const MEAN: usize = 20;
/// For how long in all at most before its first fault, and with its retries in six seconds, s.
const DRIVEN_S: f64 = 0.15;
const RETRIED_S: f64 = 0.4;

/// The keys of a motor, each from what is allowed at least to what is allowed at most, and beyond.
fn keys() -> impl Strategy<Value = String> {
    let reach = (-100.0..40.0_f64, 60.0..280.0_f64, 0.0..60.0_f64);
    let guards = (1.0..120.0_f64, 3.0..5.0_f64, 0.1..1.0_f64);
    let motor = (-2.5..0.3_f64, 0.0..0.6_f64, 0.1..1.0_f64, 1.5..4.0_f64);
    let gains = (-2.5..0.0_f64, -5.0..-2.0_f64);
    let power = |exponent: f64| 10_f64.powf(exponent);
    (reach, guards, motor, gains).prop_map(move |(reach, guards, motor, gains)| {
        let (min, max, margin) = reach;
        let (following, top_speed, continuous) = guards;
        let (time_constant, unmoved, limit, slew) = motor;
        format!(
            "min_deg = {min:?}\nmax_deg = {max:?}\ntravel_margin_deg = {margin:?}\n\
             following_limit_deg = {following:?}\ntop_speed_deg_s = {:?}\n\
             continuous_duty = {continuous:?}\ntime_constant_s = {:?}\nunmoved_duty = {unmoved:?}\n\
             duty_limit = {limit:?}\nslew_per_s = {:?}\nkp = {:?}\nkd = {:?}\n",
            power(top_speed),
            power(time_constant),
            power(slew),
            power(gains.0),
            power(gains.1),
        )
    })
}

/// Whether a board takes a scene: the one that builds its configuration and the board that reads
/// it say the same.
fn is_taken(scene: &Scene) -> bool {
    fn reads<R: whisking::Number>(scene: &Scene) -> bool {
        let Ok(config) = config::build::<R>(scene, BOARD) else {
            return false;
        };
        let board = firmware::BoardCode::NucleoF446re;
        let read: Result<Config<R>, _> = encode(&config, board).and_then(|b| decode(&b, board));
        assert!(read.is_ok(), "{read:?}: {:?}", scene.motor);
        true
    }
    let [single, fixed] = [reads::<f32>(scene), reads::<whisking::Fix>(scene)];
    assert_eq!(single, fixed);
    single
}

proptest! {
    #![proptest_config(ProptestConfig {
        max_global_rejects: 1_000_000,
        failure_persistence: None,
        ..ProptestConfig::with_cases(400)
    })]

    #[test]
    fn a_motor_whose_encoder_stands_still_is_off_soon_whatever_its_limits(
        motor in keys(),
        frequency_hz in 0.5..8.0_f64,
        jitter in 0..=3_u16,
    ) {
        let whisking = format!("frequency_hz = {frequency_hz:?}\nnoise = 0.0\ngain = 2.0");
        let scene = alone_with(&whisking, &motor);
        prop_assume!(is_taken(&scene));
        let mut duties = Vec::new();
        let played = play_until_given_up(&scene, 6 * TICK_HZ, |tick, run| {
            let motor = run.motor_mut(0).unwrap();
            if tick == 0 {
                motor.cut(Wire::Encoder);
                motor.set_encoder(EncoderFlaws { jitter, ..EncoderFlaws::NONE });
            }
            duties.push(motor.duty());
        });
        let fault = played.events.iter().find(|(_, event)| matches!(event, Event::MotorFault(..)));
        let before = fault.map_or(6 * TICK_HZ, |(tick, _)| *tick) as usize;
        let driven_s = |ticks: usize| {
            let means = duties.windows(MEAN).take(ticks);
            let means = means.map(|duties| duties.iter().sum::<f64>() / MEAN as f64);
            means.filter(|duty| duty.abs() > DRIVEN).count() as f64 / TICK_HZ as f64
        };
        let [first_s, all_s] = [before, duties.len()].map(driven_s);
        prop_assert!(first_s <= DRIVEN_S, "{first_s} s at {frequency_hz} Hz:\n{motor}");
        prop_assert!(all_s <= RETRIED_S, "{all_s} s at {frequency_hz} Hz:\n{motor}");
    }
}
