//! Whoever is at the other end of the serial port's wires: the ST-LINK, with a baud of its own.

use std::collections::VecDeque;

use super::time::Ps;

#[derive(Debug, Clone, Default)]
pub(super) struct SerialLine {
    /// A bit at the other end; none: nothing is there.
    pub(super) bit: Option<Ps>,
    pub(super) sending: VecDeque<u8>,
    /// When the first of that has gone.
    pub(super) ends: Ps,
    pub(super) heard: Vec<u8>,
}

impl SerialLine {
    pub(super) fn next(&self) -> Option<Ps> {
        (!self.sending.is_empty()).then_some(self.ends)
    }
}
