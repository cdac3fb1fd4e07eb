//! What goes over the bus, byte for byte, and what comes of it.

use crate::common::{frame, sensor};
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::spi::Transaction;
use tmag5170::{
    Average, Channels, Command, Config, DeviceConfig, Error, Field, MagnetType, OperatingMode,
    Range, Register, ReplyError, SensorConfig, Status, StatusFaults, SystemConfig, Tmag5170,
    Trigger, encode,
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

fn config() -> Config {
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
            trigger: Trigger::ChipSelect,
            ..SystemConfig::default()
        },
    }
}

/// What `configure` sends to a sensor just powered up.
fn configuring() -> Vec<[Transaction<u8>; 3]> {
    let settings = [
        (0x00, 0x3100),
        (0x01, 0x00C5),
        (0x03, 0x0000),
        (0x04, 0x7D83),
        (0x05, 0x7D83),
        (0x06, 0x7D83),
        (0x00, 0x3120),
        (0x02, 0x0200),
    ];
    let mut frames = vec![write(0x02, 0), read(0x0D, 0x8000), read(0x0E, 0)];
    for (address, value) in settings {
        frames.extend([write(address, value), read(address, value)]);
    }
    frames
}

#[test]
fn configure_writes_each_setting_and_reads_it_back() {
    let mut sensor = sensor(&configuring());
    assert_eq!(sensor.configure(config()), Ok(StatusFaults::RESTARTED));
    sensor.release().done();
}

#[test]
fn a_setting_that_does_not_read_back_is_named() {
    let mut frames = configuring();
    frames.truncate(6);
    frames.push(read(0x01, 0x00C4));
    let mut sensor = sensor(&frames);
    let error = sensor.configure(config()).unwrap_err();
    assert_eq!(error, Error::NotWritten(Register::SensorConfig));
    assert_eq!(error.to_string(), "SensorConfig does not read back");
    sensor.release().done();
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
    assert_eq!(broken.configure(config()), Err(expected));
    assert_eq!(broken.faults(), Err(expected));
    assert_eq!(expected.to_string(), "SPI bus: ModeFault");
}
