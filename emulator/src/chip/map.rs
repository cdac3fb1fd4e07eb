//! What can lie at an address.

use super::rcc::Bus;

/// A peripheral of the chip, by its place among its like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    Tim(usize),
    Watchdog,
    Spi(usize),
    Gpio(usize),
    Rcc,
    Flash,
    Dma(usize),
    Requests,
    Remap,
    System,
    Debug,
    Power,
    Lines,
    /// USART2.
    Usart,
    /// CAN1.
    Can,
}

/// A unit, its base address, and its gate in RCC where it has one.
pub(super) type Entry = (Unit, u32, Option<(Bus, u32)>);
