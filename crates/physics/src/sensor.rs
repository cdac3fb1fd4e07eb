//! Magnet and Hall sensor: from rotations of the base to 14-bit codes.

use crate::error::BadSetting;
use crate::noise::Noise;

/// Code of a reading of 1: 14 bits with a sign.
const CODES: f64 = 8191.0;

/// The code of a reading in codes: the nearest that is within ±`most`, which is
/// at most 32767.
pub fn sensor_code(reading: f64, most: f64) -> i16 {
    reading.round().clamp(-most, most) as i16
}

/// A sensor's settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorSettings {
    /// Rotation of the base that reads as 1 of x and of y, rad, 1e-6 to 3; more saturates.
    /// The transfer curve of each axis is programmed by itself.
    pub full_scale_rad: [f64; 2],
    /// Noise, root mean square, codes, 0 to 1000.
    pub noise_codes: f64,
    /// Time from one measurement to the next, s, 0 to 1; the value is held in
    /// between. The fast mode of the MLX90316, which the MLX90333 shares its
    /// core with, takes 350 µs, the slow one 1.5 ms.
    pub refresh_s: f64,
}

impl Default for SensorSettings {
    /// 0.15 rad (a choice: the transfer curve is programmable), 4 codes, 350 µs.
    fn default() -> Self {
        Self {
            full_scale_rad: [0.15; 2],
            noise_codes: 4.0,
            refresh_s: 350e-6,
        }
    }
}

impl SensorSettings {
    /// Whether all settings are in their ranges.
    ///
    /// # Errors
    /// The first one that is not, by name.
    pub fn check(&self) -> Result<(), BadSetting> {
        let check = BadSetting::check;
        for full_scale_rad in self.full_scale_rad {
            check("full_scale_rad", full_scale_rad, 1e-6, 3.0)?;
        }
        check("noise_codes", self.noise_codes, 0.0, 1000.0)?;
        check("refresh_s", self.refresh_s, 0.0, 1.0)?;
        Ok(())
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Sensor {
    settings: SensorSettings,
    noise: Noise,
    /// Until the next measurement.
    due_s: f64,
    codes: [i16; 2],
}

impl Sensor {
    pub(crate) fn new(settings: SensorSettings, seed: u64) -> Self {
        Self {
            settings,
            noise: Noise::new(seed),
            due_s: 0.0,
            codes: [0; 2],
        }
    }

    pub(crate) const fn settings(&self) -> SensorSettings {
        self.settings
    }

    #[inline]
    pub(crate) fn due(&self, dt_s: f64) -> bool {
        self.due_s <= dt_s
    }

    /// Lets `dt_s` pass; measures the rotations if it is time.
    pub(crate) fn advance(&mut self, rotation_rad: [f64; 2], dt_s: f64) {
        let due = self.due(dt_s);
        self.due_s -= dt_s;
        if !due {
            return;
        }
        // Measurements that fell within the step are past; a period is kept.
        let period = self.settings.refresh_s;
        self.due_s = if period > dt_s {
            self.due_s + period
        } else {
            0.0
        };
        let axes = self.codes.iter_mut().zip(self.settings.full_scale_rad);
        for ((code, full_scale_rad), rotation) in axes.zip(rotation_rad) {
            let scale = CODES / full_scale_rad;
            let noise = self.settings.noise_codes * self.noise.next();
            *code = sensor_code(scale * rotation + noise, CODES);
        }
    }

    pub(crate) fn codes(&self) -> [i16; 2] {
        self.codes
    }

    pub(crate) fn reading(&self) -> [f64; 2] {
        self.codes.map(|code| f64::from(code) / CODES)
    }
}

#[cfg(test)]
mod tests {
    use super::{Sensor, SensorSettings};

    const QUIET: SensorSettings = SensorSettings {
        full_scale_rad: [0.2, 0.05],
        noise_codes: 0.0,
        refresh_s: 0.0,
    };

    #[test]
    fn codes_are_proportional_each_to_its_range_and_saturate() {
        let mut sensor = Sensor::new(QUIET, 1);
        sensor.advance([0.1, -0.02], 5e-4);
        // A half and two fifths of 8191.
        assert_eq!(sensor.codes(), [4096, -3276]);
        sensor.advance([0.3, f64::NEG_INFINITY], 5e-4);
        assert_eq!(sensor.codes(), [8191, -8191]);
        assert_eq!(sensor.reading(), [1.0, -1.0]);
        sensor.advance([f64::NAN, 0.0], 5e-4);
        assert_eq!(sensor.codes(), [0, 0]);
    }

    #[test]
    fn a_value_is_held_until_the_next_measurement() {
        let settings = SensorSettings {
            refresh_s: 1.5e-3,
            ..QUIET
        };
        let mut sensor = Sensor::new(settings, 1);
        let read = |n: i32| {
            sensor.advance([f64::from(n) * 0.01, 0.0], 5e-4);
            sensor.codes()[0] / 409
        };
        let seen: Vec<i16> = (1..=9).map(read).collect();
        // At 0, before the first step, nothing is new; then at 1.5 ms, 3 ms …
        assert_eq!(seen, [1, 1, 3, 3, 3, 6, 6, 6, 9]);
    }

    #[test]
    fn noise_has_its_spread() {
        let settings = SensorSettings {
            noise_codes: 10.0,
            ..QUIET
        };
        let mut sensor = Sensor::new(settings, 7);
        let mut read = || {
            sensor.advance([0.0; 2], 5e-4);
            f64::from(sensor.codes()[0])
        };
        let square: f64 = (0..20_000).map(|_| read().powi(2) / 20e3).sum();
        // Rounding adds 1/12; four standard errors of the spread are 0.2.
        assert!((square.sqrt() - 10.0).abs() < 0.2, "{square}");
    }
}
