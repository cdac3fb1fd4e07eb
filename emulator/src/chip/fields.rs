//! Registers and their bits, by name: what the models know of them, for the page of facts and
//! for the comparison with the chips' descriptions.

/// Bits of a register; its name as in the reference manual.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) register: &'static str,
    /// From the base of its peripheral, bytes.
    pub(super) offset: u32,
    /// Nothing: the register as a whole.
    pub(super) name: &'static str,
    pub(super) bits: u32,
}

impl Field {
    pub(super) const fn is_in(self, value: u32) -> bool {
        self.bits & value != 0
    }

    pub(super) const fn when(self, is_so: bool) -> u32 {
        if is_so { self.bits } else { 0 }
    }

    pub(super) const fn number_in(self, value: u32) -> u32 {
        (self.bits & value) >> self.bits.trailing_zeros()
    }
}

pub(super) const fn field(
    register: &'static str,
    offset: u32,
    name: &'static str,
    bits: u32,
) -> Field {
    Field {
        register,
        offset,
        name,
        bits,
    }
}

pub(super) const fn whole(register: &'static str, offset: u32) -> Field {
    field(register, offset, "", u32::MAX)
}
