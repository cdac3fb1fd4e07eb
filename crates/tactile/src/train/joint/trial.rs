//! What the joint trainer is given.

use std::string::String;
use std::vec::Vec;

use crate::format::MAX_BLOCK;
use crate::opinion::Whisked;
use crate::train::opinion::Expect;
use crate::train_error::TrainError;

/// Channels of a sample.
pub const CHANNELS: usize = 2;
/// How to train.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Bins an axis, 2 to 128.
    pub bins: usize,
    /// Standard deviation of the smoothing, bins; 0 (none) to 128.
    pub smooth: f64,
    /// Samples in a block, 1 to 10000.
    pub block: u32,
    /// Contact from which a sample counts, 0 to 1: what trials' touches were made by, and
    /// what the module is to gate by.
    pub gate: f64,
    /// Samples without contact after which another touch begins, in recordings of which
    /// the module did not say.
    pub gap: u32,
    /// How much may differ between training and use.
    pub expect: Expect,
    /// How it was whisked, which the model keeps.
    pub whisked: Whisked,
}

impl Default for Options {
    /// As studied; the gap is 100 ms at 2 kHz.
    fn default() -> Self {
        Self {
            bins: 24,
            smooth: 0.7,
            block: 40,
            gate: 0.05,
            gap: 200,
            expect: Expect::default(),
            whisked: Whisked::default(),
        }
    }
}

impl Options {
    pub(super) fn check(&self) -> Result<(), TrainError> {
        let option = |name, found: f64, low: f64, high: f64| {
            // Not a number is outside, too.
            if (low..=high).contains(&found) {
                return Ok(());
            }
            Err(TrainError::Option {
                name,
                found,
                low,
                high,
            })
        };
        option("bins", self.bins as f64, 2.0, 128.0)?;
        option("smooth", self.smooth, 0.0, 128.0)?;
        option("block", f64::from(self.block), 1.0, f64::from(MAX_BLOCK))?;
        option("gate", self.gate, 0.0, 1.0)?;
        option("gap", f64::from(self.gap), 1.0, 1e9)
    }
}

/// What was felt of one class without a break.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trial {
    /// Its class.
    pub label: String,
    /// The recording that it is of: a run of a scene, a drive, a day.
    pub recording: String,
    /// The pose in which it was felt, where a recording has several and says so.
    pub pose: Option<String>,
    /// How what was felt stood, where the recording says it: its tilt, and how deep it reached.
    pub stands: Option<[f64; 2]>,
    /// x and y, in any unit, in time order; those in the air among them.
    pub samples: Vec<[f64; CHANNELS]>,
    /// Of each sample that counts the number of its touch, 0 of others: in the air, or
    /// contact is less than the gate. What has no number does not count.
    pub touches: Vec<u16>,
}
