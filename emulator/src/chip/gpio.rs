//! A GPIO port (RM0390, chapter 7).

const MODER: u32 = 0x00;
const OTYPER: u32 = 0x04;
const OSPEEDR: u32 = 0x08;
const PUPDR: u32 = 0x0C;
const IDR: u32 = 0x10;
const ODR: u32 = 0x14;
const BSRR: u32 = 0x18;
const AFRL: u32 = 0x20;
const AFRH: u32 = 0x24;

/// What drives a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Nobody here: an input.
    Input,
    /// The port's output register, at this level.
    Output(bool),
    /// Another peripheral, by the number of the alternate function.
    Alternate(u32),
    /// Analogue: disconnected.
    Analogue,
}

/// Registers that keep what is written.
const KEPT: [u32; 7] = [MODER, OTYPER, OSPEEDR, PUPDR, ODR, AFRL, AFRH];

#[derive(Debug, Clone)]
pub(super) struct Gpio {
    /// MODER, OSPEEDR and PUPDR after a reset.
    reset: [u32; 3],
    /// By their offsets, a word each.
    registers: [u32; 10],
    /// Levels from outside; what nobody drives reads high.
    outside: u32,
}

impl Gpio {
    /// A port whose MODER, OSPEEDR and PUPDR have these values after reset.
    pub(super) fn new(reset: [u32; 3]) -> Self {
        let [moder, ospeedr, pupdr] = reset;
        Self {
            reset,
            registers: [moder, 0, ospeedr, pupdr, 0, 0, 0, 0, 0, 0],
            outside: 0xFFFF,
        }
    }

    fn get(&self, offset: u32) -> u32 {
        self.registers[offset as usize / 4]
    }

    pub(super) fn reset(&mut self) {
        *self = Self {
            outside: self.outside,
            ..Self::new(self.reset)
        };
    }

    /// Drives a pin from outside.
    pub(super) fn drive(&mut self, pin: u32, high: bool) {
        self.outside = self.outside & !(1 << pin) | u32::from(high) << pin;
    }

    pub(super) fn role(&self, pin: u32) -> Role {
        match (self.get(MODER) >> (2 * pin)) & 3 {
            0 => Role::Input,
            1 => Role::Output(self.get(ODR) & (1 << pin) != 0),
            2 => {
                let functions = self.get(if pin < 8 { AFRL } else { AFRH });
                Role::Alternate((functions >> (4 * (pin % 8))) & 15)
            }
            _ => Role::Analogue,
        }
    }

    pub(super) fn is_open_drain(&self, pin: u32) -> bool {
        self.get(OTYPER) & (1 << pin) != 0
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

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        match offset {
            IDR => Some(self.levels()),
            BSRR => Some(0),
            _ => KEPT.contains(&offset).then(|| self.get(offset)),
        }
    }

    /// Whether the register is modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let (kept, value) = match offset {
            // Set goes before reset.
            BSRR => (ODR, self.get(ODR) & !(value >> 16) | value & 0xFFFF),
            OTYPER | ODR => (offset, value & 0xFFFF),
            _ => (offset, value),
        };
        let is_known = KEPT.contains(&kept);
        if is_known {
            self.registers[kept as usize / 4] = value;
        }
        is_known
    }
}
