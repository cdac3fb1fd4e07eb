//! Registers that only keep what is written, such as the debug unit's freeze bits.

/// A block of registers at these offsets, with these values after a reset.
#[derive(Debug, Clone)]
pub(super) struct Plain {
    after_reset: &'static [(u32, u32)],
    values: Vec<u32>,
}

impl Plain {
    pub(super) fn new(after_reset: &'static [(u32, u32)]) -> Self {
        Self {
            after_reset,
            values: after_reset.iter().map(|(_, value)| *value).collect(),
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new(self.after_reset);
    }

    fn place(&self, offset: u32) -> Option<usize> {
        self.after_reset.iter().position(|(at, _)| *at == offset)
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        Some(self.values[self.place(offset)?])
    }

    pub(super) fn values(&self) -> &[u32] {
        &self.values
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let place = self.place(offset);
        place.map(|place| self.values[place] = value).is_some()
    }
}
