//! The sensor of a simulated whisker, as the scene has it.

use firmware::{FrameSource, Polled, SensorFault, TiltScale, TiltSource, WordSource};
use mlx90333::{Decoder, FRAME_LEN, Mlx90333, Word};
use physics::{Magnet, SensorSettings};
use scene::{SensorModel, SensorSection};
use tmag5170::{
    Average, Channels, Config, DeviceConfig, OperatingMode, Range, SensorConfig, Tmag5170, Version,
};

use crate::bus::Slave;
use crate::bus::tmag5170::TmagSlave;

/// Field of the magnet along the axis of a TMAG5170, mT: docs/build.md.
const AXIAL_MT: f64 = 60.0;

/// A sensor on its mock bus.
pub(super) struct AnySensor(Kind);

/// Either of them.
enum Kind {
    /// It measures what it is set to.
    Mlx90333(Polled<Slave>),
    /// It measures the field of a magnet.
    Tmag5170(Box<Tilted>),
}

/// A TMAG5170 below a magnet.
struct Tilted {
    source: TiltSource<TmagSlave>,
    magnet: Magnet,
    /// Tilt that reads as a deflection of 1, rad.
    full_scale_rad: f64,
}

impl AnySensor {
    /// A sensor at rest, whose noise, where the bus does not make its own, follows from `seed`.
    ///
    /// `None` if its range does not fit the magnet, which does not depend on the scene.
    pub(super) fn new(section: &SensorSection, seed: u64) -> Option<Self> {
        let kind = match section.model {
            SensorModel::Mlx90333 => {
                let decoder = config::decoder(section);
                Kind::Mlx90333(Polled::new(Mlx90333::new(Slave::of(decoder), decoder)))
            }
            SensorModel::Tmag5170 => Kind::Tmag5170(Box::new(Tilted::new(seed)?)),
        };
        Some(Self(kind))
    }

    /// The first kind, on its bus.
    pub(super) fn slave_mut(&mut self) -> Option<&mut Slave> {
        match &mut self.0 {
            Kind::Mlx90333(polled) => Some(polled.sensor_mut().spi_mut()),
            Kind::Tmag5170(_) => None,
        }
    }

    /// The second kind, on its bus.
    pub(super) fn tmag_mut(&mut self) -> Option<&mut TmagSlave> {
        match &mut self.0 {
            Kind::Mlx90333(_) => None,
            Kind::Tmag5170(tilted) => Some(tilted.source.sensor_mut().spi_mut()),
        }
    }

    /// Deflections along x and y from now on, in units of the range.
    pub(super) fn bend(&mut self, deflection: [f64; 2]) {
        match &mut self.0 {
            Kind::Mlx90333(polled) => polled.sensor_mut().spi_mut().set(deflection),
            Kind::Tmag5170(tilted) => tilted.bend(deflection),
        }
    }
}

impl Tilted {
    fn new(seed: u64) -> Option<Self> {
        let config = Config {
            device: DeviceConfig {
                // The most that are new in every tick of 2 kHz.
                average: Average::X4,
                mode: OperatingMode::Active,
                ..DeviceConfig::default()
            },
            sensor: SensorConfig {
                channels: Channels::Xyz,
                ranges: [Range::Narrow, Range::Narrow, Range::Wide],
                ..SensorConfig::default()
            },
            ..Config::default()
        };
        let [full_scale_rad, _] = SensorSettings::default().full_scale_rad;
        let scale = TiltScale::new(&config, full_scale_rad as f32)?;
        let slave = TmagSlave::new(Version::A1).with_noise(seed);
        let mut tilted = Self {
            source: TiltSource::new(Tmag5170::new(slave), config, scale),
            magnet: Magnet::of_field(AXIAL_MT).ok()?,
            full_scale_rad,
        };
        tilted.bend([0.0; 2]);
        Some(tilted)
    }

    fn bend(&mut self, deflection: [f64; 2]) {
        let tilt = deflection.map(|along| self.full_scale_rad * along);
        let field = self.magnet.field_mt(tilt);
        self.source.sensor_mut().spi_mut().set_field(field);
    }
}

impl WordSource for AnySensor {
    fn words(&mut self, decoder: Decoder) -> Result<[Word; 2], SensorFault> {
        match &mut self.0 {
            Kind::Mlx90333(polled) => polled.words(decoder),
            Kind::Tmag5170(tilted) => tilted.source.words(decoder),
        }
    }

    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        match &self.0 {
            Kind::Mlx90333(polled) => FrameSource::last(polled),
            Kind::Tmag5170(_) => None,
        }
    }

    fn begin(&mut self) {
        match &mut self.0 {
            Kind::Mlx90333(polled) => polled.begin(),
            Kind::Tmag5170(tilted) => tilted.source.begin(),
        }
    }
}
