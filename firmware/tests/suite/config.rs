//! Configurations as bytes: whatever they are, they give a good one or a refusal.

use firmware::{
    BoardCode, Config, ConfigError, Field, HEADER_BYTES, Part, decode, encode, refusal_code,
    refusal_of,
};
use proptest::prelude::*;
use tactile::{Deciding, RuleSettings, Threshold};
use whisking::{Fix, Number};

use crate::command::{Whiskers, module};

const BOARD: BoardCode = BoardCode::NucleoF446re;

/// An active module that decides.
fn config<R: Number>() -> Config<R> {
    let (_, mut config) = module::<R>();
    config.classifier = Some(firmware::ClassifierConfig {
        rule: Some(RuleSettings::Sequential(Threshold::new(0.99).unwrap())),
        deciding: Deciding::Each,
        contact_min: Some(R::from_f64(0.05)),
    });
    config
}

/// The same bytes with the sum that belongs to them.
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
        println!("{} bytes", bytes.len());
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
    assert_eq!(
        decode::<f32>(&[0xFF; 4096], BOARD),
        Err(ConfigError::Absent)
    );
    assert_eq!(decode::<f32>(&[0; 4096], BOARD), Err(ConfigError::Strange));
    for length in 0..bytes.len() {
        let refused = decode::<f32>(&bytes[..length], BOARD).unwrap_err();
        let is_cut = matches!(refused, ConfigError::Absent | ConfigError::TooLong);
        assert!(is_cut, "{length}: {refused}");
    }
}

#[test]
fn values_out_of_range_are_refused_by_the_name_of_their_field() {
    type Change = fn(&mut Config<f32>);
    let changes: [(Change, Field); 12] = [
        (|c| c.head.tick_hz = 0, Field::TickHz),
        (|c| c.head.sides = 3, Field::Sides),
        (|c| c.head.whiskers_per_side = 0, Field::Whiskers),
        (|c| c.links.serial_baud = Some(0), Field::SerialBaud),
        (
            |c| c.contact.as_mut().unwrap().first = f32::NAN,
            Field::Contact,
        ),
        (|c| c.motion.as_mut().unwrap().servo.pd.kp = -1.0, Field::Kp),
        (
            |c| c.motion.as_mut().unwrap().servo.pd.min = f32::INFINITY,
            Field::Angles,
        ),
        (
            |c| c.motion.as_mut().unwrap().servo.guards.heat_shift = 32,
            Field::Guards,
        ),
        (
            |c| c.motion.as_mut().unwrap().whisking.peak_gain = f32::NAN,
            Field::Muscles,
        ),
        (
            |c| c.motion.as_mut().unwrap().start.whiskers[1].side = 1,
            Field::Start,
        ),
        (
            |c| {
                let motion = c.motion.as_mut().unwrap();
                motion.whisking.cia.as_mut().unwrap().gain = 1e9;
            },
            Field::Cia,
        ),
        (
            |c| c.classifier.as_mut().unwrap().rule = Some(RuleSettings::Window(0)),
            Field::Window,
        ),
    ];
    for (change, field) in changes {
        let mut config = config();
        change(&mut config);
        let bytes = encode(&config, BOARD).unwrap();
        let refused = decode::<f32>(&bytes, BOARD);
        assert_eq!(refused, Err(ConfigError::Range(field)), "{field}");
    }
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
        assert_eq!(
            decode::<f32>(&bytes, BOARD),
            refused,
            "{name:?} {overrides:?}"
        );
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
