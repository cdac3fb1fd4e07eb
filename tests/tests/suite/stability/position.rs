//! Position control and H50 under abuse: bounded always, back soon after.
//!
//! *Back* for position control: once readings are sound, the duty is where its
//! proportional part says, within 1e-3, after (a) two ticks in which the bad
//! reading is still the last one, (b) as many ticks as the smoothed velocity
//! (100 Hz) takes to fall from the largest jump that counts can make to where
//! k_d makes 5e-4 of it, and (c) as many as the slew takes from one limit to
//! the other. In fixed point the smoothed velocity stands still where a step
//! would be less than one, and k_d makes a duty of that and of a few steps
//! more that the product loses: that much is taken off the 1e-3.
//!
//! *Back* for H50: 200 ms after the last bad sample what is left of it is below
//! 1e-6.

use rayon::prelude::*;
use whisking::{Fix, Real, filter, pd};

use super::axes::TICKS_HZ;
use super::rig::Extreme;

/// Some encoder: 100 counts a degree, 10,000 a unit of protraction.
const DEGREES_PER_COUNT: f64 = 0.01;

fn settings() -> Vec<pd::Settings> {
    let mut list = Vec::new();
    for kp in [0.0, 0.05, 10.0] {
        for kd in [0.0, 0.001, 1.0] {
            for limit in [0.0, 0.8, 1.0] {
                for slew_per_s in [1.0, 400.0, 1e5] {
                    list.push(pd::Settings {
                        kp,
                        kd,
                        limit,
                        slew_per_s,
                        min_deg: 30.0,
                        max_deg: 150.0,
                        degrees_per_count: DEGREES_PER_COUNT,
                    });
                }
            }
        }
    }
    list
}

/// Counts that no whisker comes to, in jumps that none makes.
const BAD_COUNTS: [i32; 7] = [i32::MIN, i32::MAX, 1, -1, 0, 20_000, -20_000];

/// Setpoints that no muscle gives.
fn bad<R: Extreme>() -> [R; 6] {
    [
        R::NOT_A_NUMBER,
        R::HIGHEST,
        R::LOWEST,
        R::ZERO,
        R::TWO,
        -R::TWO,
    ]
}

/// 64 ticks of each bad reading with each bad setpoint, then sound ones.
fn control<R: Extreme>(settings: &pd::Settings, tick_hz: f64) {
    let config = settings.build::<R>(tick_hz).unwrap();
    let (limit, slew) = (settings.limit, settings.slew_per_s / tick_hz);
    // A duty is the step below or the nearest.
    let step_of_duty = 1.0 / 32_767.0;
    let mut state = pd::State::default();
    let (mut last, mut before) = (0.0, 0_i32);
    let mut step = |setpoint: R, counts: i32| {
        let moved = counts.wrapping_sub(std::mem::replace(&mut before, counts));
        let duty = config.step(&mut state, setpoint, counts, moved);
        let duty = f64::from(duty.q15()) / 32_767.0;
        assert!(
            duty.abs() <= limit + step_of_duty && (duty - last).abs() <= slew + 2.0 * step_of_duty,
            "{settings:?} at {tick_hz}: {last} to {duty}"
        );
        last = duty;
        duty
    };
    let velocity_per_tick = std::f64::consts::TAU * 100.0 / tick_hz;
    let kd_a_tick = settings.kd * 100.0 * tick_hz;
    let largest = 2_f64.powi(32) * DEGREES_PER_COUNT / 100.0;
    let fall = (kd_a_tick * largest / 5e-4).max(1.0).ln() / velocity_per_tick;
    let stands_still = kd_a_tick * R::STEP * (4.0 - 1.0 / (-velocity_per_tick).exp_m1());
    let ticks = (2.0 + fall + 2.0 * limit / slew).ceil() as usize + 1;
    for counts in BAD_COUNTS {
        for setpoint in bad::<R>() {
            for _ in 0..64 {
                step(setpoint, counts);
                step(setpoint, 0);
                step(R::ONE, counts);
            }
        }
        // Slow slews take seconds to come back; half of them is enough of those.
        if ticks > 40_000 {
            continue;
        }
        let mut duty = 0.0;
        for _ in 0..ticks {
            duty = step(R::from_f64(0.51), 5_000);
        }
        let expected = settings.kp.min(limit);
        assert!(
            (duty - expected).abs() < 1e-3 + stands_still,
            "{settings:?} at {tick_hz}: {duty} and not {expected} after {ticks} ticks"
        );
    }
}

#[test]
fn position_control_keeps_its_limits_and_comes_back() {
    settings().par_iter().for_each(|settings| {
        for tick_hz in TICKS_HZ {
            control::<f64>(settings, tick_hz);
            control::<f32>(settings, tick_hz);
            control::<Fix>(settings, tick_hz);
        }
    });
}

#[test]
fn counts_saturate_and_do_not_wrap() {
    // The coarsest and the finest encoder and gear of a scene, and the papers'.
    for counts_per_turn in [4.0, 512.0 * 11.0, 65_536.0 * 1_000.0] {
        let factor = 360.0 / counts_per_turn / 100.0;
        for counts in [i32::MIN, -70_000, -1, 0, 1, 3, 70_000, i32::MAX] {
            let exact = f64::from(counts) * factor;
            let fixed = Fix::from_counts(counts, Fix::coefficient(factor)).to_f64();
            let expected = exact.clamp(-4.0, 4.0);
            assert!(
                (fixed - expected).abs() <= 3.1e-5 * expected.abs() + 2e-8,
                "{counts}: {fixed} {expected}"
            );
            let single = f64::from(f32::from_counts(counts, f32::coefficient(factor)));
            assert!((single - exact).abs() <= 2e-7 * exact.abs(), "{counts}");
        }
    }
}

/// The largest output of H50 to any input within ±1: the sum of the magnitudes
/// of its answer to a single one.
fn largest(tick_hz: f64) -> f64 {
    let config = filter::Config::<f64>::new(filter::CORNER_HZ, tick_hz).unwrap();
    let mut state = filter::State::default();
    let answer = (0..tick_hz as usize).map(|n| {
        let x = if n == 0 { 1.0 } else { 0.0 };
        config.process(&mut state, x).abs()
    });
    answer.sum()
}

/// H50 in `R`, whose numbers have steps of `step_size`, beside f64 through
/// `input`, then nothing for 200 ms; a step of the sensor is 1.2e-4.
fn smooth<R: Real>(tick_hz: f64, step_size: f64, apart: f64, input: impl Fn(usize) -> f64) {
    let limit = largest(tick_hz) + 2e-6;
    assert!(limit < 1.34, "{tick_hz}: {limit}");
    let config = filter::Config::<R>::new(filter::CORNER_HZ, tick_hz).unwrap();
    let wide = filter::Config::<f64>::new(filter::CORNER_HZ, tick_hz).unwrap();
    let (mut state, mut wide_state) = (filter::State::default(), filter::State::default());
    let mut worst = 0.0_f64;
    let mut step = |x: f64| {
        let y = config.process(&mut state, R::from_f64(x)).to_f64();
        worst = worst.max((y - wide.process(&mut wide_state, x)).abs());
        assert!(y.abs() <= limit, "{tick_hz}: {y}");
        y
    };
    let second = tick_hz as usize;
    for n in 0..second {
        step(input(n));
    }
    let mut left = 0.0;
    for _ in 0..second / 5 {
        left = step(0.0);
    }
    // It stands where v3 g²/(1 + g + g²) is less than half a step; a little
    // beyond when it comes with a swing.
    let g = (core::f64::consts::PI * filter::CORNER_HZ / tick_hz).tan();
    let rest = step_size * (1.0 + g + g * g) / (g * g);
    assert!(left.abs() < rest.max(1e-6), "{tick_hz}: {left:e}");
    assert!(worst <= apart, "{tick_hz}: {worst:e}");
}

#[test]
fn h50_holds_full_scale_at_any_rhythm_and_forgets_it() {
    TICKS_HZ.into_par_iter().for_each(|tick_hz| {
        for period in [1, 2, 3, 7, tick_hz as usize / 100, tick_hz as usize] {
            let square = |n: usize| {
                if (n / period).is_multiple_of(2) {
                    1.0
                } else {
                    -1.0
                }
            };
            smooth::<f64>(tick_hz, 0.0, 0.0, square);
            smooth::<f32>(tick_hz, 0.0, 1e-5, square);
            smooth::<Fix>(tick_hz, 2.0_f64.powi(-28), 1e-4, square);
        }
    });
}
