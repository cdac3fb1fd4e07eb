//! Pins behind the traits of embedded-hal. How a pin is configured differs between
//! chip families (`gpio_v1.rs`, `gpio_v2.rs`, by the version of their registers).

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::regs::Bsrr;
use stm32_metapac::{GPIOA, GPIOB, GPIOC};

use super::pin_config::PinConfig;
use crate::here::gpio::configure;

#[derive(Clone, Copy)]
pub(crate) struct PinName {
    port: Gpio,
    /// In the port's registers, one of sixteen.
    bit: u32,
}

impl PinName {
    /// For constants: does not compile for a pin that no board brings out.
    pub(crate) const fn new(port: char, number: u8) -> Self {
        assert!(number < 16);
        let port = match port {
            'A' => GPIOA,
            'B' => GPIOB,
            'C' => GPIOC,
            _ => panic!("no such port"),
        };
        let bit = 1 << number;
        Self { port, bit }
    }

    pub(crate) fn configure(self, config: PinConfig) {
        configure(self.port, self.bit.trailing_zeros() as usize % 16, config);
    }

    #[inline]
    pub(crate) fn low(self) {
        self.port.bsrr().write_value(Bsrr(self.bit << 16));
    }

    #[inline]
    pub(crate) fn high(self) {
        self.port.bsrr().write_value(Bsrr(self.bit));
    }

    #[inline]
    pub(crate) fn is_low(self) -> bool {
        self.port.idr().read().0 & self.bit == 0
    }
}

pub(crate) struct Pin(PinName);

impl Pin {
    /// An output starts low.
    pub(crate) fn new(name: PinName, config: PinConfig) -> Self {
        name.low();
        name.configure(config);
        Self(name)
    }

    pub(crate) fn new_high(name: PinName) -> Self {
        name.high();
        name.configure(PinConfig::OUTPUT);
        Self(name)
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    #[inline]
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.low();
        Ok(())
    }

    #[inline]
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.high();
        Ok(())
    }
}

impl InputPin for Pin {
    #[inline]
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.is_low())
    }

    #[inline]
    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.is_low())
    }
}
