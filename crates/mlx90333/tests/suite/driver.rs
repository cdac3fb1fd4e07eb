//! What goes over the bus, byte for byte, and what comes of it.

use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use mlx90333::{Decoder, Error, Faults, Frame, FrameError, Mlx90333, Mode, SumRule, Word, encode};

const GOOD: [u8; 8] = [0xFF, 0x34, 0x12, 0xCD, 0xAB, 0x00, 0x00, 0xBE];

fn at_once(answer: [u8; 8]) -> Vec<Transaction<u8>> {
    vec![
        Transaction::transaction_start(),
        Transaction::transfer_in_place(vec![0xFF; 8], answer.to_vec()),
        Transaction::transaction_end(),
    ]
}

fn paced(answer: [u8; 8], gap_ns: u32) -> Vec<Transaction<u8>> {
    let mut steps = vec![Transaction::transaction_start()];
    for (i, byte) in answer.into_iter().enumerate() {
        if i > 0 {
            steps.push(Transaction::delay(gap_ns));
        }
        steps.push(Transaction::transfer_in_place(vec![0xFF], vec![byte]));
    }
    steps.push(Transaction::transaction_end());
    steps
}

fn sensor(steps: &[Transaction<u8>]) -> Mlx90333<Mock<u8>> {
    Mlx90333::new(Mock::new(steps), Decoder::new())
}

#[test]
fn a_read_is_one_transaction_at_once_or_with_seven_gaps() {
    let is_good = |frame: Frame| {
        assert_eq!(frame.first, Word::new(0x1234));
        assert_eq!(frame.second, Word::new(0xABCD));
    };
    let mut sensor = sensor(&[at_once(GOOD), paced(GOOD, 12_500), paced(GOOD, 50_000)].concat());
    is_good(sensor.read().unwrap());
    is_good(sensor.read_paced(12_500).unwrap());
    is_good(sensor.read_paced(50_000).unwrap());
    sensor.release().done();
}

#[test]
fn bytes_that_are_not_judged_keep_their_order() {
    let bytes = [0, 1, 2, 3, 4, 5, 6, 7];
    let mut sensor = sensor(&[at_once(bytes), paced(bytes, 1)].concat());
    assert_eq!(sensor.read_raw(), Ok(bytes));
    assert_eq!(sensor.read_raw_paced(1), Ok(bytes));
    sensor.release().done();
}

#[test]
fn bad_frames_are_frame_errors_and_do_not_stop_the_next_read() {
    let low = Faults::FIELD_TOO_LOW;
    let faulty = encode::alpha_beta(Word::MID, Word::MID, low, SumRule::SumB1B6);
    let steps = [at_once([0xFF; 8]), paced(faulty, 9), at_once(GOOD)].concat();
    let mut sensor = sensor(&steps);
    assert_eq!(sensor.read(), Err(Error::Frame(FrameError::NoSensor)));
    let low = Error::Frame(FrameError::Sensor(low));
    assert_eq!(sensor.read_paced(9), Err(low));
    assert!(sensor.read().is_ok());
    sensor.release().done();
}

#[test]
fn the_decoder_given_is_the_one_used() {
    let decoder = Decoder::with(Mode::Xyz, SumRule::ComplementB0B6);
    let bytes = encode::words([1, 2, 3], decoder);
    let mut sensor = Mlx90333::new(Mock::new(&at_once(bytes)), decoder);
    assert_eq!(sensor.decoder(), decoder);
    assert_eq!(sensor.read().unwrap().third, Some(Word::new(3)));
    sensor.release().done();
}

struct BrokenBus;

impl ErrorType for BrokenBus {
    type Error = ErrorKind;
}

impl SpiDevice for BrokenBus {
    fn transaction(&mut self, _: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        Err(ErrorKind::ModeFault)
    }
}

#[test]
fn bus_errors_come_through_every_read() {
    let broken = || Mlx90333::new(BrokenBus, Decoder::new());
    let expected = Error::Bus(ErrorKind::ModeFault);
    assert_eq!(broken().read(), Err(expected));
    assert_eq!(broken().read_paced(50_000), Err(expected));
    assert_eq!(broken().read_raw(), Err(expected));
    assert_eq!(broken().read_raw_paced(50_000), Err(expected));
}
