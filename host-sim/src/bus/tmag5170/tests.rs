//! The bus against hand-written frames, and the real driver over it with each fault.

use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use proptest::prelude::*;
use tmag5170::{
    Average, Channels, Command, Config, DeviceConfig, Diagnostics, OperatingMode, Range, Register,
    SensorConfig, StatusFaults, SystemConfig, Tmag5170, Version,
};

use super::{LineFault, SimSpiError, TmagSlave};

const RANGES: [Range; 3] = [Range::Narrow, Range::Narrow, Range::Wide];

fn config() -> Config {
    Config {
        device: DeviceConfig {
            average: Average::X8,
            mode: OperatingMode::Active,
            ..DeviceConfig::default()
        },
        sensor: SensorConfig {
            channels: Channels::Xyz,
            ranges: RANGES,
            ..SensorConfig::default()
        },
        system: SystemConfig {
            diagnostics: Diagnostics::All,
            ..SystemConfig::default()
        },
    }
}

/// A sensor just powered up, configured with this changed, in a field of zero.
fn configured(change: impl FnOnce(&mut Config)) -> Tmag5170<TmagSlave> {
    let mut config = config();
    change(&mut config);
    let mut sensor = Tmag5170::new(TmagSlave::new(Version::A1));
    assert_eq!(sensor.configure(config), Ok(StatusFaults::RESTARTED));
    sensor
}

fn running() -> Tmag5170<TmagSlave> {
    let mut sensor = configured(|_| {});
    sensor.spi_mut().set_field([1.0, -2.0, 40.0]);
    sensor
}

fn exchange(slave: &mut TmagSlave, command: [u8; 4]) -> [u8; 4] {
    let mut bytes = command;
    slave.transfer_in_place(&mut bytes).unwrap();
    bytes
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
    }
}

#[test]
fn channels_that_are_off_stay_at_zero() {
    let change = |config: &mut Config| config.sensor.channels = Channels::Zx;
    let mut sensor = configured(change);
    sensor.spi_mut().set_field([5.0, 5.0, 5.0]);
    let [x, y, z] = sensor.fields().unwrap();
    assert!(x.code() > 0 && y.code() == 0 && z.code() > 0);
}

#[test]
fn clocks_that_get_lost_are_noticed_on_both_sides() {
    let mut sensor = running();
    sensor.spi_mut().inject(LineFault::ShortFrame, 1);
    assert!(sensor.fields().is_err());
    assert_eq!(sensor.faults(), Ok(StatusFaults::FRAME_LENGTH));
    // After zeros a last byte of ones happens to have good check bits: a write that matters
    // is read back.
    sensor.spi_mut().inject(LineFault::ShortFrame, 1);
    assert!(sensor.write(Register::SensorConfig, 0).is_ok());
    let kept = sensor.spi_mut().register(Register::SensorConfig);
    assert_eq!(kept, config().sensor.bits());
    assert_eq!(sensor.faults(), Ok(StatusFaults::FRAME_LENGTH));
    assert_eq!(sensor.faults(), Ok(StatusFaults::NONE));
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
        if self.slave.traffic.transactions == self.at {
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
        for at in 0..19 {
            let slave = TmagSlave::new(Version::A1);
            let mut sensor = Tmag5170::new(Late { slave, at, fault });
            let config = config();
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
                (Register::AlertConfig, Register::AlertConfig.after_reset()),
            ];
            for (register, bits) in bits {
                let held = slave.register(register);
                assert_eq!(held, bits, "{fault:?} at {at}: {register:?}");
            }
        }
    }
    // The six: short frames in writes of what a sensor just powered up has anyway.
    assert_eq!((failed, done), (1305, 6));
}

#[test]
fn a_master_that_restarts_finds_a_sensor_that_did_not() {
    let sensor = running();
    let mut restarted = Tmag5170::new(sensor.release());
    let before = restarted.configure(config());
    assert_eq!(before, Ok(StatusFaults::NONE));
    let part = restarted.read(Register::TestConfig).unwrap().value;
    assert_eq!(Version::of(part), Some(Version::A1));
}

proptest! {
    /// Whatever is sent, there is an answer, and settings stay what the protocol allows.
    #[test]
    fn any_bytes_are_answered(frames in prop::collection::vec(any::<[u8; 4]>(), 0..50)) {
        let mut slave = TmagSlave::new(Version::A1);
        for frame in frames {
            let mut bytes = frame;
            slave.transfer_in_place(&mut bytes).unwrap();
        }
        let mut sensor = Tmag5170::new(slave);
        prop_assert!(sensor.configure(config()).is_ok());
        prop_assert!(sensor.fields().is_ok());
    }
}
