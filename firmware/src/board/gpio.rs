//! Pins as types without size, behind the traits of embedded-hal. How a pin is
//! configured differs between chip families (`gpio_v1.rs`, `gpio_v2.rs`, by the
//! version of their registers).

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use stm32_metapac::gpio::{Gpio, vals::Idr};
use stm32_metapac::{GPIOA, GPIOB, GPIOC};

use super::pin_config::PinConfig;
use crate::here::gpio::configure;

/// Pin `N` of the port with the letter `PORT`.
pub(crate) struct Pin<const PORT: char, const N: usize>(());

impl<const PORT: char, const N: usize> Pin<PORT, N> {
    const REGISTERS: Gpio = match PORT {
        'A' => GPIOA,
        'B' => GPIOB,
        'C' => GPIOC,
        _ => panic!("no such port"),
    };
    /// The registers of its port and its number there.
    pub(crate) const PORT_AND_NUMBER: (Gpio, usize) = (Self::REGISTERS, N);

    /// Configured from now on; an output starts low.
    pub(crate) fn new(config: PinConfig) -> Self {
        let mut pin = Self(());
        pin.low();
        configure(Self::REGISTERS, N, config);
        pin
    }

    /// An output that starts high.
    pub(crate) fn new_high() -> Self {
        let mut pin = Self(());
        pin.high();
        configure(Self::REGISTERS, N, PinConfig::OUTPUT);
        pin
    }

    /// Output low.
    #[inline]
    pub(crate) fn low(&mut self) {
        const { assert!(N < 16) };
        Self::REGISTERS.bsrr().write(|w| w.set_br(N, true));
    }

    /// Output high.
    #[inline]
    pub(crate) fn high(&mut self) {
        const { assert!(N < 16) };
        Self::REGISTERS.bsrr().write(|w| w.set_bs(N, true));
    }
}

impl<const PORT: char, const N: usize> ErrorType for Pin<PORT, N> {
    type Error = Infallible;
}

impl<const PORT: char, const N: usize> OutputPin for Pin<PORT, N> {
    #[inline]
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.low();
        Ok(())
    }

    #[inline]
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.high();
        Ok(())
    }
}

impl<const PORT: char, const N: usize> InputPin for Pin<PORT, N> {
    #[inline]
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(Self::REGISTERS.idr().read().idr(N) == Idr::HIGH)
    }

    #[inline]
    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}
