//! Commands between ticks: the nominal gain and the setpoint of a whisker.

use firmware::{
    Active, ActiveConfig, AngleInput, Command, Config, Module, NoActiveWhisker, Passive, Place,
    Servo, ServoConfig, ServoState, design_parameters,
};
use mlx90333::Decoder;
use whisking::motor::{Duty, Fault, GuardSettings, MotorDriver};
use whisking::{Absent, Fix, GateSettings, Integrator, Real, Settings, State, filter, pd};

use crate::hardware::{AT_ONCE, Bent, NoClock, feeling};

/// A motor that keeps what it is driven with.
#[derive(Default)]
pub(crate) struct Kept {
    duty: f64,
}

impl MotorDriver for Kept {
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        self.duty = f64::from(duty.q15()) / 32_767.0;
        Ok(())
    }

    fn off(&mut self) {
        self.duty = 0.0;
    }

    fn clear(&mut self) {}
}

/// A whisker that does not turn.
pub(crate) struct Still;

impl AngleInput for Still {
    fn counts(&mut self) -> i32 {
        0
    }
}

const SETTINGS: Settings = Settings {
    tick_hz: 2000.0,
    frequency_hz: 8.0,
    integrator: Integrator::Exact,
    coupling: true,
    noise: 0.0,
    rcp: None,
    cia: Some(GateSettings {
        gain: 2.0,
        tau_s: 0.125,
    }),
};

/// A degree of error is 0.01 of duty; setpoints reach from 30° to 140°.
const PD: pd::Settings = pd::Settings {
    kp: 0.01,
    kd: 0.0,
    limit: 1.0,
    slew_per_s: 1e6,
    min_deg: 30.0,
    max_deg: 140.0,
    degrees_per_count: 0.1,
};

pub(crate) type Settable<R> = Config<ActiveConfig<R>, (), Option<filter::Config<R>>>;
pub(crate) type Whiskers<R> = Module<R, Bent, Active<R, Kept, Still, 1, 2>, (), NoClock, 1, 2>;

pub(crate) fn module<R: Real>() -> (Whiskers<R>, Settable<R>) {
    let config = Config {
        decoder: Decoder::new(),
        sensor_limits: AT_ONCE,
        contact: Some(filter::Config::new(filter::CORNER_HZ, 2000.0).unwrap()),
        motion: ActiveConfig {
            whisking: SETTINGS.build().unwrap(),
            servo: ServoConfig {
                pd: PD.build(2000.0).unwrap(),
                retry: design_parameters::retry(2000),
                guards: GuardSettings::NONE.build(2000.0),
                approach: R::ONE,
                homing: Absent,
            },
            stop_all: Absent,
        },
        perception: (),
        period: 0,
    };
    let start = SETTINGS.start([[1.0, 0.0]], [[1.0; 2]]).unwrap();
    let servo = || Servo::new(Kept::default(), Still);
    let active = Active::new(State::new(&start, 1), [[servo(), servo()]]);
    let mut module = Module::new([[Bent(0xC000), Bent(0xC000)]], active, (), NoClock);
    module.arm(true);
    (module, config)
}

const SECOND: Place = Place::new(0, 1);

/// Duties of both motors after a tick.
pub(crate) fn tick<R: Real>(module: &mut Whiskers<R>, config: &Settable<R>) -> [f64; 2] {
    module.tick(config, &mut |event| panic!("{event:?}"));
    let [servos] = module.motion_mut().servos_mut();
    servos.each_mut().map(|servo| servo.parts_mut().0.duty)
}

#[test]
fn a_setpoint_takes_the_place_of_the_pattern_generators_within_its_limits() {
    fn check<R: Real>() {
        let (mut module, config) = module::<R>();
        let (mut other, _) = self::module::<R>();
        // θ' is 100 θ + 50 degrees, and the whisker stands at 50 degrees.
        for (theta, duty) in [(0.3, 0.3), (-0.1, -0.1), (9.0, 0.9), (-9.0, -0.2)] {
            let setpoint = Command::Setpoint(Some(R::from_f64(theta)));
            module.command(SECOND, setpoint).unwrap();
            for _ in 0..100 {
                let [first, second] = tick(&mut module, &config);
                assert!((second - duty).abs() < 2e-4, "{theta}: {second}");
                assert_eq!(first, tick(&mut other, &config)[0], "the other whisks on");
            }
        }
        module.command(SECOND, Command::Setpoint(None)).unwrap();
        assert_eq!(tick(&mut module, &config), tick(&mut other, &config));
        let state = module.motion().servos()[0][1].state();
        assert!(matches!(state, ServoState::Running { .. }), "{state:?}");
    }
    check::<f32>();
    check::<f64>();
    check::<Fix>();
}

#[test]
fn gains_stay_within_0_and_2_whatever_is_commanded() {
    fn check<R: Real>(wild: &[R]) {
        let (mut module, config) = module::<R>();
        // Contact lifts g as far as it goes.
        for _ in 0..200 {
            tick(&mut module, &config);
        }
        let gain = |module: &Whiskers<R>| module.motion().state().whiskers[0][1].gain();
        assert!(gain(&module) > 1.2, "{}", gain(&module));
        let commanded = [0.5, 2.0, 0.0, 3.0, -1.0].map(R::from_f64);
        for gain_wanted in commanded.iter().chain(wild) {
            module.command(SECOND, Command::Gain(*gain_wanted)).unwrap();
            let nominal = module.motion().state().whiskers[0][1].nominal();
            let expected = gain_wanted.clamp(R::ZERO, R::TWO);
            assert_eq!(nominal, expected);
            for _ in 0..20 {
                assert!((0.0..=2.0).contains(&gain(&module)), "{}", gain(&module));
                tick(&mut module, &config);
            }
            assert_eq!(module.motion().state().whiskers[0][0].nominal(), R::ONE);
        }
    }
    check::<f32>(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
    check::<f64>(&[f64::NAN, f64::MAX]);
    check::<Fix>(&[Fix(i32::MAX), Fix(i32::MIN)]);
}

#[test]
fn whiskers_that_are_not_there_or_passive_are_refused() {
    let (mut module, _) = module::<f32>();
    for (side, whisker) in [(0, 2), (1, 0), (255, 255)] {
        let place = Place { side, whisker };
        for command in [Command::Gain(1.0), Command::Setpoint(None)] {
            assert_eq!(module.command(place, command), Err(NoActiveWhisker));
        }
    }
    let mut passive = Module::<f32, _, _, _, _, 1, 1>::new([[Bent(0xC000)]], Passive, (), NoClock);
    let refused = passive.command(Place::new(0, 0), Command::Gain(1.0));
    assert_eq!(refused, Err(NoActiveWhisker));
    passive.tick(&feeling(Absent), &mut |event| panic!("{event:?}"));
}
