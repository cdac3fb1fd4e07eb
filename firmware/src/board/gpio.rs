//! Pins as types without size, behind the traits of embedded-hal. How a pin is
//! configured differs between chip families (`gpio_v1.rs`, `gpio_v2.rs`, by the
//! version of their registers).

use core::convert::Infallible;
use core::marker::PhantomData;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use stm32_metapac::gpio::{Gpio, vals::Idr};
use stm32_metapac::{GPIOA, GPIOB, GPIOC};

use super::pin_config::PinConfig;
use crate::here::gpio::configure;

/// A port of pins.
pub(crate) trait Port {
    /// Its registers.
    const REGISTERS: Gpio;
}

/// Port A.
pub(crate) struct A;
/// Port B.
pub(crate) struct B;
/// Port C.
pub(crate) struct C;

impl Port for A {
    const REGISTERS: Gpio = GPIOA;
}

impl Port for B {
    const REGISTERS: Gpio = GPIOB;
}

impl Port for C {
    const REGISTERS: Gpio = GPIOC;
}

/// Pin `N` of port `P`.
pub(crate) struct Pin<P, const N: usize>(PhantomData<P>);

impl<P: Port, const N: usize> Pin<P, N> {
    /// The registers of its port and its number there.
    pub(crate) const PORT_AND_NUMBER: (Gpio, usize) = (P::REGISTERS, N);

    /// Configured from now on; an output starts low.
    pub(crate) fn new(config: PinConfig) -> Self {
        let mut pin = Self(PhantomData);
        pin.low();
        configure(P::REGISTERS, N, config);
        pin
    }

    /// An output that starts high.
    pub(crate) fn new_high() -> Self {
        let mut pin = Self(PhantomData);
        pin.high();
        configure(P::REGISTERS, N, PinConfig::OUTPUT);
        pin
    }

    /// Output low.
    #[inline]
    pub(crate) fn low(&mut self) {
        const { assert!(N < 16) };
        P::REGISTERS.bsrr().write(|w| w.set_br(N, true));
    }

    /// Output high.
    #[inline]
    pub(crate) fn high(&mut self) {
        const { assert!(N < 16) };
        P::REGISTERS.bsrr().write(|w| w.set_bs(N, true));
    }
}

impl<P, const N: usize> ErrorType for Pin<P, N> {
    type Error = Infallible;
}

impl<P: Port, const N: usize> OutputPin for Pin<P, N> {
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

impl<P: Port, const N: usize> InputPin for Pin<P, N> {
    #[inline]
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(P::REGISTERS.idr().read().idr(N) == Idr::HIGH)
    }

    #[inline]
    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(P::REGISTERS.idr().read().idr(N) == Idr::LOW)
    }
}
