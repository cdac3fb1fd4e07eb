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

#[derive(Debug, Clone)]
pub(super) struct Gpio {
    reset: [u32; 3],
    moder: u32,
    otyper: u32,
    ospeedr: u32,
    pupdr: u32,
    odr: u32,
    alternate: [u32; 2],
    /// Levels from outside; what nobody drives reads high.
    outside: u32,
}

impl Gpio {
    /// A port whose MODER, OSPEEDR and PUPDR have these values after reset.
    pub(super) fn new(reset: [u32; 3]) -> Self {
        let [moder, ospeedr, pupdr] = reset;
        Self {
            reset,
            moder,
            otyper: 0,
            ospeedr,
            pupdr,
            odr: 0,
            alternate: [0; 2],
            outside: 0xFFFF,
        }
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
        match (self.moder >> (2 * pin)) & 3 {
            0 => Role::Input,
            1 => Role::Output(self.odr & (1 << pin) != 0),
            2 => {
                let functions = self.alternate[usize::from(pin >= 8)];
                Role::Alternate((functions >> (4 * (pin % 8))) & 15)
            }
            _ => Role::Analogue,
        }
    }

    pub(super) fn is_open_drain(&self, pin: u32) -> bool {
        self.otyper & (1 << pin) != 0
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
        Some(match offset {
            MODER => self.moder,
            OTYPER => self.otyper,
            OSPEEDR => self.ospeedr,
            PUPDR => self.pupdr,
            IDR => self.levels(),
            ODR => self.odr,
            BSRR => 0,
            AFRL => self.alternate[0],
            AFRH => self.alternate[1],
            _ => return None,
        })
    }

    /// Whether the register is modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        match offset {
            MODER => self.moder = value,
            OTYPER => self.otyper = value & 0xFFFF,
            OSPEEDR => self.ospeedr = value,
            PUPDR => self.pupdr = value,
            ODR => self.odr = value & 0xFFFF,
            // Set goes before reset.
            BSRR => self.odr = self.odr & !(value >> 16) | value & 0xFFFF,
            AFRL => self.alternate[0] = value,
            AFRH => self.alternate[1] = value,
            _ => return false,
        }
        true
    }
}
