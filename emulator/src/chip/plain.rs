//! Registers that only keep what is written: the flash interface's ACR and the
//! debug unit's freeze bits. Wait states are not modelled.

/// A block of registers at these offsets.
#[derive(Debug, Clone)]
pub(super) struct Plain {
    registers: Vec<(u32, u32)>,
}

impl Plain {
    pub(super) fn new(offsets: &[u32]) -> Self {
        Self {
            registers: offsets.iter().map(|&offset| (offset, 0)).collect(),
        }
    }

    pub(super) fn reset(&mut self) {
        for (_, value) in &mut self.registers {
            *value = 0;
        }
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        let found = self.registers.iter().find(|(at, _)| *at == offset)?;
        Some(found.1)
    }

    /// Whether the register is modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let found = self.registers.iter_mut().find(|(at, _)| *at == offset);
        found.map(|(_, kept)| *kept = value).is_some()
    }
}
