//! Configurations as bytes: whatever they are, they give a good one or a refusal.

use firmware::{
    BoardCode, Config, ConfigError, Field, HEADER_BYTES, MotionConfig, Part, ServoConfig, decode,
    encode, refusal_code, refusal_of,
};
use proptest::prelude::*;
use tactile::{ClassSetting, Deciding, RuleSettings, Threshold};
use whisking::motor::{
    Duty, GuardConfig, GuardSettings, HomingSettings, ModelConfig, ModelSettings,
};
use whisking::{Fix, Number, pd};

use crate::command::{Whiskers, module};

const BOARD: BoardCode = BoardCode::NucleoF446re;

const PD: pd::Settings = pd::Settings {
    kp: 0.05,
    kd: 0.0004,
    limit: 1.0,
    slew_per_s: 400.0,
    min_deg: 30.0,
    max_deg: 160.0,
    degrees_per_count: 0.064,
};

const GUARDS: GuardSettings = GuardSettings {
    degrees_per_count: PD.degrees_per_count,
    hard_duty: 0.5,
    model: Some(ModelSettings {
        speed_deg_s: 12_000.0,
        time_constant_s: 0.048,
        friction_duty: 0.06,
        duty_limit: PD.limit,
        slew_per_s: PD.slew_per_s,
    }),
    following_deg: 40.0,
    top_speed_deg_s: 15_000.0,
    travel_deg: [10.0, 180.0],
    continuous_duty: 0.4,
};

const HOMING: HomingSettings = HomingSettings {
    degrees_per_count: PD.degrees_per_count,
    duty: 0.1,
    stop_deg: 30.0,
    max_deg: 160.0,
    far_stop_deg: Some(170.0),
    every_s: 20.0,
    calm: 0.05,
};

fn config<R: Number>() -> Config<R> {
    let (_, mut config) = module::<R>();
    let servo = &mut config.motion.as_mut().unwrap().servo;
    servo.pd = PD.build(2000.0).unwrap();
    servo.guards = GUARDS.build(2000.0);
    servo.homing = Some(HOMING.build(2000.0));
    config.classifier = Some(firmware::ClassifierConfig {
        rule: Some(RuleSettings::Sequential(Threshold::new(0.99).unwrap())),
        deciding: Deciding::Each,
        contact_min: Some(R::from_f64(0.05)),
        says_pose: false,
    });
    let classes = [(0.25, Some(0.999)), (1.0, None), (0.5, Some(0.6))];
    let classes = classes.map(|(share, threshold)| ClassSetting::new(share, threshold));
    config.classes = classes.into_iter().collect();
    config
}

fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let mut digest = crc.digest();
    digest.update(&bytes[4..12]);
    digest.update(&bytes[HEADER_BYTES..]);
    let sum = digest.finalize().to_le_bytes();
    bytes[12..16].copy_from_slice(&sum);
    bytes
}

#[test]
fn what_was_written_is_read_in_every_number_format() {
    fn check<R: Number>() {
        let config = config::<R>();
        let mut bytes = encode(&config, BOARD).unwrap().to_vec();
        assert_eq!(decode::<R>(&bytes, BOARD).as_ref(), Ok(&config));
        // What follows it in flash is not looked at.
        bytes.extend([0xFF; 64]);
        assert_eq!(decode::<R>(&bytes, BOARD), Ok(config));
    }
    check::<f32>();
    check::<f64>();
    check::<Fix>();
}

#[test]
fn another_version_board_or_format_is_refused_by_name() {
    let bytes = encode(&config::<f32>(), BOARD).unwrap().to_vec();
    let other = BoardCode::NucleoG071rb;
    assert_eq!(decode::<f32>(&bytes, other), Err(ConfigError::Board(1)));
    assert_eq!(decode::<Fix>(&bytes, BOARD), Err(ConfigError::Format(1)));
    let mut later = bytes.clone();
    later[4] += 1;
    let version = firmware::VERSION + 1;
    let refused = decode::<f32>(&summed(later), BOARD);
    assert_eq!(refused, Err(ConfigError::Version(version)));
    let of_all = |byte| decode::<f32>(&[byte; 4096], BOARD).unwrap_err();
    assert_eq!(
        [0xFF, 0].map(of_all),
        [ConfigError::Absent, ConfigError::Strange]
    );
    for length in 0..bytes.len() {
        let refused = decode::<f32>(&bytes[..length], BOARD).unwrap_err();
        let is_cut = matches!(refused, ConfigError::Absent | ConfigError::TooLong);
        assert!(is_cut, "{length}: {refused}");
    }
}

#[test]
fn values_out_of_range_are_refused_by_the_name_of_their_field() {
    type Change = fn(&mut Config<f32>);
    fn motion(config: &mut Config<f32>) -> &mut MotionConfig<f32> {
        config.motion.as_mut().unwrap()
    }
    let changes: [(Change, Field); 14] = [
        (|c| c.head.tick_hz = 0, Field::TickHz),
        (|c| c.head.sides = 3, Field::Sides),
        (|c| c.head.whiskers_per_side = 0, Field::Whiskers),
        (|c| c.links.serial_baud = Some(0), Field::SerialBaud),
        (
            |c| c.contact.as_mut().unwrap().first = f32::NAN,
            Field::Contact,
        ),
        (|c| motion(c).servo.pd.kp = -1.0, Field::Kp),
        (|c| motion(c).servo.pd.min = f32::INFINITY, Field::Angles),
        (|c| motion(c).servo.guards.heat_shift = 32, Field::Guards),
        (|c| motion(c).whisking.peak_gain = f32::NAN, Field::Muscles),
        (|c| motion(c).start.whiskers[1].side = 1, Field::Start),
        (
            |c| motion(c).whisking.cia.as_mut().unwrap().gain = 1e9,
            Field::Cia,
        ),
        (
            |c| c.classifier.as_mut().unwrap().rule = Some(RuleSettings::Window(0)),
            Field::Window,
        ),
        (|c| c.classes[1].prior = 1, Field::Classes),
        (|c| c.classes[0].threshold = u16::MAX, Field::Classes),
    ];
    for (change, field) in changes {
        let mut config = config();
        change(&mut config);
        let bytes = encode(&config, BOARD).unwrap();
        let refused = decode::<f32>(&bytes, BOARD);
        assert_eq!(refused, Err(ConfigError::Range(field)), "{field}");
    }
}

/// What a board refuses, and a simulation, which cannot be harmed, takes: each guard, left out or
/// as wide as it can be.
#[test]
fn limits_that_would_not_protect_are_refused_by_a_board() {
    fn check<R: Number>(field: Field, change: impl Fn(&mut ServoConfig<R>)) {
        let mut config = config::<R>();
        let servo = &mut config.motion.as_mut().unwrap().servo;
        // Without gains every motor settles.
        servo.pd.kp = R::coefficient(0.0);
        servo.pd.kd = R::coefficient(0.0);
        change(servo);
        let refused = |board| {
            let bytes = encode(&config, board).unwrap();
            decode::<R>(&bytes, board).err()
        };
        assert_eq!(refused(BoardCode::Simulation), None, "{field}");
        assert_eq!(refused(BOARD), Some(ConfigError::Range(field)), "{field}");
    }
    fn all<R: Number>() {
        let guards = |field, change: fn(&mut GuardConfig<R>)| {
            check::<R>(field, |servo| change(&mut servo.guards));
        };
        let model = |field, change: fn(&mut ModelConfig<R>)| {
            check::<R>(field, |servo| change(servo.guards.model.as_mut().unwrap()));
        };
        let number = R::from_f64;
        guards(Field::Friction, |guards| guards.model = None);
        guards(Field::Guards, |guards| guards.stall.threshold = Duty::FULL);
        guards(Field::Guards, |guards| guards.stall.ticks = u16::MAX);
        guards(Field::Guards, |guards| guards.against = u32::MAX);
        guards(Field::Following, |guards| guards.error = R::from_f64(1.0));
        guards(Field::Guards, |guards| guards.error_ticks = u16::MAX);
        guards(Field::Travel, |guards| guards.travel[0] = i32::MIN);
        guards(Field::Travel, |guards| guards.travel[1] = i32::MAX);
        guards(Field::TopSpeed, |guards| guards.speed = u32::MAX);
        guards(Field::Heat, |guards| guards.heat = 1 << 30);
        guards(Field::Heat, |guards| guards.heat_shift = 31);
        model(Field::Friction, |model| model.friction = R::from_f64(0.3));
        model(Field::TopSpeed, |model| model.speed = R::coefficient(1e-3));
        model(Field::TimeConstant, |model| {
            model.rate = R::coefficient(2e-4);
        });
        model(Field::Guards, |model| model.missing = R::from_f64(0.1));
        model(Field::Guards, |model| model.doubt = R::from_f64(0.1));
        model(Field::Guards, |model| model.shown = R::coefficient(0.1));
        model(Field::Guards, |model| model.turned = 0);
        model(Field::Guards, |model| model.stroke = u16::MAX);
        model(Field::Guards, |model| model.grace = u16::MAX);
        check::<R>(Field::Angles, |servo| servo.pd.max = number(2.5));
        check::<R>(Field::Angles, |servo| servo.pd.min = number(-2.0));
        check::<R>(Field::Retry, |servo| servo.retry.window = 0);
        check::<R>(Field::Retry, |servo| servo.retry.rest = 0);
        let homing = |change: fn(&mut whisking::motor::HomingConfig)| {
            check::<R>(Field::Homing, |servo| {
                change(servo.homing.as_mut().unwrap());
            });
        };
        homing(|homing| homing.duty = Duty::FULL);
        homing(|homing| homing.time_out = u16::MAX);
    }
    all::<f32>();
    all::<f64>();
    all::<Fix>();
}

#[test]
fn no_name_has_what_could_begin_a_line() {
    let refused = Err(ConfigError::Range(Field::Name));
    for [name, overrides] in [
        ["a\r\nok stop", ""],
        ["\u{9b}2J", ""],
        ["a", "motor.kp=0.1\nok stop"],
        ["a", "\u{1b}"],
    ] {
        let mut config = config::<f32>();
        config.head.name = name.try_into().unwrap();
        config.head.overrides = overrides.try_into().unwrap();
        let bytes = encode(&config, BOARD).unwrap();
        let found = decode::<f32>(&bytes, BOARD);
        assert_eq!(found, refused, "{name:?} {overrides:?}");
    }
}

#[test]
fn a_refusal_is_known_by_its_numbers() {
    let parts = Part::ALL.iter().copied();
    let fields = Field::ALL.iter().copied();
    let errors = [
        ConfigError::Absent,
        ConfigError::Strange,
        ConfigError::Version(7),
        ConfigError::Board(9),
        ConfigError::Format(2),
        ConfigError::TooLong,
        ConfigError::Damaged,
    ]
    .into_iter()
    .chain(parts.clone().map(ConfigError::Unreadable))
    .chain(parts.map(ConfigError::NotBuilt))
    .chain(fields.clone().map(ConfigError::Range))
    .chain(fields.clone().map(ConfigError::Room))
    .chain(fields.clone().map(ConfigError::Shape))
    .chain(fields.map(ConfigError::Armed));
    for error in errors {
        assert_eq!(refusal_of(refusal_code(error)), Some(error));
    }
    assert_eq!(refusal_of([99, 0]), None);
    assert_eq!(refusal_of([10, -1]), None);
}

/// A module made by a configuration ticks without a panic, whatever its numbers.
fn ticks<R: Number>(config: &Config<R>) {
    if config.head.sides != 1 || config.head.whiskers_per_side != 2 || config.motion.is_none() {
        return;
    }
    let (mut module, _): (Whiskers<R>, _) = module::<R>();
    for _ in 0..20 {
        module.tick(config, &mut |_| {});
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn any_change_of_its_bytes_gives_a_good_configuration_or_a_refusal(
        at in any::<prop::sample::Index>(),
        to in prop::collection::vec(any::<u8>(), 1..9),
    ) {
        fn check<R: Number>(at: prop::sample::Index, to: &[u8]) {
            let mut bytes = encode(&config::<R>(), BOARD).unwrap().to_vec();
            let at = HEADER_BYTES + at.index(bytes.len() - HEADER_BYTES);
            for (place, byte) in bytes.iter_mut().skip(at).zip(to) {
                *place = *byte;
            }
            // Without the right sum it is damaged, with it, it is read and checked.
            if let Ok(config) = decode::<R>(&summed(bytes), BOARD) {
                assert_eq!(config.check(), Ok(()));
                ticks(&config);
            }
        }
        check::<f32>(at, &to);
        check::<f64>(at, &to);
        check::<Fix>(at, &to);
    }
}
