//! State that cannot rot: what a servo was set to once, and what it remembers of faults.

use whisking::motor::{Duty, Fault, GuardSettings, MotorDriver};
use whisking::pd;

use super::{Retry, Servo, ServoConfig, ServoState};
use crate::{AngleInput, Event, Place};

#[derive(Default)]
struct Kept(Option<Duty>);

impl MotorDriver for Kept {
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        self.0 = Some(duty);
        Ok(())
    }

    fn off(&mut self) {
        self.0 = None;
    }

    fn clear(&mut self) {}
}

struct Still;

impl AngleInput for Still {
    fn counts(&mut self) -> i32 {
        300
    }
}

fn config() -> ServoConfig<f32> {
    let pd = pd::Settings {
        kp: 0.01,
        kd: 0.0,
        limit: 0.5,
        slew_per_s: 1e6,
        min_deg: 30.0,
        max_deg: 140.0,
        degrees_per_count: 0.1,
    };
    ServoConfig {
        pd: pd.build(2000.0).unwrap(),
        retry: Retry {
            rest: 10,
            window: 1_000,
        },
        guards: GuardSettings::NONE.build(2000.0),
        approach: 10.0,
        homing: None,
    }
}

type Whisker = Servo<f32, Kept, Still>;

fn tick(servo: &mut Whisker) -> (Option<f32>, Vec<Event>) {
    let mut events = Vec::new();
    let place = Place::new(0, 0);
    servo.step(&config(), 0.2, true, place, &mut |event| events.push(event));
    let duty = servo.motor.0.map(|duty| f32::from(duty.q15()) / 32_767.0);
    (duty, events)
}

#[test]
fn a_bit_flipped_in_rest_or_setpoint_moves_nothing() {
    for copy in 0..3 {
        for bit in 0..32 {
            let mut servo = Servo::new(Kept::default(), Still);
            let undisturbed = tick(&mut servo);
            assert!((undisturbed.0.unwrap() - 0.2).abs() < 1e-3);
            *servo.home.copies_mut()[copy] ^= 1 << bit;
            *servo.setpoint.copies_mut()[copy] = Some(f32::from_bits(1 << bit));
            assert_eq!(tick(&mut servo), undisturbed, "{copy} {bit}");
        }
    }
}

#[test]
fn without_a_rest_the_motor_is_off() {
    let mut servo = Servo::new(Kept::default(), Still);
    tick(&mut servo);
    for (n, copy) in servo.home.copies_mut().into_iter().enumerate() {
        *copy = 100 * n as i32;
    }
    let fault = Event::MotorFault(Place::new(0, 0), Fault::Travel);
    assert_eq!(tick(&mut servo), (None, vec![fault]));
}

/// A state that faults did not lead to is left; so is one that lasts too long.
#[test]
fn a_motor_that_rests_for_no_fault_runs_again() {
    for state in [ServoState::GivenUp, ServoState::Resting { left: u16::MAX }] {
        let mut servo = Servo::new(Kept::default(), Still);
        tick(&mut servo);
        servo.state = state;
        servo.windows = [0, u32::MAX];
        let runs = (0..20).position(|_| tick(&mut servo).0.is_some());
        assert!(runs.is_some_and(|ticks| ticks <= 11), "{state:?}: {runs:?}");
    }
    let mut servo = Servo::new(Kept::default(), Still);
    servo.windows = [1 << 20, 1 << 30];
    tick(&mut servo);
    assert_eq!(servo.windows, [1_000; 2]);
}

#[test]
fn a_motor_that_was_given_up_stays_so() {
    let mut servo = Servo::new(Kept::default(), Still);
    tick(&mut servo);
    servo.home = whisking::Voted::default();
    *servo.home.copies_mut()[0] = 1;
    *servo.home.copies_mut()[1] = 2;
    let events: Vec<Event> = (0..100).flat_map(|_| tick(&mut servo).1).collect();
    assert!(events.ends_with(&[Event::MotorGivenUp(Place::new(0, 0))]));
    for _ in 0..10_000 {
        assert_eq!(tick(&mut servo), (None, Vec::new()));
    }
}

/// A setpoint that is commanded while the whisker is brought to the last one is approached from
/// where the whisker is: what drives it never asks for what lies beyond the two.
#[test]
fn a_setpoint_on_the_way_to_another_is_approached_from_where_the_whisker_is() {
    let slow = ServoConfig {
        approach: 0.01,
        ..config()
    };
    let place = Place::new(0, 0);
    for (commanded, other) in [(-0.2, 0.8), (0.8, -0.2), (0.1, 0.8)] {
        let mut servo = Servo::new(Kept::default(), Still);
        let follows = |servo: &mut Whisker| {
            servo.step(&slow, other, true, place, &mut |event| panic!("{event:?}"));
            let record = servo.record(&slow, other);
            f32::from(record.setpoint) / 8_192.0
        };
        (0..3).for_each(|_| _ = follows(&mut servo));
        servo.set_setpoint(Some(commanded));
        let mut last: f32 = 0.0;
        for tick in 0..200 {
            let found = follows(&mut servo);
            let between = commanded.min(0.0) - 1e-3..=commanded.max(0.0) + 1e-3;
            assert!(between.contains(&found), "{commanded}, {tick}: {found}");
            assert!((found - last).abs() < 0.02, "{commanded}, {tick}: {found}");
            last = found;
        }
        assert!((last - commanded).abs() < 1e-3, "{last}");
    }
}
