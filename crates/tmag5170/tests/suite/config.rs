//! Settings as registers hold them, against values put together from TI's masks.

use tmag5170::{
    AnglePair, Average, Channels, Config, DeviceConfig, Diagnostics, MagnetType, OperatingMode,
    Range, Register, SensorConfig, SleepTime, SystemConfig, Trigger, Version,
};

#[test]
fn a_default_is_what_a_reset_leaves() {
    let config = Config::default();
    let [device, sensor] = [config.device.bits(), config.sensor.bits()];
    let settings = [device, sensor, config.system.bits()];
    for (register, bits) in Register::ALL.into_iter().zip(settings) {
        assert_eq!(bits, register.after_reset(), "{register:?}");
    }
}

#[test]
fn registers_by_hand() {
    let device = DeviceConfig {
        average: Average::X32,
        magnet: MagnetType::Ferrite,
        mode: OperatingMode::Active,
        temperature: true,
        temperature_once: false,
    };
    assert_eq!(device.bits(), 0x5000 | 0x0300 | 0x0020 | 0x0008);
    let once = DeviceConfig {
        temperature_once: true,
        ..DeviceConfig::default()
    };
    assert_eq!(once.bits(), 0x0004);

    let sensor = SensorConfig {
        angle: AnglePair::Xz,
        sleep: SleepTime::Ms1000,
        channels: Channels::Xyzzyx,
        ranges: [Range::Narrow, Range::Wide, Range::Middle],
    };
    assert_eq!(sensor.bits(), 0xC000 | 0x2400 | 0x03C0 | 0x0001 | 0x0008);
    // TI's forum, thread 958418, for ±100 mT on all axes and channels X, Y, Z: 0x19EA, of
    // which the upper bits are a sleep time.
    let forum = SensorConfig {
        channels: Channels::Xyz,
        ranges: [Range::Wide; 3],
        ..SensorConfig::default()
    };
    assert_eq!(forum.bits(), 0x19EA & 0x03FF);

    let system = SystemConfig {
        diagnostics: Diagnostics::EnabledInTurn,
        trigger: Trigger::Alert,
    };
    assert_eq!(system.bits(), 0x3020 | 0x0400);
}

#[test]
fn fields_come_back_and_others_are_refused() {
    // With every bit beside the field set.
    macro_rules! come_back {
        ($($field:ident $mask:literal),+) => {$(
            for &value in $field::ALL {
                assert_eq!($field::of(value.bits() | !$mask), Some(value));
            }
        )+};
    }
    come_back!(
        Average 0x7000, MagnetType 0x0300, OperatingMode 0x0070, AnglePair 0xC000,
        SleepTime 0x3C00, Channels 0x03C0, Range 0x0003, Trigger 0x0600,
        Version 0x0030
    );
    assert_eq!(Average::of(0x6000), None);
    assert_eq!(OperatingMode::of(0x0070), None);
    assert_eq!(Range::of(0x0003), None);
    assert_eq!(SleepTime::of(0x2800), None);
    assert_eq!(Trigger::of(0x0600), None);
    assert_eq!(Version::of(0x0060), None);
}

#[test]
fn averages_and_channels_are_their_names() {
    for average in Average::ALL {
        assert_eq!(format!("{average:?}"), format!("X{}", average.count()));
    }
    for channels in Channels::ALL {
        let name = format!("{channels:?}").to_lowercase().replace("off", "");
        let axes = ['x', 'y', 'z'].map(|axis| name.contains(axis));
        assert_eq!(channels.axes(), axes, "{name}");
        assert_eq!(channels.count() as usize, name.len(), "{name}");
    }
}
