//! A board's self-test, over the mock bus as over a board's.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use firmware::boards::Pacing;
use firmware::faults::number;
use firmware::{READINGS, SelfTest};
use mlx90333::timing::SS_HIGH_US;
use mlx90333::{Decoder, Faults, Mlx90333};

use super::super::{SimSpiError, Slave, WireFault};

const PACING: Pacing = Pacing {
    gap_ns: 25_000,
    rest_us: 60,
};

/// Adds up for how long the core has waited, ns.
#[derive(Default)]
struct Waited(u64);

impl DelayNs for Waited {
    fn delay_ns(&mut self, ns: u32) {
        self.0 += u64::from(ns);
    }
}

struct Shaken(Slave, u32);

impl ErrorType for Shaken {
    type Error = SimSpiError;
}

impl SpiDevice for Shaken {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), SimSpiError> {
        // Codes of x are 10 and 14 in turn, of y 0 and 1.
        let code = |code: u32| f64::from(code) / 8191.0;
        let odd = self.1 % 2;
        self.0.set([code(10 + 4 * odd), code(odd)]);
        self.1 += 1;
        self.0.transaction(operations)
    }
}

/// What it finds, the faults of it, and for how long the core has waited, ns.
fn test(slave: &mut Slave) -> (SelfTest, Vec<(u8, u8)>, u64) {
    let mut waited = Waited::default();
    let mut sensor = Mlx90333::new(slave.clone(), Decoder::new());
    let found = SelfTest::of(&mut sensor, &mut waited, PACING);
    *slave = sensor.release();
    let faults = found.faults().collect();
    (found, faults, waited.0)
}

#[test]
fn a_sensor_at_rest_gives_sixteen_frames_without_noise() {
    let mut slave = Slave::default();
    let (found, faults, waited_ns) = test(&mut slave);
    assert_eq!(found.good(), READINGS);
    assert_eq!((faults, found.noise_tenths()), (vec![], [0, 0]));
    let traffic = slave.traffic;
    assert_eq!((traffic.transactions, traffic.bytes), (16, 16 * 8));
    assert_eq!(traffic.delay_ns, 16 * 7 * u64::from(PACING.gap_ns));
    assert_eq!(waited_ns, 16 * 60_000);
}

/// Root mean squares of 2 and of 0.5 codes; the root is up to 6.1 % large.
#[test]
fn noise_is_that_of_each_channel() {
    let mut sensor = Mlx90333::new(Shaken(Slave::default(), 0), Decoder::new());
    let found = SelfTest::of(&mut sensor, &mut Waited::default(), PACING);
    let [x, y] = found.noise_tenths();
    assert_eq!(found.good(), READINGS);
    assert!((20..=21).contains(&x) && (5..=6).contains(&y), "{x} {y}");
}

#[test]
fn faults_are_counted_by_their_numbers_and_each_is_rested_after() {
    let mut slave = Slave::default();
    slave.inject(WireFault::BadSum, 3);
    let (found, faults, waited_ns) = test(&mut slave);
    assert_eq!((found.good(), faults), (13, vec![(number::BAD_SUM, 3)]));
    // For as long as a sensor needs to find the next frame's start.
    let rested_ns = 3 * u64::from(SS_HIGH_US) * 1_000;
    assert_eq!(waited_ns, 13 * 60_000 + rested_ns);
    for (fault, expected) in [
        (WireFault::Silent, number::NO_SENSOR),
        (WireFault::LineLow, number::LINE_LOW),
        (WireFault::Flip(0), number::BAD_START),
        (WireFault::LowAfterStart, number::STUCK_WORDS),
        (WireFault::Bus, number::BUS),
    ] {
        let mut slave = Slave::default();
        slave.set_fault(Some(fault));
        let (found, faults, _) = test(&mut slave);
        assert_eq!((found.good(), found.noise_tenths()), (0, [0, 0]));
        assert_eq!(faults, [(expected, READINGS)]);
    }
    let mut slave = Slave::default();
    slave.set_error_word(Faults::FIELD_TOO_LOW);
    let (_, faults, _) = test(&mut slave);
    assert_eq!(faults, [(number::SENSOR_REPORT, READINGS)]);
}
