//! The bus against hand-written frames, and the real driver over it with each fault.

use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use physics::Magnet;
use proptest::prelude::*;
use tmag5170::{
    Average, Channels, Command, Config, DataType, DeviceConfig, Diagnostics, Error, Field,
    OperatingMode, Range, Register, ReplyError, SensorConfig, Status, StatusFaults, SystemConfig,
    Tmag5170, Version,
};

use super::{LineFault, SimSpiError, TmagSlave};

const RANGES: [Range; 3] = [Range::Narrow, Range::Narrow, Range::Wide];

/// All axes, averaged, replies of this type.
fn config(data_type: DataType) -> Config {
    Config {
        device: DeviceConfig {
            average: Average::X8,
            mode: OperatingMode::Active,
            temperature: true,
            ..DeviceConfig::default()
        },
        sensor: SensorConfig {
            channels: Channels::Xyz,
            ranges: RANGES,
            ..SensorConfig::default()
        },
        system: SystemConfig {
            data_type,
            diagnostics: Diagnostics::All,
            ..SystemConfig::default()
        },
        ..Config::default()
    }
}

/// A sensor just powered up, configured with this changed, in a field of zero.
fn configured(data_type: DataType, change: impl FnOnce(&mut Config)) -> Tmag5170<TmagSlave> {
    let mut config = config(data_type);
    change(&mut config);
    let mut sensor = Tmag5170::new(TmagSlave::new(Version::A1));
    assert_eq!(sensor.configure(config), Ok(StatusFaults::RESTARTED));
    sensor
}

/// A configured sensor in a field.
fn running(data_type: DataType) -> Tmag5170<TmagSlave> {
    let mut sensor = configured(data_type, |_| {});
    sensor.spi_mut().set_field([1.0, -2.0, 40.0]);
    sensor
}

fn exchange(slave: &mut TmagSlave, command: [u8; 4]) -> [u8; 4] {
    let mut bytes = command;
    slave.transfer_in_place(&mut bytes).unwrap();
    bytes
}

/// The fields that a driver reads, mT.
fn fields_mt(sensor: &mut Tmag5170<TmagSlave>) -> [f64; 3] {
    let fields = sensor.fields().unwrap();
    std::array::from_fn(|axis| f64::from(fields[axis].mt(RANGES[axis].full_scale_mt(Version::A1))))
}

#[test]
fn frames_by_hand() {
    let mut slave = TmagSlave::new(Version::A2);
    // TEST_CONFIG after power-up: S10, the identity and the version.
    let read_test = [0x8F, 0x00, 0x00, 0x08];
    assert_eq!(exchange(&mut slave, read_test), [0x40, 0x00, 0x50, 0x00]);
    // The same with wrong check bits: the reply's last bit, then S11 with S9 and S3.
    let wrong = [0x8F, 0x00, 0x00, 0x07];
    assert_eq!(exchange(&mut slave, wrong), [0x40, 0x00, 0x50, 0x01]);
    let [status, .., last] = exchange(&mut slave, read_test);
    assert_eq!((status, last & 0xF0), (0xE0, 0x80));
    // A write is answered with zeros for data.
    let [_, high, low, _] = exchange(&mut slave, [0x02, 0x00, 0x40, 0x08]);
    assert_eq!([high, low], [0, 0]);
    assert_eq!(slave.register(Register::SystemConfig), 0x0040);
}

#[test]
fn bytes_may_come_one_by_one_or_after_zeros() {
    let mut slave = TmagSlave::new(Version::A1);
    let mut last = [0xAA; 3];
    // A write of one byte, and a read in which the master sends zeros: a wrong CRC.
    let operations = &mut [Operation::Write(&[0x8F]), Operation::Read(&mut last)];
    slave.transaction(operations).unwrap();
    assert_eq!(last[..2], [0x00, 0x40]);
    let traffic = slave.traffic();
    assert_eq!((traffic.transactions, traffic.bytes), (1, 4));
    assert_eq!(slave.register(Register::SysStatus), 0x1000);
}

#[test]
fn the_crc_can_be_switched_off() {
    let mut slave = TmagSlave::new(Version::A1);
    exchange(&mut slave, 0x0F00_0407_u32.to_be_bytes());
    exchange(&mut slave, [0x01, 0x01, 0xC0, 0x00]);
    assert_eq!(slave.register(Register::SensorConfig), 0x01C0);
    assert_eq!(slave.register(Register::SysStatus), 0);
    // Identity and version are not to be written over.
    assert_eq!(slave.register(Register::TestConfig), 0x0044);
}

#[test]
fn results_cannot_be_written() {
    let mut slave = TmagSlave::new(Version::A1);
    for register in Register::ALL {
        exchange(&mut slave, Command::write(register, 0x1230).bytes());
        let written = slave.register(register) == 0x1230;
        let expected = register.is_setting() && register != Register::TestConfig;
        assert_eq!(written, expected, "{register:?}");
        // Replies carry registers, whatever was written there.
        let registers = Command::write(Register::SystemConfig, 0);
        exchange(&mut slave, registers.bytes());
    }
}

#[test]
fn one_conversion_has_twelve_bits_and_an_average_more() {
    for (average, code) in [(Average::X1, 0x7FF0_u16), (Average::X2, 0x7FFF)] {
        let change = |config: &mut Config| config.device.average = average;
        let mut sensor = configured(DataType::Register, change);
        let slave = sensor.spi_mut();
        slave.set_field([1e9, f64::NAN, f64::NEG_INFINITY]);
        let [x, y, z] = sensor.fields().unwrap();
        assert_eq!((x.code(), y.code(), z.code()), (code as i16, 0, i16::MIN));
    }
}

#[test]
fn channels_that_are_off_stay_at_zero() {
    let change = |config: &mut Config| config.sensor.channels = Channels::Zx;
    let mut sensor = configured(DataType::Register, change);
    sensor.spi_mut().set_field([5.0, 5.0, 5.0]);
    let [x, y, z] = sensor.fields().unwrap();
    assert!(x.code() > 0 && y.code() == 0 && z.code() > 0);
    let status = sensor.conversion_status().unwrap();
    assert_eq!(status.new_axes(), [true, false, true]);
}

#[test]
fn the_temperature_is_read() {
    let mut sensor = running(DataType::Register);
    sensor.spi_mut().set_celsius(61.5);
    let celsius = sensor.temperature().unwrap().celsius();
    assert!((celsius - 61.5).abs() < 0.01, "{celsius}");
}

#[test]
fn a_conversion_that_is_asked_for() {
    let change = |config: &mut Config| config.device.mode = OperatingMode::Standby;
    let mut sensor = configured(DataType::Register, change);
    sensor.spi_mut().set_field([5.0, 5.0, 5.0]);
    assert_eq!(sensor.fields().unwrap(), [Field::new(0); 3]);
    sensor.convert().unwrap();
    assert!(sensor.fields().unwrap()[0].code() > 0);
    assert_eq!(sensor.conversion_status().unwrap().count(), 1);
}

#[test]
fn thresholds_are_watched() {
    let mut sensor = configured(DataType::Register, |config| {
        config.system.limits = [false, true, false];
        config.thresholds[1].high = 64;
    });
    sensor.spi_mut().set_field([12.6, 12.4, 0.0]);
    assert!(sensor.fields().is_ok());
    sensor.spi_mut().set_field([12.6, 12.8, 0.0]);
    assert!(sensor.fields().is_err());
    assert_eq!(sensor.faults(), Ok(StatusFaults::LIMIT_Y));
}

/// Why a reading fails, of the kind that the sensor is set to.
fn refusal(sensor: &mut Tmag5170<TmagSlave>, data_type: DataType) -> Option<ReplyError> {
    let read = match data_type {
        DataType::Register => sensor.fields().map(drop),
        _ => sensor.pair().map(drop),
    };
    match read {
        Ok(()) => None,
        Err(Error::Frame(error)) => Some(error),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn each_fault_that_the_sensor_reports_is_named() {
    for data_type in [DataType::Register, DataType::Xy] {
        // The first is a restart.
        for known in &StatusFaults::KNOWN[1..] {
            let mut sensor = running(data_type);
            sensor.spi_mut().set_report(known.bit);
            let Some(ReplyError::Sensor(status)) = refusal(&mut sensor, data_type) else {
                panic!("{}", known.name);
            };
            // A pair has no room for which half it is.
            let half = match (data_type, known.bit.afe_status()) {
                (DataType::Register, 0) => Status::SYSTEM,
                (DataType::Register, _) => Status::AFE,
                _ => Status::ERROR,
            };
            assert!(status.contains(half), "{}", known.name);
            assert_eq!(sensor.faults(), Ok(known.bit));
            sensor.spi_mut().set_report(StatusFaults::NONE);
            assert_eq!(refusal(&mut sensor, data_type), None);
        }
    }
}

#[test]
fn a_restart_is_noticed_and_mended_by_configuring_again() {
    for data_type in [DataType::Register, DataType::Xy, DataType::Xz, DataType::Zy] {
        let mut sensor = running(data_type);
        assert_eq!(refusal(&mut sensor, data_type), None);
        sensor.spi_mut().restart();
        let expected = match data_type {
            DataType::Register => ReplyError::Restarted,
            _ => ReplyError::OtherType(4),
        };
        assert_eq!(refusal(&mut sensor, data_type), Some(expected));
        for before in [StatusFaults::RESTARTED, StatusFaults::NONE] {
            assert_eq!(sensor.configure(config(data_type)), Ok(before));
        }
    }
}

#[test]
fn each_line_fault_is_an_error() {
    let faults = [
        (LineFault::Silent, Error::Frame(ReplyError::NoSensor)),
        (LineFault::SdoLow, Error::Frame(ReplyError::LineLow)),
        (LineFault::SdiLow, Error::Frame(ReplyError::Rejected)),
        (LineFault::Bus, Error::Bus(SimSpiError)),
    ];
    for (fault, error) in faults {
        let mut sensor = running(DataType::Register);
        sensor.spi_mut().inject(fault, 1);
        assert_eq!(sensor.fields(), Err(error), "{fault:?}");
        // What the sensor noticed, it still reports.
        let noticed = sensor.faults().unwrap();
        let zeros = fault == LineFault::SdiLow;
        assert_eq!(noticed.contains(StatusFaults::FRAME_CRC), zeros);
        assert!(sensor.fields().is_ok(), "{fault:?}");
        sensor.spi_mut().set_fault(Some(fault));
        let before = sensor.configure(config(DataType::Xy));
        assert_eq!(before, Err(error), "{fault:?}");
    }
}

#[test]
fn clocks_that_get_lost_are_noticed_on_both_sides() {
    let mut sensor = running(DataType::Register);
    sensor.spi_mut().inject(LineFault::ShortFrame, 1);
    assert!(sensor.fields().is_err());
    assert_eq!(sensor.faults(), Ok(StatusFaults::FRAME_LENGTH));
    // After zeros a last byte of ones happens to have good check bits: a write that matters
    // is read back.
    sensor.spi_mut().inject(LineFault::ShortFrame, 1);
    assert!(sensor.write(Register::SensorConfig, 0).is_ok());
    let kept = sensor.spi_mut().register(Register::SensorConfig);
    assert_eq!(kept, config(DataType::Register).sensor.bits());
    assert_eq!(sensor.faults(), Ok(StatusFaults::FRAME_LENGTH));
    assert_eq!(sensor.faults(), Ok(StatusFaults::NONE));
}

#[test]
fn a_wrong_bit_anywhere_is_found_and_nothing_is_written() {
    for bit in 0..32 {
        let mut sensor = running(DataType::Register);
        sensor.spi_mut().inject(LineFault::FlipReply(bit), 1);
        assert!(sensor.fields().is_err(), "reply, bit {bit}");
        assert_eq!(sensor.faults(), Ok(StatusFaults::NONE));

        sensor.spi_mut().inject(LineFault::FlipCommand(bit), 1);
        let written = sensor.write(Register::AlertConfig, 0x0800);
        let rejected = Err(Error::Frame(ReplyError::Rejected));
        assert_eq!(written, rejected, "command, bit {bit}");
        assert_eq!(sensor.spi_mut().register(Register::AlertConfig), 0);
        assert_eq!(sensor.faults(), Ok(StatusFaults::FRAME_CRC));
    }
}

/// A sensor with a line fault in one frame, counted from 0.
struct Late {
    slave: TmagSlave,
    at: u64,
    fault: LineFault,
}

impl ErrorType for Late {
    type Error = SimSpiError;
}

impl SpiDevice for Late {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), SimSpiError> {
        if self.slave.traffic().transactions == self.at {
            self.slave.inject(self.fault, 1);
        }
        self.slave.transaction(operations)
    }
}

#[test]
fn configure_fails_or_has_configured_whichever_frame_is_hit() {
    let flips = (0..32).flat_map(|bit| [LineFault::FlipReply(bit), LineFault::FlipCommand(bit)]);
    let others = [
        LineFault::Silent,
        LineFault::SdoLow,
        LineFault::SdiLow,
        LineFault::Bus,
        LineFault::ShortFrame,
    ];
    let [mut failed, mut done] = [0, 0];
    for fault in flips.chain(others) {
        for at in 0..20 {
            let slave = TmagSlave::new(Version::A1);
            let mut sensor = Tmag5170::new(Late { slave, at, fault });
            let config = config(DataType::Xy);
            if sensor.configure(config).is_err() {
                failed += 1;
                continue;
            }
            done += 1;
            let slave = sensor.release().slave;
            let bits = [
                (Register::DeviceConfig, config.device.bits()),
                (Register::SensorConfig, config.sensor.bits()),
                (Register::SystemConfig, config.system.bits()),
                (Register::AlertConfig, config.alert.bits()),
            ];
            for (register, bits) in bits {
                let held = slave.register(register);
                assert_eq!(held, bits, "{fault:?} at {at}: {register:?}");
            }
        }
    }
    // The six: short frames in writes of what a sensor just powered up has anyway.
    assert_eq!((failed, done), (1374, 6));
}

#[test]
fn results_of_a_sensor_that_stands_still_do_not_move() {
    let mut sensor = running(DataType::Register);
    let before = sensor.fields().unwrap();
    let count = sensor.conversion_status().unwrap().count();
    sensor.spi_mut().set_fault(Some(LineFault::Frozen));
    sensor.spi_mut().set_field([9.0, 9.0, 9.0]);
    assert_eq!(sensor.fields(), Ok(before));
    assert_eq!(sensor.conversion_status().unwrap().count(), count);
    sensor.spi_mut().set_fault(None);
    assert_ne!(sensor.fields(), Ok(before));
    assert_eq!(sensor.conversion_status().unwrap().count(), (count + 1) % 8);
}

#[test]
fn a_master_that_restarts_finds_a_sensor_that_did_not() {
    let sensor = running(DataType::AngleMagnitude);
    let mut restarted = Tmag5170::new(sensor.release());
    let before = restarted.configure(config(DataType::Register));
    assert_eq!(before, Ok(StatusFaults::NONE));
    assert_eq!(restarted.version(), Ok(Some(Version::A1)));
}

proptest! {
    /// Driver, slave and the magnet's field: the tilt comes back within half a code of X and Y.
    #[test]
    fn the_tilt_of_a_magnet_is_read(x in -0.6_f64..0.6, y in -0.6_f64..0.6) {
        let magnet = Magnet::of_field(60.0).unwrap();
        let mut sensor = running(DataType::Register);
        sensor.spi_mut().set_field(magnet.field_mt([x, y]));
        let read = Magnet::tilt_rad(fields_mt(&mut sensor));
        // Half a code of ±25 mT, of a slope of at least 30 mT/rad · cos; and of ±100 mT.
        let tolerance = 0.5 * 25.0 / 32_768.0 / 30.0 + 0.5 * 100.0 / 32_768.0 / 60.0;
        for (read, tilt) in read.into_iter().zip([x, y]) {
            prop_assert!((read - tilt).abs() < 1.1 * tolerance, "{read} {tilt}");
        }
    }

    /// A pair is the same two results, to twelve bits.
    #[test]
    fn pairs_are_the_results_cut(field in prop::array::uniform3(-30.0_f64..30.0)) {
        for (data_type, axes) in [
            (DataType::Xy, [0, 1]),
            (DataType::Xz, [0, 2]),
            (DataType::Zy, [2, 1]),
        ] {
            let mut sensor = running(DataType::Register);
            sensor.spi_mut().set_field(field);
            let whole = sensor.fields().unwrap();
            sensor.configure(config(data_type)).unwrap();
            let pair = sensor.pair().unwrap().fields();
            let cut = axes.map(|axis: usize| whole[axis].code() & !0xF);
            prop_assert_eq!(pair.map(Field::code), cut);
        }
    }

    /// Whatever is sent, there is an answer, and settings stay what the protocol allows.
    #[test]
    fn any_bytes_are_answered(frames in prop::collection::vec(any::<[u8; 4]>(), 0..50)) {
        let mut slave = TmagSlave::new(Version::A1);
        for frame in frames {
            let mut bytes = frame;
            slave.transfer_in_place(&mut bytes).unwrap();
        }
        let mut sensor = Tmag5170::new(slave);
        prop_assert!(sensor.configure(config(DataType::Register)).is_ok());
        prop_assert!(sensor.fields().is_ok());
    }
}
