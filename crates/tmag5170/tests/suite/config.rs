//! Settings as registers hold them, against values put together from TI's masks.

use tmag5170::{
    AlertConfig, AlertMode, AnglePair, Average, AxisThresholds, Channels, Config, DataType,
    DeviceConfig, Diagnostics, MagnetType, OperatingMode, Range, Register, SensorConfig, SleepTime,
    SystemConfig, Trigger, Version,
};

#[test]
fn a_default_is_what_a_reset_leaves() {
    let config = Config::default();
    let bits = [
        (Register::DeviceConfig, config.device.bits()),
        (Register::SensorConfig, config.sensor.bits()),
        (Register::SystemConfig, config.system.bits()),
        (Register::AlertConfig, config.alert.bits()),
        (Register::XThresholds, config.thresholds[0].bits()),
        (Register::YThresholds, config.thresholds[1].bits()),
        (Register::ZThresholds, config.thresholds[2].bits()),
    ];
    for (register, bits) in bits {
        assert_eq!(bits, register.after_reset(), "{register:?}");
    }
}

#[test]
fn device_by_hand() {
    let device = DeviceConfig {
        average: Average::X32,
        magnet: MagnetType::Ferrite,
        mode: OperatingMode::Active,
        temperature: true,
        temperature_once: false,
        temperature_limits: true,
    };
    assert_eq!(device.bits(), 0x5000 | 0x0300 | 0x0020 | 0x0008 | 0x0002);
    let once = DeviceConfig {
        temperature_once: true,
        ..DeviceConfig::default()
    };
    assert_eq!(once.bits(), 0x0004);
}

#[test]
fn the_settings_of_a_thread() {
    // TI's forum, thread 958418, for ±100 mT on all axes and channels X, Y, Z: 0x19EA, of
    // which the upper bits are a sleep time.
    let sensor = SensorConfig {
        channels: Channels::Xyz,
        ranges: [Range::Wide; 3],
        ..SensorConfig::default()
    };
    assert_eq!(sensor.bits(), 0x19EA & 0x03FF);
}

#[test]
fn sensor_by_hand() {
    let sensor = SensorConfig {
        angle: AnglePair::Xz,
        sleep: SleepTime::Ms1000,
        channels: Channels::Xyzzyx,
        ranges: [Range::Narrow, Range::Wide, Range::Middle],
    };
    assert_eq!(sensor.bits(), 0xC000 | 0x2400 | 0x03C0 | 0x0001 | 0x0008);
}

#[test]
fn system_by_hand() {
    let system = SystemConfig {
        diagnostics: Diagnostics::EnabledInTurn,
        trigger: Trigger::Alert,
        data_type: DataType::Zy,
        limits: [true, false, true],
    };
    assert_eq!(
        system.bits(),
        0x3000 | 0x0020 | 0x0400 | 0x00C0 | 0x0004 | 0x0001
    );
    let selected = [0x0000, 0x0020, 0x1020, 0x2020, 0x3020];
    let all = [
        Diagnostics::Off,
        Diagnostics::All,
        Diagnostics::Enabled,
        Diagnostics::AllInTurn,
        Diagnostics::EnabledInTurn,
    ];
    assert_eq!(all.map(Diagnostics::bits), selected);
}

#[test]
fn alert_by_hand() {
    let alert = AlertConfig {
        mode: AlertMode::Interrupt,
        latched: true,
        faults: true,
        results: true,
        crossings: 3,
        thresholds: [false, true, false, true],
    };
    assert_eq!(
        alert.bits(),
        0x2000 | 0x0800 | 0x0100 | 0x0020 | 0x0002 | 0x0008
    );
    let crossings = |crossings| {
        let alert = AlertConfig {
            crossings,
            ..AlertConfig::default()
        };
        alert.bits()
    };
    assert_eq!(
        [0, 1, 2, 3, 4, 255].map(crossings),
        [0, 0, 0x10, 0x20, 0x30, 0x30]
    );
    let switch = AlertConfig {
        mode: AlertMode::Switch,
        thresholds: [true, false, true, false],
        ..AlertConfig::default()
    };
    assert_eq!(switch.bits(), 0x1000 | 0x0001 | 0x0004);
}

#[test]
fn thresholds_by_hand() {
    // TI's 50 % of full scale, both ways.
    let half = AxisThresholds { high: 64, low: -64 };
    assert_eq!(half.bits(), 0x40C0);
}

#[test]
fn fields_come_back_and_others_are_refused() {
    for &average in Average::ALL {
        assert_eq!(Average::of(average.bits() | 0x8FFF), Some(average));
        assert_eq!(average.count(), 1 << (average.bits() >> 12));
    }
    for &channels in Channels::ALL {
        assert_eq!(Channels::of(channels.bits() | 0xFC3F), Some(channels));
    }
    for &data_type in DataType::ALL {
        assert_eq!(DataType::of(data_type.bits() | 0xFE3F), Some(data_type));
    }
    for &mode in OperatingMode::ALL {
        assert_eq!(OperatingMode::of(mode.bits() | 0xFF8F), Some(mode));
    }
    assert_eq!(Average::of(0x6000), None);
    assert_eq!(OperatingMode::of(0x0070), None);
    assert_eq!(Range::of(0x0003), None);
    assert_eq!(SleepTime::of(0x2800), None);
    assert_eq!(Trigger::of(0x0600), None);
    assert_eq!(Version::of(0x0040), Some(Version::A1));
    assert_eq!(Version::of(0x0054), Some(Version::A2));
    assert_eq!(Version::of(0x0060), None);
}

#[test]
fn channels_are_their_letters() {
    for channels in Channels::ALL {
        let name = format!("{channels:?}").to_lowercase();
        let name = if name == "off" { String::new() } else { name };
        let axes = ['x', 'y', 'z'].map(|axis| name.contains(axis));
        assert_eq!(channels.axes(), axes, "{name}");
        assert_eq!(channels.count() as usize, name.len(), "{name}");
    }
}
