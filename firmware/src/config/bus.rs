//! A head of several boards on one bus.

use core::ops::Range;

use serde::{Deserialize, Serialize};

use super::{HeadConfig, Part};

/// The bus of a head, and how many boards share its whiskers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct BusConfig {
    /// Boards, 2 to [`MAX_NODES`](can::MAX_NODES): each carries as many whiskers as any other,
    /// node 0 the first of the left side.
    pub nodes: u8,
    /// Bits a second, thousands: 125 to 1000.
    pub kbit_s: u16,
}

impl HeadConfig {
    /// The whiskers of a board, counted from 0, left side first; all of them where there is one
    /// board, none of a node that there is not.
    pub fn of_node(&self, number: u8) -> Range<usize> {
        if !Part::Bus.is_built() {
            return 0..self.whiskers();
        }
        let nodes = self.bus.map_or(1, |bus| bus.nodes);
        let each = self.whiskers().checked_div(nodes.into()).unwrap_or(0);
        let first = usize::from(number) * each;
        if number < nodes {
            first..first + each
        } else {
            0..0
        }
    }

    /// Whether a board carries whiskers of a side, 0: the left.
    pub fn carries(&self, number: u8, side: usize) -> bool {
        let own = self.of_node(number);
        let each = usize::from(self.whiskers_per_side);
        own.start < (side + 1) * each && own.end > side * each
    }
}
