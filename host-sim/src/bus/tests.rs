//! The bus against hand-written frames, and through the real driver.

mod self_test;

use embedded_hal::spi::SpiDevice;
use firmware::{BusError, FrameSource, Polled};
use mlx90333::{Decoder, Error, FrameError, Mlx90333, Mode, SumRule, Word};

use super::{Slave, WireFault};

const REST: [u8; 8] = [0xFF, 0x00, 0x80, 0x00, 0x80, 0x00, 0x00, 0x00];

fn still() -> Slave {
    Slave {
        is_noisy: false,
        ..Slave::default()
    }
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
    let mut slave = still();
    slave.program(Decoder::with(Mode::Xyz, SumRule::ComplementB1B6));
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
        let codes = [frame.first, frame.second].map(Word::code14);
        assert_eq!(codes, [8192; 2]);
    }
    let last = read(&mut noisy);
    noisy.set_fault(Some(WireFault::Frozen));
    noisy.set([0.5, 0.5]);
    assert_eq!([read(&mut noisy), read(&mut noisy)], [last; 2]);
    noisy.set_fault(None);
    let frame = Decoder::new().decode(&read(&mut noisy)).unwrap();
    assert_eq!(frame.first.code14(), 8192 + 4096);
    noisy.inject(WireFault::Shift(0x1000), 1);
    let frame = Decoder::new().decode(&read(&mut noisy)).unwrap();
    assert_eq!(frame.first.code14(), 8192 + 4096 + 1024);
    assert_eq!(frame.second.code14(), 8192 + 4096);
}
