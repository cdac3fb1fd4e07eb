//! Commands between ticks: the nominal gain and the setpoint of a whisker.

use firmware::{
    Command, Config, Driver, HeadConfig, Module, MotionConfig, NoActiveWhisker, Place, Servo,
    ServoConfig, ServoState, Whisker, WhiskerParts, design_parameters,
};
use whisking::motor::GuardSettings;
use whisking::{Fix, GateSettings, Integrator, Number, Settings, filter, pd};

use crate::hardware::{Bent, NoClock, Rig, Toy, feeling, passive};

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
pub(crate) const PD: pd::Settings = pd::Settings {
    kp: 0.01,
    kd: 0.0,
    limit: 1.0,
    slew_per_s: 1e6,
    min_deg: 30.0,
    max_deg: 140.0,
    degrees_per_count: 0.1,
};

pub(crate) type Whiskers<R> = Module<R, Toy<Bent>>;

pub(crate) fn module<R: Number>() -> (Whiskers<R>, Config<R>) {
    let h50 = filter::Config::new(filter::CORNER_HZ, 2000.0).unwrap();
    let feeling = feeling(Some(h50));
    let config = Config {
        head: HeadConfig {
            name: "a scene of bench".try_into().unwrap(),
            sides: 1,
            ..feeling.head.clone()
        },
        motion: Some(MotionConfig {
            whisking: SETTINGS.build().unwrap(),
            start: SETTINGS.start(&[[1.0, 0.0]], &[&[1.0; 2]]).unwrap(),
            seed: 1,
            servo: ServoConfig {
                pd: PD.build(2000.0).unwrap(),
                retry: design_parameters::retry(2000),
                guards: GuardSettings::NONE.build(2000.0),
                approach: R::ONE,
                homing: None,
            },
            driver: Driver::HBridge,
            stops_all: false,
            arms_at_start: true,
        }),
        ..feeling
    };
    let whisker = || WhiskerParts {
        source: Bent(0xC000),
        motor: Some((Rig::default(), Rig::default())),
    };
    let mut module = Module::new(&config, [whisker(), whisker()], None, (NoClock, 0));
    module.arm(true);
    (module, config)
}

const SECOND: Place = Place::new(0, 1);

pub(crate) fn servo<R: Number>(module: &Whiskers<R>) -> &Servo<R, Rig, Rig> {
    module.whiskers().get(1).and_then(Whisker::servo).unwrap()
}

pub(crate) fn nominal<R: Number>(module: &Whiskers<R>, n: usize) -> R {
    module.motion().unwrap().state().whiskers[n].nominal()
}

pub(crate) fn tick<R: Number>(module: &mut Whiskers<R>, config: &Config<R>) -> [f64; 2] {
    module.tick(config, &mut |event| panic!("{event:?}"));
    [0, 1].map(|n| module.whiskers()[n].servo().unwrap().motor().duty())
}

#[test]
fn a_setpoint_takes_the_place_of_the_pattern_generators_within_its_limits() {
    fn check<R: Number>() {
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
        let state = servo(&module).state();
        assert!(matches!(state, ServoState::Running { .. }), "{state:?}");
    }
    check::<f32>();
    check::<f64>();
    check::<Fix>();
}

#[test]
fn gains_stay_within_0_and_2_whatever_is_commanded() {
    fn check<R: Number>(wild: &[R]) {
        let (mut module, config) = module::<R>();
        // Contact lifts g as far as it goes.
        for _ in 0..200 {
            tick(&mut module, &config);
        }
        let gain = |module: &Whiskers<R>| module.motion().unwrap().state().whiskers[1].gain();
        assert!(gain(&module) > 1.2, "{}", gain(&module));
        let commanded = [0.5, 2.0, 0.0, 3.0, -1.0].map(R::from_f64);
        for gain_wanted in commanded.iter().chain(wild) {
            module.command(SECOND, Command::Gain(*gain_wanted)).unwrap();
            let nominal = nominal(&module, 1);
            let expected = gain_wanted.clamp(R::ZERO, R::TWO);
            assert_eq!(nominal, expected);
            for _ in 0..20 {
                assert!((0.0..=2.0).contains(&gain(&module)), "{}", gain(&module));
                tick(&mut module, &config);
            }
            assert_eq!(self::nominal(&module, 0), R::ONE);
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
            assert_eq!(module.command(place, command), Err(NoActiveWhisker.into()));
        }
    }
    let config = feeling::<f32>(None);
    let mut passive = passive(&config, [Bent(0xC000)]);
    let refused = passive.command(Place::new(0, 0), Command::Gain(1.0));
    assert_eq!(refused, Err(NoActiveWhisker.into()));
    passive.tick(&config, &mut |event| panic!("{event:?}"));
}
