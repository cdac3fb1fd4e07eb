//! Commands in any order, with a motor whose encoder may be stuck: what moves rest, what is driven
//! after a stop, and how often a motor that fails is tried.

use firmware::{
    Command, Config, Event, Module, Place, Retry, ServoState, TooManyFaults, WhiskerParts,
};
use proptest::prelude::*;
use whisking::motor::GuardSettings;

use crate::command::{self, Whiskers};
use crate::hardware::{Bent, NoClock, Rig};

/// Counts in a tick at full duty.
const SPEED: f64 = 20.0;

struct Bench {
    module: Whiskers<f64>,
    config: Config<f64>,
    rig: Rig,
    events: Vec<Event>,
}

const LEFT: Place = Place::new(0, 0);
const RETRY: Retry = Retry {
    rest: 20,
    window: 5_000,
};

impl Bench {
    fn new() -> Self {
        let (_, mut config) = command::module::<f64>();
        config.head.whiskers_per_side = 1;
        let motion = config.motion.as_mut().expect("it whisks");
        motion.servo.retry = RETRY;
        let guards = GuardSettings {
            degrees_per_count: 0.1,
            hard_duty: 0.5,
            model: None,
            following_deg: 40.0,
            ..GuardSettings::NONE
        };
        motion.servo.guards = guards.build(2000.0);
        let rig = Rig::default();
        let motor = Some((rig.clone(), rig.clone()));
        let source = Bent(0xC000);
        let parts = [WhiskerParts { source, motor }];
        let module = Module::new(&config, parts, None, (NoClock, 0));
        let events = Vec::new();
        Self {
            module,
            config,
            rig,
            events,
        }
    }

    fn tick(&mut self) {
        self.module
            .tick(&self.config, &mut |event| self.events.push(event));
        let mut rig = self.rig.0.borrow_mut();
        rig.counts += SPEED * rig.duty;
    }

    fn faults(&self) -> usize {
        let is_fault = |event: &&Event| matches!(event, Event::MotorFault(..));
        self.events.iter().filter(is_fault).count()
    }

    /// Where the module takes it to be, from where it is, counts.
    fn off_rest(&self) -> f64 {
        let motion = self.config.motion.as_ref().expect("it whisks");
        let servo = self.module.whiskers()[0].servo().expect("it has a motor");
        let measured = servo.record(&motion.servo, 0.0).measured;
        // A count is 0.1 degrees, and a thousandth of θ.
        f64::from(measured) / 8.192 - self.rig.0.borrow().counts
    }

    fn stick(&mut self) {
        let mut rig = self.rig.0.borrow_mut();
        rig.stuck_at = Some(rig.counts.round() as i32);
    }
}

#[derive(Debug, Clone, Copy)]
enum Do {
    Arm,
    Stop,
    Clear,
    Home,
    Setpoint(f64),
    Ticks(u16),
    /// Somebody turns it while the motor is off.
    Turn(f64),
}

fn steps() -> impl Strategy<Value = Do> {
    prop_oneof![
        Just(Do::Arm),
        Just(Do::Stop),
        Just(Do::Clear),
        Just(Do::Home),
        (-0.2..0.9).prop_map(Do::Setpoint),
        (1..200_u16).prop_map(Do::Ticks),
        (-300.0..300.0).prop_map(Do::Turn),
    ]
}

proptest! {
    #[test]
    fn no_order_of_commands_moves_rest_or_drives_after_a_stop(
        all in prop::collection::vec(steps(), 1..80),
    ) {
        let mut bench = Bench::new();
        bench.module.arm(true);
        let mut is_armed = true;
        bench.tick();
        for one in all {
            match one {
                Do::Arm => {
                    bench.module.arm(true);
                    is_armed = true;
                }
                Do::Stop => {
                    bench.module.arm(false);
                    is_armed = false;
                }
                Do::Clear => _ = bench.module.command(LEFT, Command::Clear),
                // A PC is refused this where no stop is to be found.
                Do::Home => bench.module.command(LEFT, Command::Home).unwrap(),
                Do::Setpoint(theta) => {
                    bench.module.command(LEFT, Command::Setpoint(Some(theta))).unwrap();
                }
                Do::Ticks(count) => {
                    for _ in 0..count {
                        bench.tick();
                        prop_assert!(is_armed || bench.rig.duty() == 0.0);
                    }
                }
                Do::Turn(counts) if !is_armed => bench.rig.0.borrow_mut().counts += counts,
                Do::Turn(_) => {}
            }
            bench.tick();
            prop_assert!(is_armed || bench.rig.duty() == 0.0);
            let moved = bench.rig.duty() * SPEED;
            prop_assert!((bench.off_rest() + moved).abs() < 2.0, "{}", bench.off_rest());
        }
    }

    #[test]
    fn a_stuck_encoder_is_tried_no_oftener_for_all_that_is_asked(
        all in prop::collection::vec(
            prop_oneof![Just(Do::Arm), Just(Do::Stop), (1..30_u16).prop_map(Do::Ticks)], 1..200,
        ),
    ) {
        let mut bench = Bench::new();
        bench.module.arm(true);
        bench.tick();
        bench.stick();
        let mut ticks = 0;
        for one in all {
            match one {
                Do::Stop => bench.module.arm(false),
                Do::Ticks(count) => {
                    for _ in 0..count {
                        bench.tick();
                        ticks += 1;
                    }
                }
                _ => bench.module.arm(true),
            }
        }
        prop_assert!(ticks < RETRY.window);
        prop_assert!(bench.faults() <= 3, "{}", bench.faults());
    }
}

#[test]
fn who_clears_a_motor_that_was_given_up_has_one_more_fault_in_a_while() {
    let mut bench = Bench::new();
    bench.module.arm(true);
    bench.tick();
    bench.stick();
    let is_given_up = |bench: &Bench| {
        let servo = bench.module.whiskers()[0].servo().unwrap();
        matches!(servo.state(), ServoState::GivenUp)
    };
    for _ in 0..2_000 {
        bench.tick();
    }
    assert!(is_given_up(&bench));
    assert_eq!(bench.faults(), 3);
    let mut cleared = 0;
    for _ in 0..RETRY.window {
        match bench.module.command(LEFT, Command::Clear) {
            Ok(()) => cleared += u32::from(is_given_up(&bench)),
            Err(refused) => assert_eq!(refused, TooManyFaults.into()),
        }
        bench.module.arm(true);
        bench.tick();
    }
    assert_eq!((bench.faults(), is_given_up(&bench)), (4, true));
    assert_eq!(cleared, 0, "what is cleared is given up no more");
    // It runs again where it is sound, and where the time has passed.
    bench.rig.0.borrow_mut().stuck_at = None;
    bench.tick();
    bench.module.command(LEFT, Command::Clear).unwrap();
    bench.tick();
    bench.tick();
    assert!(bench.rig.duty() != 0.0);
}
