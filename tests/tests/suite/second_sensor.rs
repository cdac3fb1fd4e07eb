//! A module's sensor that is a TMAG5170 below a magnet: what its words are, and what becomes
//! of each fault of the part and of its wires.

use firmware::{
    Event, FULL_SCALE, Place, Reading, Sensor, SensorFault, SensorHealth, SensorLimits, TiltFault,
    TiltScale, TiltSource,
};
use host_sim::bus::tmag5170::{LineFault, TmagSlave};
use mlx90333::{Decoder, Word};
use physics::Magnet;
use proptest::prelude::*;
use tmag5170::{Config, Range, ReplyError, StatusFaults, Version};

const LIMITS: SensorLimits = SensorLimits {
    hold: 4,
    recover: 3,
    resync: 0,
    stale: 1000,
    frozen: 2000,
    jump: u16::MAX,
    burst: 1000,
    zero: None,
    swing: None,
};

const PLACE: Place = Place::new(0, 0);

struct Whisker {
    sensor: Sensor<TiltSource<TmagSlave>>,
    magnet: Magnet,
    events: Vec<Event>,
}

impl Whisker {
    /// After the tick that configures it.
    fn new(axial_mt: f64) -> Self {
        let source = TiltSource::of_module(TmagSlave::new(Version::A1));
        let mut whisker = Self {
            sensor: Sensor::new(source, false),
            magnet: Magnet::of_field(axial_mt).unwrap(),
            events: Vec::new(),
        };
        assert!(!whisker.tick([0.0; 2]).fresh);
        whisker
    }

    fn slave(&mut self) -> &mut TmagSlave {
        self.sensor.source_mut().sensor_mut().spi_mut()
    }

    /// One tick with the whisker's base turned by this, rad.
    fn tick(&mut self, tilt_rad: [f64; 2]) -> Reading {
        self.tick_in(self.magnet.field_mt(tilt_rad))
    }

    fn tick_in(&mut self, field_mt: [f64; 3]) -> Reading {
        self.slave().set_field(field_mt);
        let events = &mut self.events;
        let mut note = |event| events.push(event);
        self.sensor.read(Decoder::new(), &LIMITS, PLACE, &mut note)
    }

    fn is_trusted(&self) -> bool {
        matches!(self.sensor.health(), SensorHealth::Ok { .. })
    }
}

/// A whisker that this befalls, and what it is lost for; until then a reading is held.
#[track_caller]
fn lost_by(befall: impl FnOnce(&mut TmagSlave)) -> (Whisker, SensorFault) {
    let mut whisker = Whisker::new(60.0);
    let before = whisker.tick([0.05, 0.0]);
    befall(whisker.slave());
    for _ in 0..LIMITS.hold {
        let held = whisker.tick([0.02, 0.0]);
        assert_eq!((held.x, held.fresh, held.valid), (before.x, false, true));
        assert!(whisker.events.is_empty(), "{:?}", whisker.events);
    }
    whisker.tick([0.02, 0.0]);
    let Some(Event::SensorLost(PLACE, fault)) = whisker.events.pop() else {
        panic!("not lost");
    };
    assert!(!whisker.is_trusted());
    (whisker, fault)
}

/// Ticks until it is trusted again.
fn back(whisker: &mut Whisker) -> u16 {
    for tick in 0..20 {
        if whisker.tick([0.05, 0.0]).fresh {
            assert_eq!(whisker.events.pop(), Some(Event::SensorBack(PLACE)));
            return tick;
        }
    }
    panic!("not back");
}

#[test]
fn each_line_fault_switches_the_whisker_off_until_it_is_mended() {
    let reply = |error| SensorFault::Tilt(TiltFault::Reply(error));
    let faults = [
        (LineFault::Silent, reply(ReplyError::NoSensor), 27),
        (LineFault::SdoLow, reply(ReplyError::LineLow), 28),
        (LineFault::SdiLow, reply(ReplyError::Rejected), 29),
        (LineFault::FlipCommand(9), reply(ReplyError::Rejected), 29),
        (LineFault::Bus, SensorFault::Bus, 17),
    ];
    for (fault, expected, number) in faults {
        let (mut whisker, reported) = lost_by(|slave| slave.set_fault(Some(fault)));
        assert_eq!((reported, reported.code()), (expected, number), "{fault:?}");
        whisker.slave().set_fault(None);
        // One more where what the sensor noticed is read first.
        let ticks = back(&mut whisker);
        assert!(
            (LIMITS.recover - 1..=LIMITS.recover).contains(&ticks),
            "{fault:?}: {ticks}"
        );
    }
}

#[test]
fn each_fault_that_the_sensor_reports_is_logged_by_name() {
    for known in StatusFaults::KNOWN {
        if known.bit == StatusFaults::RESTARTED {
            continue;
        }
        let (mut whisker, reported) = lost_by(|slave| slave.set_report(known.bit));
        assert_eq!(reported, SensorFault::Tilt(TiltFault::Reported(known.bit)));
        assert_eq!(
            reported.to_string(),
            format!("the TMAG5170 reports an error: {}", known.name)
        );
        whisker.slave().set_report(StatusFaults::NONE);
        assert_eq!(back(&mut whisker), LIMITS.recover - 1);
    }
}

#[test]
fn a_sensor_that_restarts_is_configured_again() {
    let mut whisker = Whisker::new(60.0);
    whisker.tick([0.1, 0.0]);
    whisker.slave().restart();
    // The restart is seen, the sensor set up, and read.
    assert!(!whisker.tick([0.1, 0.0]).fresh);
    assert!(!whisker.tick([0.1, 0.0]).fresh);
    assert!(whisker.tick([0.1, 0.0]).fresh);
    assert!(whisker.events.is_empty() && whisker.is_trusted());
}

#[test]
fn a_magnet_that_is_gone_or_upside_down_is_a_fault() {
    for axial_mt in [0.0, -60.0] {
        let mut whisker = Whisker::new(60.0);
        whisker.tick([0.0; 2]);
        let mut fault = None;
        for _ in 0..=LIMITS.hold {
            whisker.tick_in([0.0, 0.0, axial_mt]);
            fault = whisker.events.pop();
        }
        let expected = SensorFault::Tilt(TiltFault::NoMagnet);
        assert_eq!(fault, Some(Event::SensorLost(PLACE, expected)));
        assert_eq!(expected.code(), 31);
    }
}

/// Beyond its range a field is larger than it reads; noise is all that changes.
#[test]
fn a_field_at_the_end_of_its_range_is_no_tilt_and_no_fault() {
    for field in [[2.0, 1.0, 130.0], [30.0, 0.0, 60.0], [0.0, -30.0, 60.0]] {
        let mut whisker = Whisker::new(60.0);
        *whisker.slave() = whisker.slave().clone().with_noise(1);
        whisker.tick([0.0; 2]);
        for _ in 0..2 * LIMITS.frozen {
            let reading = whisker.tick_in(field);
            assert!(reading.fresh && reading.current);
            assert_eq!([reading.x, reading.y].map(Word::signed14), [8191; 2]);
        }
        assert!(whisker.events.is_empty(), "{:?}", whisker.events);
    }
}

#[test]
fn a_sensor_that_stands_still_is_a_fault() {
    let mut whisker = Whisker::new(60.0);
    whisker.slave().set_fault(Some(LineFault::Frozen));
    let frozen = (0..=LIMITS.frozen + 2).any(|tick| {
        whisker.tick([0.1 / f64::from(tick + 1), 0.0]);
        whisker.events.last() == Some(&Event::SensorLost(PLACE, SensorFault::Frozen))
    });
    assert!(frozen);
}

#[test]
fn ranges_that_do_not_fit_are_refused() {
    let is_refused = |ranges, full_scale| {
        let mut config = Config::default();
        config.sensor.ranges = ranges;
        TiltScale::new(&config, full_scale).is_none()
    };
    let quarter = [Range::Narrow, Range::Narrow, Range::Wide];
    assert_eq!(
        [0.06, 0.07].map(|full| is_refused(quarter, full)),
        [true, false]
    );
    let equal = [Range::Wide; 3];
    assert_eq!(
        [0.24, 0.26].map(|full| is_refused(equal, full)),
        [true, false]
    );
    for full_scale in [0.0, -0.1, f32::NAN, f32::INFINITY] {
        assert!(is_refused(quarter, full_scale));
    }
}

proptest! {
    /// Whatever the magnet's strength, within its range; more than a full scale is one.
    #[test]
    fn words_are_the_tilt_whatever_the_strength_of_the_magnet(
        axial_mt in 20.0_f64..95.0, x in -0.2_f64..0.2, y in -0.2_f64..0.2,
    ) {
        let mut whisker = Whisker::new(axial_mt);
        let reading = whisker.tick([x, y]);
        let tan = f64::hypot(x, y).tan() / f64::hypot(x, y).max(1e-9);
        for (word, tilt) in [(reading.x, x), (reading.y, y)] {
            let expected = (tilt * tan / f64::from(FULL_SCALE)).clamp(-1.0, 1.0);
            // A code of the word, and half a code of each field, of which Z counts least.
            let tolerance = 1.0 / 8191.0 + 1.2 * (12.5 / 32_768.0) / (0.5 * axial_mt * 0.15)
                + 50.0 / 32_768.0 / axial_mt;
            let normalised = f64::from(word.normalised());
            prop_assert!((normalised - expected).abs() < tolerance, "{normalised} {expected}");
        }
    }

    /// Any bytes that a bus may give have an answer.
    #[test]
    fn any_bit_flipped_anywhere_is_bridged_or_a_fault(
        flips in prop::collection::vec((0_u8..32, any::<bool>()), 1..40),
    ) {
        let mut whisker = Whisker::new(60.0);
        whisker.tick([0.1, 0.0]);
        let before = whisker.tick([0.1, 0.0]);
        for (bit, command) in flips {
            let fault = if command {
                LineFault::FlipCommand(bit)
            } else {
                LineFault::FlipReply(bit)
            };
            whisker.slave().inject(fault, 1);
            let reading = whisker.tick([0.1, 0.0]);
            prop_assert!(!reading.fresh || reading.x == before.x);
        }
    }
}
