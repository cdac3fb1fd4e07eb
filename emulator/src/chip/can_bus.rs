//! A chip on the bus of a head: what comes, and what it sends; and its number.

use super::can::{Arrival, Request};
use super::model::Unit;
use super::wiring::{CAN, NUMBER, PORTS_BUS};
use super::{Chip, Fault, Ps};

/// By how many thousandths the chip's bits may differ from those of the others.
const OFF_PERMILLE: Ps = 5;

impl Chip {
    pub(crate) fn set_number(&mut self, number: u8) {
        for (bit, pin) in NUMBER.into_iter().enumerate() {
            self.gpio[pin.port].drive(pin.number, number >> bit & 1 == 0);
        }
    }

    pub(crate) fn expect(&mut self, at: Ps, what: Arrival) {
        if self.is_clocked(Unit::Can) {
            self.can.expect(at, what);
        }
    }

    /// Whether it takes part in what the bus does.
    pub(crate) fn is_on_bus(&self) -> bool {
        self.is_clocked(Unit::Can) && self.can.is_on()
    }

    /// What it has asked of a bus with such bits since the last call, and when.
    pub(crate) fn take_requests(&mut self, bit: Ps) -> Result<Vec<(Ps, Request)>, Fault> {
        let requests = self.can.take_requests();
        let function = self.model.wiring.can_function;
        let Some(function) = function.filter(|_| !requests.is_empty()) else {
            return Ok(Vec::new());
        };
        let found = self.can.bit(self.clocks.bus(PORTS_BUS));
        let agrees = found.abs_diff(bit) * 1_000 <= OFF_PERMILLE * bit;
        let is_wired = self.drives(&CAN[1..], function) && self.hears(&CAN[..1], function);
        if agrees && is_wired {
            return Ok(requests);
        }
        Err(Fault::Misused {
            peripheral: "CAN1",
            what: "its bits are not as long as those of the others, or its pins are not its own",
        })
    }
}
