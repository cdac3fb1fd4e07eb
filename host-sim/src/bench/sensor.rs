//! The sensor of a simulated whisker, as the scene has it.

use firmware::{FrameSource, Polled, SensorFault, TiltSource, WordSource};
use mlx90333::{Decoder, FRAME_LEN, Mlx90333, Word};
use scene::{SensorModel, SensorSection};

use crate::bus::tmag5170::BelowMagnet;
use crate::bus::{OnWire, Slave};

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

    pub(super) fn on_wire(&mut self) -> OnWire<'_> {
        match self {
            Self::Mlx90333(polled) => OnWire::Mlx90333(polled.sensor_mut().spi_mut()),
            Self::Tmag5170(source) => OnWire::Tmag5170(source.sensor_mut().spi_mut()),
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
