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
