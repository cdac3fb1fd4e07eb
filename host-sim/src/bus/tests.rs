//! The bus against hand-written frames, and through the real driver.

mod self_test;

use embedded_hal::spi::{Operation, SpiDevice};
use firmware::{BusError, FrameSource, Polled};
use mlx90333::{Decoder, Error, Faults, FrameError, Mlx90333, Mode, SumRule, Word};
use proptest::prelude::*;

use super::{SimSpiError, Slave, WireFault};

const REST: [u8; 8] = [0xFF, 0x00, 0x80, 0x00, 0x80, 0x00, 0x00, 0x00];

fn still() -> Slave {
    Slave::default().without_noise()
}

fn read(slave: &mut Slave) -> [u8; 8] {
    let mut bytes = [0xFF; 8];
    slave.transfer_in_place(&mut bytes).unwrap();
    bytes
}

fn driver() -> Mlx90333<Slave> {
    Mlx90333::new(still(), Decoder::new())
}

#[test]
fn deflections_become_these_bytes() {
    let mut slave = still();
    assert_eq!(read(&mut slave), REST);
    // x = 1: code 16383, word 0xFFFC. y = −1: code 1, word 0x0004.
    slave.set([1.0, -1.0]);
    assert_eq!(read(&mut slave), [0xFF, 0xFC, 0xFF, 0x04, 0, 0, 0, 0xFF]);
    // x = 0.25: 2047.75 rounds to 2048, code 10240, word 0xA000; y = 0.
    slave.set([0.25, 0.0]);
    assert_eq!(read(&mut slave), [0xFF, 0x00, 0xA0, 0x00, 0x80, 0, 0, 0x20]);
    slave.set([f64::INFINITY, f64::NAN]);
    assert_eq!(read(&mut slave), [0xFF, 0xFC, 0xFF, 0x00, 0x80, 0, 0, 0x7B]);
}

#[test]
fn mode_and_sum_rule_are_the_sensor_s() {
    let mut slave = Slave::of(Decoder::with(Mode::Xyz, SumRule::ComplementB1B6)).without_noise();
    slave.set([0.25, 0.0]);
    let frame = [0xFF, 0x00, 0xA0, 0x00, 0x80, 0x00, 0x80, !0xA0];
    assert_eq!(read(&mut slave), frame);
}

#[test]
fn the_line_is_a_wired_and() {
    let mut slave = still();
    slave.set([1.0, -1.0]);
    let mut bytes = [0xFF, 0x0F, 0xFF, 0x00, 0xFF, 0xFF, 0xFF, 0x3C];
    slave.transfer_in_place(&mut bytes).unwrap();
    assert_eq!(bytes, [0xFF, 0x0C, 0xFF, 0x00, 0, 0, 0, 0x3C]);
    // A read in which the master sends zeros says nothing of the sensor.
    slave.read(&mut bytes).unwrap();
    assert_eq!(bytes, [0; 8]);
}

#[test]
fn operations_of_one_transaction_walk_through_one_frame() {
    let mut slave = still();
    slave.set([0.25, 0.0]);
    let (mut first, mut rest, mut after) = ([0; 2], [0xFF; 4], [0xFF; 2]);
    slave
        .transaction(&mut [
            Operation::Write(&[0xFF]),
            Operation::DelayNs(50_000),
            // The second byte is not given and goes out as zero.
            Operation::Transfer(&mut first, &[0xFF]),
            Operation::TransferInPlace(&mut rest),
            Operation::DelayNs(12_500),
            Operation::Transfer(&mut after, &[0xFF, 0xFF, 0xFF]),
        ])
        .unwrap();
    assert_eq!(
        (first, rest, after),
        ([0x00, 0x00], [0x00, 0x80, 0, 0], [0x20, 0xFF])
    );
    let traffic = slave.traffic();
    assert_eq!(
        (traffic.transactions, traffic.bytes, traffic.delay_ns),
        (1, 10, 62_500)
    );
    assert_eq!(
        read(&mut slave)[2],
        0xA0,
        "the next transaction starts with its first byte"
    );
    assert_eq!(slave.traffic().transactions, 2);
}

#[test]
fn each_fault_is_seen_as_what_it_is() {
    let mut sensor = driver();
    sensor.spi_mut().set([0.25, 0.0]);
    let sums = FrameError::BadSum {
        expected: 0x20,
        found: 0x21,
    };
    // Bit 3 of the frame is in B0; bit 9 is the second of B1, worth 0x40.
    let flipped = FrameError::BadSum {
        expected: 0x60,
        found: 0x20,
    };
    for (fault, error) in [
        (WireFault::Silent, Error::Frame(FrameError::NoSensor)),
        (WireFault::LineLow, Error::Frame(FrameError::LineLow)),
        (WireFault::BadSum, Error::Frame(sums)),
        (WireFault::Bus, Error::Bus(SimSpiError)),
        (WireFault::Flip(3), Error::Frame(FrameError::BadStart(0xEF))),
        (WireFault::Flip(9), Error::Frame(flipped)),
        (
            WireFault::LowAfterStart,
            Error::Frame(FrameError::StuckWords),
        ),
    ] {
        sensor.spi_mut().inject(fault, 2);
        assert_eq!(sensor.read(), Err(error));
        assert_eq!(sensor.read(), Err(error));
        assert!(sensor.read().is_ok(), "{fault:?} passes after two frames");
        sensor.spi_mut().set_fault(Some(fault));
        assert!((0..5).all(|_| sensor.read() == Err(error)));
        sensor.spi_mut().set_fault(None);
        assert!(sensor.read().is_ok());
    }
    sensor.spi_mut().inject(WireFault::Flip(64), 1);
    sensor.spi_mut().inject(WireFault::Bus, 0);
    assert!(sensor.read().is_ok());

    let faults = Faults::FIELD_TOO_LOW | Faults::DEAD_ZONE_BETA;
    sensor.spi_mut().set_error_word(faults);
    let reported = Error::Frame(FrameError::Sensor(faults));
    assert_eq!(sensor.read(), Err(reported));
}

#[test]
fn bytes_are_lost_and_doubled_where_they_are_said_to_be_and_then_the_bus_fails() {
    let mut source = Polled::new(driver());
    source.sensor_mut().spi_mut().set([0.25, -0.5]);
    let whole = source.take().unwrap().unwrap();
    let [a, b, c, d, e, f, g, h] = whole;
    for (fault, expected) in [
        (WireFault::ByteLost(0), [b, c, d, e, f, g, h, 0xFF]),
        (WireFault::ByteLost(3), [a, b, c, e, f, g, h, 0xFF]),
        (WireFault::ByteLost(7), [a, b, c, d, e, f, g, 0xFF]),
        (WireFault::ByteLost(8), whole),
        (WireFault::ByteDoubled(0), [a, a, b, c, d, e, f, g]),
        (WireFault::ByteDoubled(2), [a, b, c, c, d, e, f, g]),
        (WireFault::ByteDoubled(8), whole),
    ] {
        source.sensor_mut().spi_mut().inject(fault, 1);
        assert_eq!(source.take(), Ok(Some(expected)), "{fault:?}");
    }
    source.sensor_mut().spi_mut().inject(WireFault::Bus, 1);
    assert_eq!(source.take(), Err(BusError));
    assert_eq!(source.take(), Ok(Some(whole)));
}

#[test]
fn disturbances_come_as_often_as_asked_and_again_by_seed() {
    let run = |seed| {
        let mut sensor = driver();
        sensor.spi_mut().disturb(0.1, 0.2, seed);
        let errors: Vec<_> = (0..10_000).map(|_| sensor.read().err()).collect();
        errors
    };
    let errors = run(1);
    let silent = Some(Error::Frame(FrameError::NoSensor));
    let lost = errors.iter().filter(|&&error| error == silent).count();
    let bad = errors.iter().filter(|error| error.is_some()).count() - lost;
    // Five standard deviations: 150 and 200 frames.
    assert!((850..=1150).contains(&lost), "{lost}");
    assert!((1800..=2200).contains(&bad), "{bad}");
    assert_eq!(errors, run(1));
    assert_ne!(errors, run(2));
}

#[test]
fn noise_changes_every_frame_and_no_code() {
    let mut noisy = Slave::default();
    let frames: Vec<[u8; 8]> = (0..4).map(|_| read(&mut noisy)).collect();
    assert!(frames.windows(2).all(|two| two[0] != two[1]));
    for frame in &frames {
        let frame = Decoder::new().decode(frame).unwrap();
        let codes = [frame.first(), frame.second()].map(Word::code14);
        assert_eq!(codes, [8192; 2]);
    }
    let last = read(&mut noisy);
    noisy.set_fault(Some(WireFault::Frozen));
    noisy.set([0.5, 0.5]);
    assert_eq!([read(&mut noisy), read(&mut noisy)], [last; 2]);
    noisy.set_fault(None);
    let frame = Decoder::new().decode(&read(&mut noisy)).unwrap();
    assert_eq!(frame.first().code14(), 8192 + 4096);
    noisy.inject(WireFault::Shift(0x1000), 1);
    let frame = Decoder::new().decode(&read(&mut noisy)).unwrap();
    assert_eq!(frame.first().code14(), 8192 + 4096 + 1024);
    assert_eq!(frame.second().code14(), 8192 + 4096);
}

proptest! {
    /// Any deflection within range comes through to half a code.
    #[test]
    fn readings_are_within_half_a_code(x in -1.0_f64..=1.0, y in -1.0_f64..=1.0) {
        let mut sensor = driver();
        sensor.spi_mut().set([x, y]);
        let frame = sensor.read().unwrap();
        let near = |word: Word, value: f64| (f64::from(word.normalised()) - value).abs() < 6.2e-5;
        prop_assert!(near(frame.first(), x) && near(frame.second(), y));
    }
}
