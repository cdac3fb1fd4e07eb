//! A TMAG5170 below the magnet that a whisker's base turns.

use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use physics::{Magnet, SensorSettings};
use tmag5170::Version;

use super::{SimSpiError, TmagSlave};

/// Field of the magnet along the axis of the sensor, mT: docs/build.md.
const AXIAL_MT: f64 = 60.0;

/// The sensor, and the wire to it, and the magnet above it: an [`SpiDevice`].
#[derive(Debug, Clone)]
pub struct BelowMagnet {
    /// The sensor.
    pub slave: TmagSlave,
    magnet: Magnet,
    /// Tilt that reads as a deflection of 1, rad.
    full_scale_rad: f64,
}

impl BelowMagnet {
    /// A whisker at rest, and a sensor whose noise follows from `seed`.
    ///
    /// `None` if there is no such magnet, which does not depend on the seed.
    pub fn new(seed: u64) -> Option<Self> {
        let [full_scale_rad, _] = SensorSettings::default().full_scale_rad;
        let mut below = Self {
            slave: TmagSlave::new(Version::A1).with_noise(seed),
            magnet: Magnet::of_field(AXIAL_MT).ok()?,
            full_scale_rad,
        };
        below.bend([0.0; 2]);
        Some(below)
    }

    /// Deflections along x and y from now on, in units of the range.
    pub fn bend(&mut self, deflection: [f64; 2]) {
        let tilt = deflection.map(|along| self.full_scale_rad * along);
        self.slave.set_field(self.magnet.field_mt(tilt));
    }
}

impl ErrorType for BelowMagnet {
    type Error = SimSpiError;
}

impl SpiDevice for BelowMagnet {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), SimSpiError> {
        self.slave.transaction(operations)
    }
}

#[cfg(test)]
mod tests {
    use super::BelowMagnet;

    #[test]
    fn a_deflection_of_one_is_the_modules_full_scale() {
        let below = BelowMagnet::new(1).unwrap();
        assert_eq!(below.full_scale_rad as f32, firmware::FULL_SCALE);
    }
}
