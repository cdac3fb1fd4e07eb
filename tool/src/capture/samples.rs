//! From the records of one side to samples, as the module's own classifier gets them.

use host_sim::recording::GATE;
use tactile::TouchDetector;
use wire::{Flags, TickRecord};

use crate::sample::Sample;
use crate::tally::Before;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sampled {
    pub(crate) codes: [u16; 2],
    pub(crate) contact: f64,
    /// The number of the touch, as soon as it is sure; 0 in the air.
    pub(crate) touch: u16,
}

impl Sampled {
    /// Whether nothing is touched, nor was within the memory of contact.
    pub(crate) fn is_in_the_air(&self) -> bool {
        self.touch == 0 && self.contact < GATE
    }
}

/// Numbers the touches: by the same rule from the same codes as the module does, of whose
/// touches a record says only that there is one, and where nothing classifies not even that.
#[derive(Debug)]
pub(crate) struct Sampler {
    touches: TouchDetector,
}

impl Sampler {
    pub(crate) const fn new(tick_hz: u32) -> Self {
        Self {
            touches: TouchDetector::at(tick_hz),
        }
    }

    /// Takes a record; nothing while the whisker has a fault.
    pub(crate) fn take(&mut self, record: &TickRecord, before: Before) -> Option<Sampled> {
        if before != Before::Nothing {
            self.touches.interrupt();
        }
        if !record.flags.contains(Flags::VALID) {
            self.touches.interrupt();
            return None;
        }
        let Sample { codes, contact, .. } = Sample::new(record, 0.0);
        let number = self.touches.step(codes).number;
        Some(Sampled {
            codes,
            contact,
            touch: if self.touches.is_sure() { number } else { 0 },
        })
    }
}
