//! What a chip's layout says of RCC, by name.

use super::{CR, Layout};
use crate::chip::fields::{Field, field};

/// Switches and ready flags of oscillators and PLL, in the order of [`Layout::switches`].
const SWITCHES: [[&str; 2]; 3] = [
    ["HSION", "HSIRDY"],
    ["HSEON", "HSERDY"],
    ["PLLON", "PLLRDY"],
];

impl Layout {
    /// The registers of gates, or of resets, of a peripheral's bus.
    pub(in crate::chip) fn gate(&self, bus: super::Bus) -> Option<u32> {
        let mut gates = self.gates.iter();
        gates.find(|gate| gate.0 == bus).map(|gate| gate.1)
    }

    pub(in crate::chip) fn reset(&self, bus: super::Bus) -> Option<u32> {
        let mut resets = self.resets.iter();
        resets.find(|reset| reset.0 == bus).map(|reset| reset.1)
    }

    pub(in crate::chip) fn fields(&self) -> Vec<Field> {
        let (cfgr, mask, above) = self.selection;
        let (csr, clear) = self.csr;
        let pin = self.causes[2];
        let switches = self.switches.iter().zip(SWITCHES);
        let switches = switches.flat_map(|((on, ready), [switch, flag])| {
            [field("CR", CR, switch, *on), field("CR", CR, flag, *ready)]
        });
        switches
            .chain([
                field("CFGR", cfgr, "SW", mask),
                field("CFGR", cfgr, "SWS", mask << above),
                field("CSR", csr, "RMVF", clear),
                field("CSR", csr, "PINRSTF", pin),
                field("CSR", csr, "IWDGRSTF", self.causes[1] & !pin),
                field("CSR", csr, "SFTRSTF", self.causes[3] & !pin),
            ])
            .collect()
    }
}
