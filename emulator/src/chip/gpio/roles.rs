//! What every port has, however its pins are configured.

/// What drives a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::chip) enum Role {
    /// Nothing here: an input.
    Input,
    /// The port's output register, at this level.
    Output(bool),
    /// Another peripheral, by the number of the alternate function; 0 where a pin has one.
    Alternate(u32),
    /// Analogue: disconnected.
    Analogue,
}

/// The registers that every port has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Common {
    Idr,
    Odr,
    Bsrr,
    Brr,
}
