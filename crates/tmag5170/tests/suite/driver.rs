//! What goes over the bus, byte for byte, and what comes of it.

use crate::common::{frame, sensor};
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::spi::Transaction;
use tmag5170::{
    Average, Channels, Command, Config, DataType, DeviceConfig, Error, Field, MagnetType,
    OperatingMode, Range, Register, ReplyError, SensorConfig, Status, StatusFaults, SystemConfig,
    Tmag5170, encode,
};

fn reply(value: u16) -> [u8; 4] {
    encode::register(Status::default(), value)
}

fn write(address: u32, value: u16) -> [Transaction<u8>; 3] {
    frame((address << 20) | (u32::from(value) << 4), reply(0))
}

fn read(address: u32, value: u16) -> [Transaction<u8>; 3] {
    frame((0x80 | address) << 20, reply(value))
}

/// A read of register 0 with CMD1 set, answered by `answer`.
fn ask(answer: [u8; 4]) -> [Transaction<u8>; 3] {
    frame(0x0800_0002, answer)
}

fn config(data_type: DataType) -> Config {
    Config {
        device: DeviceConfig {
            average: Average::X8,
            mode: OperatingMode::Active,
            magnet: MagnetType::Neodymium,
            ..DeviceConfig::default()
        },
        sensor: SensorConfig {
            channels: Channels::Xy,
            ranges: [Range::Narrow, Range::Narrow, Range::Middle],
            ..SensorConfig::default()
        },
        system: SystemConfig {
            data_type,
            ..SystemConfig::default()
        },
        ..Config::default()
    }
}

/// What `configure` sends up to the system's settings, to a sensor just powered up.
fn beginning() -> Vec<[Transaction<u8>; 3]> {
    let settings = [
        (0x00, 0x3100),
        (0x01, 0x00C5),
        (0x03, 0x0000),
        (0x04, 0x7D83),
        (0x05, 0x7D83),
        (0x06, 0x7D83),
        (0x00, 0x3120),
    ];
    let mut frames = vec![write(0x02, 0), read(0x0D, 0x8000), read(0x0E, 0)];
    for (address, value) in settings {
        frames.extend([write(address, value), read(address, value)]);
    }
    frames
}

#[test]
fn configure_writes_each_setting_and_reads_it_back() {
    let mut frames = beginning();
    frames.extend([write(0x02, 0), read(0x02, 0)]);
    let mut sensor = sensor(&frames);
    assert_eq!(
        sensor.configure(config(DataType::Register)),
        Ok(StatusFaults::RESTARTED)
    );
    sensor.release().done();
}

#[test]
fn a_sensor_that_sends_pairs() {
    let mut frames = beginning();
    frames.extend([
        write(0x02, 0x0040),
        // The count still, then the type.
        ask(encode::pair(Status::new(5), 0, 0)),
        ask(encode::pair(Status::new(1), 0, 0)),
        // Two readings, the second with a fault.
        ask(encode::pair(Status::new(1), 0x123, 0xEDC)),
        ask(encode::pair(Status::new(9), 0, 0)),
        // The report, in registers.
        frame(0x0020_0000, encode::pair(Status::new(1), 1, 2)),
        read(0x0D, 0x0400),
        read(0x0E, 0x0210),
        write(0x02, 0x0040),
        ask(encode::pair(Status::new(0), 0, 0)),
        ask(encode::pair(Status::new(1), 0, 0)),
        ask(encode::pair(Status::new(1), 3, 4)),
        // It has restarted: register 0 instead.
        ask(encode::register(Status::new(0x400), 0)),
    ]);
    let mut sensor = sensor(&frames);
    sensor.configure(config(DataType::Xy)).unwrap();
    let pair = sensor.pair().unwrap();
    assert_eq!(pair.fields().map(Field::code), [0x1230, -0x1240]);
    let fault = ReplyError::Sensor(Status::new(9));
    assert_eq!(sensor.pair(), Err(Error::Frame(fault)));
    let expected = StatusFaults::HALL_Z | StatusFaults::SUPPLY_LOW;
    assert_eq!(sensor.faults(), Ok(expected));
    let pair = sensor.pair().unwrap();
    assert_eq!((pair.first, pair.second), (3, 4));
    assert_eq!(sensor.pair(), Err(Error::Frame(ReplyError::OtherType(4))));
    sensor.release().done();
}

#[test]
fn a_setting_that_does_not_read_back_and_a_data_type_that_does_not_come_are_named() {
    let mut other = beginning();
    other.truncate(6);
    other.push(read(0x01, 0x00C4));
    let mut silent = beginning();
    silent.extend([write(0x02, 0x0040), ask(reply(0)), ask(reply(0))]);
    for (frames, register) in [
        (other, Register::SensorConfig),
        (silent, Register::SystemConfig),
    ] {
        let mut sensor = sensor(&frames);
        let error = sensor.configure(config(DataType::Xy)).unwrap_err();
        assert_eq!(error, Error::NotWritten(register));
        assert_eq!(
            error.to_string(),
            format!("{register:?} does not read back")
        );
        sensor.release().done();
    }
}

#[test]
fn a_reading_with_a_fault_is_none() {
    let restarted = encode::register(Status::new(0x400), 0);
    let faulty = encode::register(Status::new(0x108), 0);
    let x = |answer| frame(0x0890_0000, answer);
    let mut sensor = sensor(&[x(restarted), x(faulty), x([0xFF; 4]), x([0; 4])]);
    let errors = [
        ReplyError::Restarted,
        ReplyError::Sensor(Status::new(0x108)),
        ReplyError::NoSensor,
        ReplyError::LineLow,
    ];
    for error in errors {
        assert_eq!(sensor.fields(), Err(Error::Frame(error)));
    }
    sensor.release().done();
}

#[test]
fn each_read_and_write() {
    let mut sensor = sensor(&[
        read(0x09, 0x7FFF),
        read(0x0A, 0x8000),
        read(0x0B, 0x0010),
        frame(0x0010_0C50, encode::rejecting(reply(0))),
        frame(0x0890_0000, [1, 2, 3, 4]),
    ]);
    let fields = sensor.fields().unwrap();
    assert_eq!(fields.map(Field::code), [32767, -32768, 16]);
    let written = sensor.write(Register::SensorConfig, 0x00C5);
    assert_eq!(written, Err(Error::Frame(ReplyError::Rejected)));
    // Without judging what comes.
    let bytes = sensor.exchange(Command::read(Register::X));
    assert_eq!(bytes, Ok([1, 2, 3, 4]));
    sensor.spi_mut().done();
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
fn bus_errors_come_through() {
    let mut broken = Tmag5170::new(BrokenBus);
    let expected = Error::Bus(ErrorKind::ModeFault);
    assert_eq!(broken.fields(), Err(expected));
    assert_eq!(broken.pair(), Err(expected));
    assert_eq!(broken.configure(config(DataType::Register)), Err(expected));
    assert_eq!(broken.faults(), Err(expected));
    assert_eq!(expected.to_string(), "SPI bus: ModeFault");
}
