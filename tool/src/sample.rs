//! What a record carries, in physical units: read here alone.

use wire::{Flags, TickRecord, degrees, unit};

const FULL: f64 = 32767.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    pub(crate) t_s: f64,
    /// x and y of the record, whose two lowest bits are no measurement.
    pub(crate) words: [u16; 2],
    /// x and y as the sensor has them, codes of 14 bits.
    pub(crate) codes: [u16; 2],
    pub(crate) setpoint_deg: f64,
    /// Where it is by its encoder, degrees.
    pub(crate) measured_deg: f64,
    /// What drives its motor, −1 to 1.
    pub(crate) duty: f64,
    /// State of its gate z, and its contact π.
    pub(crate) z: f64,
    pub(crate) contact: f64,
    pub(crate) flags: Flags,
}

impl Sample {
    pub(crate) fn new(record: &TickRecord, t_s: f64) -> Self {
        Self {
            t_s,
            words: [record.x, record.y],
            codes: record.codes(),
            setpoint_deg: degrees(record.setpoint).into(),
            measured_deg: degrees(record.measured).into(),
            duty: f64::from(record.duty) / FULL,
            z: unit(record.z).into(),
            contact: unit(record.contact).into(),
            flags: record.flags,
        }
    }

    pub(crate) const fn is_valid(&self) -> bool {
        self.flags.contains(Flags::VALID)
    }
}
