//! A GPIO port. How a pin is configured differs between the families.

mod layout;

use layout::{Layout, V1, V2};

/// What drives a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Nothing here: an input.
    Input,
    /// The port's output register, at this level.
    Output(bool),
    /// Another peripheral, by the number of the alternate function; 0 where a pin has one.
    Alternate(u32),
    /// Analogue: disconnected.
    Analogue,
}

/// By their offsets, a word each.
type Registers = [u32; 10];

/// A port as a reset leaves it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reset {
    pub(super) layout: &'static Layout,
    registers: Registers,
}

impl Reset {
    /// Four bits a pin (STM32F1): all are inputs that float.
    pub(super) const V1: Self = Self {
        layout: &V1,
        registers: [0x4444_4444, 0x4444_4444, 0, 0, 0, 0, 0, 0, 0, 0],
    };

    /// MODER, OSPEEDR and PUPDR (STM32F4, STM32G0).
    pub(super) const fn v2([moder, ospeedr, pupdr]: [u32; 3]) -> Self {
        Self {
            layout: &V2,
            registers: [moder, 0, ospeedr, pupdr, 0, 0, 0, 0, 0, 0],
        }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Gpio {
    reset: Reset,
    registers: Registers,
    /// Levels from outside; an input that floats reads high.
    outside: u32,
}

impl Gpio {
    pub(super) const fn new(reset: Reset) -> Self {
        Self {
            reset,
            registers: reset.registers,
            outside: 0xFFFF,
        }
    }

    pub(super) const fn reset(&mut self) {
        self.registers = self.reset.registers;
    }

    pub(super) fn drive(&mut self, pin: u32, high: bool) {
        self.outside = self.outside & !(1 << pin) | u32::from(high) << pin;
    }

    pub(super) fn role(&self, pin: u32) -> Role {
        let Layout { odr, role, .. } = self.reset.layout;
        let high = self.registers[*odr as usize / 4] & (1 << pin) != 0;
        role(&self.registers, pin, high)
    }

    pub(super) fn feeds(&self, pin: u32, function: u32) -> bool {
        match self.role(pin) {
            Role::Input => self.reset.layout.feeds_all,
            Role::Alternate(of) => !self.reset.layout.feeds_all && of == function,
            _ => false,
        }
    }

    pub(super) fn is_open_drain(&self, pin: u32) -> bool {
        (self.reset.layout.is_open_drain)(&self.registers, pin)
    }

    fn levels(&self) -> u32 {
        (0..16).fold(0, |levels, pin| {
            let high = match self.role(pin) {
                Role::Output(high) if !self.is_open_drain(pin) => high,
                Role::Output(false) => false,
                _ => self.outside & (1 << pin) != 0,
            };
            levels | u32::from(high) << pin
        })
    }

    /// The bits of a register that keep what is written.
    fn kept(&self, offset: u32) -> Option<u32> {
        let mut kept = self.reset.layout.kept.iter();
        kept.find(|(at, _)| *at == offset).map(|(_, bits)| *bits)
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        let layout = self.reset.layout;
        if offset == layout.idr {
            return Some(self.levels());
        }
        if offset == layout.bsrr || Some(offset) == layout.brr {
            return Some(0);
        }
        let is_kept = offset == layout.odr || self.kept(offset).is_some();
        is_kept.then(|| self.registers[offset as usize / 4])
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let layout = self.reset.layout;
        let odr = &mut self.registers[layout.odr as usize / 4];
        if offset == layout.odr {
            *odr = value & 0xFFFF;
        } else if offset == layout.bsrr {
            // Set goes before reset.
            *odr = *odr & !(value >> 16) | value & 0xFFFF;
        } else if Some(offset) == layout.brr {
            *odr &= !value;
        } else if let Some(bits) = self.kept(offset) {
            self.registers[offset as usize / 4] = value & bits;
        } else {
            return false;
        }
        true
    }
}
