//! The sensor of a simulated whisker, as the scene has it.

use firmware::{FrameSource, Polled, SensorFault, TiltSource, WordSource};
use mlx90333::{Decoder, FRAME_LEN, Mlx90333, Word};
use scene::{SensorModel, SensorSection};

use crate::bus::Slave;
use crate::bus::tmag5170::{BelowMagnet, TmagSlave};

pub(super) enum AnySensor {
    Mlx90333(Polled<Slave>),
    Tmag5170(Box<TiltSource<BelowMagnet>>),
}

impl AnySensor {
    /// The noise follows from `seed` where the bus does not make its own. `None`: no such magnet.
    pub(super) fn new(section: &SensorSection, seed: u64) -> Option<Self> {
        Some(match section.model {
            SensorModel::Mlx90333 => {
                let decoder = config::decoder(section);
                Self::Mlx90333(Polled::new(Mlx90333::new(Slave::of(decoder), decoder)))
            }
            SensorModel::Tmag5170 => {
                let source = TiltSource::of_module(BelowMagnet::new(seed)?);
                Self::Tmag5170(Box::new(source))
            }
        })
    }

    pub(super) fn slave_mut(&mut self) -> Option<&mut Slave> {
        match self {
            Self::Mlx90333(polled) => Some(polled.sensor_mut().spi_mut()),
            Self::Tmag5170(_) => None,
        }
    }

    pub(super) fn tmag_mut(&mut self) -> Option<&mut TmagSlave> {
        match self {
            Self::Mlx90333(_) => None,
            Self::Tmag5170(source) => Some(&mut source.sensor_mut().spi_mut().slave),
        }
    }

    /// Deflections along x and y from now on, in units of the range.
    pub(super) fn bend(&mut self, deflection: [f64; 2]) {
        match self {
            Self::Mlx90333(polled) => polled.sensor_mut().spi_mut().set(deflection),
            Self::Tmag5170(source) => source.sensor_mut().spi_mut().bend(deflection),
        }
    }
}

impl WordSource for AnySensor {
    fn words(&mut self, decoder: Decoder) -> Result<[Word; 2], SensorFault> {
        match self {
            Self::Mlx90333(polled) => polled.words(decoder),
            Self::Tmag5170(source) => source.words(decoder),
        }
    }

    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        match self {
            Self::Mlx90333(polled) => FrameSource::last(polled),
            Self::Tmag5170(_) => None,
        }
    }

    fn begin(&mut self) {
        match self {
            Self::Mlx90333(polled) => polled.begin(),
            Self::Tmag5170(source) => source.begin(),
        }
    }
}
