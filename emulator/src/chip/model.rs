//! What tells one chip from another: which peripherals there are, of which version,
//! where, and what the board has wired to them.

use firmware::boards::BoardFacts;

use super::rcc::{Bus, Layout};
use super::timer::Kind;
use super::wiring::Wiring;
use super::{dma, flash, gpio, lines, power, spi, usart};

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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CoreKind {
    /// Cortex-M0+: the instructions of ARMv6-M, no access but an aligned one.
    M0Plus,
    /// Cortex-M3: ARMv7-M.
    M3,
    /// Cortex-M4 with an FPU: ARMv7E-M.
    M4F,
}

#[derive(Debug)]
pub(crate) struct Model {
    pub(crate) program: &'static str,
    pub(crate) core: CoreKind,
    pub(crate) priority_bits: u8,
    pub(crate) flash: u32,
    pub(crate) ram: u32,
    /// What the board's program and a PC know of it.
    pub(crate) facts: &'static BoardFacts,
    pub(super) map: &'static [Entry],
    pub(super) power: &'static power::Layout,
    pub(super) lines: &'static lines::Layout,
    pub(super) rcc: &'static Layout,
    /// The manuals' name of each timer, what it can do, and the bus whose clock it counts.
    pub(super) timers: &'static [(&'static str, Kind, Bus)],
    pub(super) spi_version: spi::Version,
    pub(super) usart: &'static usart::Layout,
    pub(super) spis: &'static [Bus],
    pub(super) dmas: &'static [&'static dma::Layout],
    /// Ports A, B and C after a reset.
    pub(super) ports: [gpio::Reset; 3],
    /// The watchdog's oscillator, nominal, Hz, and whether it has a window.
    pub(super) lsi_hz: u64,
    pub(super) has_window: bool,
    /// The clock that a wait state of the flash adds, Hz, from so many mV of the supply on;
    /// the highest supply first.
    pub(super) flash_hz: &'static [(u32, u64)],
    pub(super) flash_interface: &'static flash::Layout,
    /// Registers of the debug unit, which only keep what is written, and their values after a reset.
    pub(super) debug_registers: &'static [(u32, u32)],
    pub(super) wiring: Wiring,
}

impl Model {
    pub(crate) const fn tick_irq(&self) -> u16 {
        self.wiring.tick_irq
    }

    pub(crate) fn frame_irqs(&self) -> impl Iterator<Item = u16> {
        self.wiring.sides.iter().map(|side| side.end_of_frame)
    }
}
