//! Gains that a motor bears, by the model that a board and a PC hold them against: steps of motors
//! that are not quite as the model has them.

use crate::played::{BOARD, alone};
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use whisking::motor::ModelSettings;
use whisking::pd;

/// A motor, and how it is controlled.
#[derive(Debug, Clone, Copy)]
struct Case {
    tick_hz: f64,
    speed_deg_s: f64,
    time_constant_s: f64,
    pd: pd::Settings,
}

impl Case {
    fn drawn(random: &mut impl FnMut(f64, f64) -> f64) -> Self {
        Self {
            tick_hz: random(500.0, 10_000.0),
            speed_deg_s: random(1_500.0, 25_000.0),
            time_constant_s: random(0.01, 0.3),
            pd: pd::Settings {
                kp: random(0.003, 3.0),
                kd: random(1e-5, 1e-2),
                limit: random(0.2, 1.0),
                slew_per_s: random(40.0, 3_000.0),
                min_deg: -1e3,
                max_deg: 1e3,
                degrees_per_count: random(0.005, 0.5),
            },
        }
    }

    /// Whether its gains are taken.
    fn is_taken(&self) -> bool {
        let model = ModelSettings {
            speed_deg_s: self.speed_deg_s,
            time_constant_s: self.time_constant_s,
            friction_duty: 0.06,
            duty_limit: self.pd.limit,
            slew_per_s: self.pd.slew_per_s,
        };
        let model = model.build::<f64>(self.tick_hz, self.pd.degrees_per_count);
        let config = self.pd.build::<f64>(self.tick_hz).unwrap();
        config.settles(&model.unwrap()).is_ok()
    }

    /// By how much a step of so many degrees is overshot, and by how much the whisker still moves
    /// in the last third of the time: shares of the step, without two and four counts of the encoder.
    fn step(&self, step_deg: f64, motor: [f64; 2], friction: f64) -> [f64; 2] {
        const PARTS: usize = 4;
        let [speed, time_constant] = [motor[0] * self.speed_deg_s, motor[1] * self.time_constant_s];
        let natural = (self.speed_deg_s * self.pd.kp / self.time_constant_s).sqrt();
        let way_s = step_deg / (0.5 * speed * self.pd.limit);
        // What is damped more than it need be creeps.
        let creep_s = (1.0 / speed + self.pd.kd) / self.pd.kp;
        let time_s = 45.0 / natural + 3.0 * way_s + 12.0 * time_constant + 5.0 * creep_s;
        let ticks = (time_s * self.tick_hz) as usize;
        let config = self.pd.build::<f64>(self.tick_hz).unwrap();
        let setpoint = step_deg / 100.0;
        let mut state = pd::State::default();
        let (mut at, mut velocity, mut counts, mut duty) = (0.0_f64, 0.0_f64, 0, 0.0);
        let (mut top, mut late) = (0.0_f64, [f64::MAX, f64::MIN]);
        for tick in 0..ticks {
            let now = (at / self.pd.degrees_per_count).floor() as i32;
            // A duty acts from the end of its tick on.
            let acts = duty;
            let next = config.step(&mut state, setpoint, now, now - counts);
            duty = f64::from(next.q15()) / 32_767.0;
            counts = now;
            for _ in 0..PARTS {
                let part_s = 1.0 / self.tick_hz / PARTS as f64;
                let resists = if velocity == 0.0 {
                    acts.clamp(-friction, friction)
                } else {
                    friction.copysign(velocity)
                };
                let before = velocity;
                velocity += part_s / time_constant * (speed * (acts - resists) - velocity);
                if velocity * before < 0.0 {
                    velocity = 0.0;
                }
                at += part_s * velocity;
            }
            top = top.max(at);
            if 3 * tick > 2 * ticks {
                late = [late[0].min(at), late[1].max(at)];
            }
        }
        let count = self.pd.degrees_per_count;
        let errors = [
            top - step_deg - 2.0 * count,
            late[1] - late[0] - 4.0 * count,
        ];
        errors.map(|error| error / step_deg)
    }
}

/// Numbers that are spread evenly by their logarithm.
fn logarithmic(seed: u64) -> impl FnMut(f64, f64) -> f64 {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    move |low, high| {
        let share = (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low * (high / low).powf(share)
    }
}

/// The seeds of motors that are drawn, and how many are of each.
const SEEDS: core::ops::Range<u64> = 100..104;
const EACH: usize = 100;

/// 30 % off, each way, with friction and without.
#[test]
fn under_gains_that_are_taken_every_motor_comes_to_rest() {
    let mut overshoots = Vec::new();
    let taken = |seed| {
        let mut random = logarithmic(seed);
        let cases = std::iter::repeat_with(move || Case::drawn(&mut random));
        cases.filter(Case::is_taken).take(EACH)
    };
    for case in SEEDS.flat_map(taken) {
        for step_deg in [5.0, 20.0, 80.0] {
            let mut most = 0.0_f64;
            for motor in [[1.0, 1.0], [0.7, 0.7], [0.7, 1.3], [1.3, 0.7], [1.3, 1.3]] {
                for friction in [0.0, 0.06] {
                    let [over, late] = case.step(step_deg, motor, friction);
                    assert!(late < 0.1, "{late} of {step_deg}, {motor:?}: {case:?}");
                    most = most.max(over);
                }
            }
            assert!(most < 0.75, "{most} of {step_deg}: {case:?}");
            overshoots.push(most);
        }
    }
    overshoots.sort_by(f64::total_cmp);
    let nearly_all = overshoots[overshoots.len() * 99 / 100];
    println!("99 of 100 overshoot by at most {nearly_all:.2}");
    assert!(nearly_all < 0.5);
}

fn refusal(keys: &str) -> Option<String> {
    let built = config::build::<f32>(&alone(2.0, keys), BOARD);
    built.err().map(|mismatch| mismatch.to_string())
}

/// What calibration suggests for the simulated motor is taken; what sets it swinging is not, and
/// what is said to be allowed is.
#[test]
fn a_refusal_says_what_would_be_taken() {
    for keys in [
        "",
        "kp = 0.086\nkd = 0.00084\n",
        "kp = 0.02\n",
        "kp = 0.0\nkd = 0.0\n",
    ] {
        assert_eq!(refusal(keys), None, "{keys}");
    }
    for (keys, says, allowed) in [
        (
            "kp = 1.0\nkd = 0.0\n",
            "motor.kp: found kp 1, kd 0,",
            "kp = 0.0041\nkd = 0.0\n",
        ),
        ("kd = 0.0\n", "motor.kp: ", "kd = 0.00022\n"),
        ("kd = 0.01\n", "motor.kd: ", "kd = 0.0014\n"),
        (
            "slew_per_s = 60.0\n",
            "motor.slew_per_s: ",
            "kp = 0.0023\nslew_per_s = 60.0\n",
        ),
    ] {
        let refused = refusal(keys).unwrap();
        println!("{refused}");
        assert!(refused.starts_with(says), "{refused}");
        assert_eq!(refusal(allowed), None, "{refused}");
    }
}
