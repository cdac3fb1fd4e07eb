//! A GPIO port. How a pin is configured differs between the families, a file each.

mod v1;
mod v2;

use super::fields::Field;
use v1::TwoRegisters;
use v2::Modes;

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

/// The registers that every port has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Common {
    Idr,
    Odr,
    Bsrr,
    Brr,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Reset {
    /// Four bits a pin (STM32F1): all are inputs.
    V1,
    /// MODER, OSPEEDR and PUPDR (STM32F4, STM32G0).
    V2([u32; 3]),
}

pub(super) const fn fields(reset: Reset) -> &'static [Field] {
    match reset {
        Reset::V1 => &v1::FIELDS,
        Reset::V2(_) => &v2::FIELDS,
    }
}

#[derive(Debug, Clone)]
enum Config {
    V1(TwoRegisters),
    V2(Modes),
}

impl Config {
    fn new(reset: Reset) -> Self {
        match reset {
            Reset::V1 => Self::V1(TwoRegisters::default()),
            Reset::V2(modes) => Self::V2(Modes::new(modes)),
        }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Gpio {
    reset: Reset,
    config: Config,
    odr: u32,
    /// Levels from outside; an input that floats reads high.
    outside: u32,
}

impl Gpio {
    pub(super) fn new(reset: Reset) -> Self {
        Self {
            reset,
            config: Config::new(reset),
            odr: 0,
            outside: 0xFFFF,
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self {
            outside: self.outside,
            ..Self::new(self.reset)
        };
    }

    pub(super) fn drive(&mut self, pin: u32, high: bool) {
        self.outside = self.outside & !(1 << pin) | u32::from(high) << pin;
    }

    pub(super) fn role(&self, pin: u32) -> Role {
        let high = self.odr & (1 << pin) != 0;
        match &self.config {
            Config::V1(config) => config.role(pin, high),
            Config::V2(config) => config.role(pin, high),
        }
    }

    pub(super) fn feeds(&self, pin: u32, function: u32) -> bool {
        match self.config {
            // An ordinary input is a peripheral's, too.
            Config::V1(_) => self.role(pin) == Role::Input,
            Config::V2(_) => self.role(pin) == Role::Alternate(function),
        }
    }

    pub(super) fn is_open_drain(&self, pin: u32) -> bool {
        match &self.config {
            Config::V1(config) => config.is_open_drain(pin),
            Config::V2(config) => config.is_open_drain(pin),
        }
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

    fn common(&self, offset: u32) -> Option<Common> {
        match self.config {
            Config::V1(_) => v1::common(offset),
            Config::V2(_) => v2::common(offset),
        }
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        match (self.common(offset), &self.config) {
            (Some(Common::Idr), _) => Some(self.levels()),
            (Some(Common::Odr), _) => Some(self.odr),
            (Some(Common::Bsrr | Common::Brr), _) => Some(0),
            (None, Config::V1(config)) => config.read(offset),
            (None, Config::V2(config)) => config.read(offset),
        }
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        match (self.common(offset), &mut self.config) {
            (Some(Common::Idr), _) => return false,
            (Some(Common::Odr), _) => self.odr = value & 0xFFFF,
            // Set goes before reset.
            (Some(Common::Bsrr), _) => self.odr = self.odr & !(value >> 16) | value & 0xFFFF,
            (Some(Common::Brr), _) => self.odr &= !value,
            (None, Config::V1(config)) => return config.write(offset, value),
            (None, Config::V2(config)) => return config.write(offset, value),
        }
        true
    }
}
