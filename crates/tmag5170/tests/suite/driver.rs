//! What goes over the bus, byte for byte, and what comes of it.

use crate::common::{frame, sealed, sensor};
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::spi::Transaction;
use tmag5170::{
    Average, Channels, Command, Config, DataType, DeviceConfig, Error, Field, OperatingMode, Range,
    Register, ReplyError, SensorConfig, Status, StatusFaults, SystemConfig, Temperature, Tmag5170,
    Version, encode,
};

/// A good reply without status.
fn reply(value: u16) -> [u8; 4] {
    encode::register(Status::default(), value)
}

/// A write of a register, answered by a good reply.
fn write(address: u32, value: u16) -> [Transaction<u8>; 3] {
    frame((address << 20) | (u32::from(value) << 4), reply(0))
}

/// A read of a register that holds `value`.
fn read(address: u32, value: u16) -> [Transaction<u8>; 3] {
    frame((0x80 | address) << 20, reply(value))
}

/// A read of register 0 with CMD1 set, answered by `answer`.
fn ask(answer: [u8; 4]) -> [Transaction<u8>; 3] {
    frame(0x0800_0002, answer)
}

const CONFIG: Config = Config {
    device: DeviceConfig {
        average: Average::X8,
        mode: OperatingMode::Active,
        magnet: tmag5170::MagnetType::Neodymium,
        temperature: false,
        temperature_once: false,
        temperature_limits: false,
    },
    sensor: SensorConfig {
        channels: Channels::Xy,
        ranges: [Range::Narrow, Range::Narrow, Range::Middle],
        angle: tmag5170::AnglePair::Off,
        sleep: tmag5170::SleepTime::Ms1,
    },
    system: SystemConfig {
        diagnostics: tmag5170::Diagnostics::Off,
        trigger: tmag5170::Trigger::Command,
        data_type: DataType::Register,
        limits: [false; 3],
    },
    alert: tmag5170::AlertConfig {
        latched: false,
        mode: tmag5170::AlertMode::Interrupt,
        faults: false,
        results: false,
        crossings: 0,
        thresholds: [false; 4],
    },
    thresholds: [tmag5170::AxisThresholds {
        high: 125,
        low: -125,
    }; 3],
};

/// What `configure` sends for `CONFIG` up to the system's settings, to a sensor just powered
/// up.
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
    assert_eq!(sensor.configure(CONFIG), Ok(StatusFaults::RESTARTED));
    sensor.release().done();
}

fn pairs() -> Config {
    Config {
        system: SystemConfig {
            data_type: DataType::Xy,
            ..CONFIG.system
        },
        ..CONFIG
    }
}

/// As `beginning`, and on to pairs.
fn beginning_of_pairs() -> Vec<[Transaction<u8>; 3]> {
    let mut frames = beginning();
    frames.extend([
        write(0x02, 0x0040),
        // The count still, then the type.
        ask(encode::pair(Status::new(5), 0, 0)),
        ask(encode::pair(Status::new(1), 0, 0)),
    ]);
    frames
}

#[test]
fn pairs_are_told_by_their_type() {
    let mut frames = beginning_of_pairs();
    frames.extend([
        ask(encode::pair(Status::new(1), 0x123, 0xEDC)),
        // It has restarted: register 0 instead.
        ask(encode::register(Status::new(0x400), 0)),
        ask(encode::pair(Status::new(9), 0, 0)),
    ]);
    let mut sensor = sensor(&frames);
    sensor.configure(pairs()).unwrap();
    let pair = sensor.pair().unwrap();
    assert_eq!(pair.fields().map(Field::code), [0x1230, -0x1240]);
    assert_eq!(sensor.pair(), Err(Error::Frame(ReplyError::OtherType(4))));
    let fault = ReplyError::Sensor(Status::new(9));
    assert_eq!(sensor.pair(), Err(Error::Frame(fault)));
    sensor.release().done();
}

#[test]
fn faults_of_a_sensor_that_sends_pairs() {
    let mut frames = beginning_of_pairs();
    frames.extend([
        frame(0x0020_0000, encode::pair(Status::new(1), 1, 2)),
        read(0x0D, 0x0400),
        read(0x0E, 0x0210),
        write(0x02, 0x0040),
        ask(encode::pair(Status::new(0), 0, 0)),
        ask(encode::pair(Status::new(1), 0, 0)),
        ask(encode::pair(Status::new(1), 3, 4)),
    ]);
    let mut sensor = sensor(&frames);
    sensor.configure(pairs()).unwrap();
    assert_eq!(
        sensor.faults(),
        Ok(StatusFaults::HALL_Z | StatusFaults::SUPPLY_LOW)
    );
    assert_eq!(
        sensor.pair().map(|pair| (pair.first, pair.second)),
        Ok((3, 4))
    );
    sensor.release().done();
}

#[test]
fn a_setting_that_does_not_read_back_is_named() {
    let mut frames = beginning();
    frames.truncate(6);
    frames.push(read(0x01, 0x00C4));
    let mut sensor = sensor(&frames);
    let error = sensor.configure(CONFIG).unwrap_err();
    assert_eq!(error, Error::NotWritten(Register::SensorConfig));
    assert_eq!(error.to_string(), "SensorConfig does not read back");
    sensor.release().done();
}

#[test]
fn a_data_type_that_is_not_told_is_named() {
    let mut frames = beginning();
    frames.extend([write(0x02, 0x0040), ask(reply(0)), ask(reply(0))]);
    let mut sensor = sensor(&frames);
    let expected = Error::NotWritten(Register::SystemConfig);
    assert_eq!(sensor.configure(pairs()), Err(expected));
    sensor.release().done();
}

#[test]
fn a_rejected_write_is_told() {
    let mut sensor = sensor(&[frame(0x0010_0C50, encode::rejecting(reply(0)))]);
    let written = sensor.write(Register::SensorConfig, 0x00C5);
    assert_eq!(written, Err(Error::Frame(ReplyError::Rejected)));
    sensor.release().done();
}

#[test]
fn fields_are_three_frames() {
    let mut sensor = sensor(&[read(0x09, 0x7FFF), read(0x0A, 0x8000), read(0x0B, 0x0010)]);
    let fields = sensor.fields().unwrap();
    assert_eq!(fields.map(Field::code), [32767, -32768, 16]);
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
fn the_other_reads() {
    let mut sensor = sensor(&[
        read(0x0C, 20522),
        read(0x08, 0x2730),
        read(0x0F, 0x0050),
        read(0x0F, 0x0070),
        frame(0x0800_0001, reply(0x3120)),
    ]);
    assert_eq!(sensor.temperature(), Ok(Temperature::new(20522)));
    let status = sensor.conversion_status().unwrap();
    assert!(status.ready() && status.count() == 3 && status.new_axes() == [true; 3]);
    assert_eq!(sensor.version(), Ok(Some(Version::A2)));
    assert_eq!(sensor.version(), Ok(None));
    assert_eq!(sensor.convert(), Ok(()));
    sensor.release().done();
}

#[test]
fn exchange_does_not_judge() {
    let mut sensor = sensor(&[frame(0x0890_0000, [1, 2, 3, 4])]);
    let bytes = sensor.exchange(Command::read(Register::X));
    assert_eq!(bytes, Ok([1, 2, 3, 4]));
    sensor.spi_mut().done();
    assert_eq!(sealed(0x0890_0000)[0], 0x89);
}

/// A bus that always fails.
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
    assert_eq!(broken.configure(CONFIG), Err(expected));
    assert_eq!(broken.faults(), Err(expected));
    assert_eq!(broken.convert(), Err(expected));
    assert_eq!(expected.to_string(), "SPI bus: ModeFault");
}
