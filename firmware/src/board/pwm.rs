//! Motor PWM: TIM1, edge aligned, one compare channel a phase.
//!
//! Compare values are buffered: a new duty takes effect at the next period.
//! Written here rather than taken from the HAL because that lets the timer
//! raise its outputs again by itself (AOE) after they were switched off.

use core::convert::Infallible;

use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32f4xx_hal::pac::{RCC, TIM1};
use stm32f4xx_hal::rcc::{Enable, Reset};

use super::timing::PWM_COUNTS;

/// Channel `C` + 1 of TIM1.
pub struct Channel<const C: usize> {
    timer: TIM1,
}

/// Starts the timer with all duties zero. The pins are the caller's.
pub(crate) fn start(timer: TIM1, rcc: &mut RCC) -> (Channel<0>, Channel<1>, Channel<2>) {
    TIM1::enable(rcc);
    TIM1::reset(rcc);
    timer.arr().write(|w| w.arr().set(PWM_COUNTS - 1));
    timer.ccmr1_output().write(|w| {
        w.oc1m().pwm_mode1().oc1pe().set_bit();
        w.oc2m().pwm_mode1().oc2pe().set_bit()
    });
    timer
        .ccmr2_output()
        .write(|w| w.oc3m().pwm_mode1().oc3pe().set_bit());
    timer
        .ccer()
        .write(|w| w.cc1e().set_bit().cc2e().set_bit().cc3e().set_bit());
    // With outputs off (a fault, a debugger) the timer drives its idle level,
    // low, instead of letting the pins float.
    timer
        .bdtr()
        .write(|w| w.ossi().set_bit().ossr().set_bit().moe().set_bit());
    timer.egr().write(|w| w.ug().set_bit());
    timer.cr1().write(|w| w.arpe().set_bit().cen().set_bit());

    #[allow(unsafe_code, reason = "one timer is shared by its channels")]
    // SAFETY: from here on each channel writes its own compare register only.
    let [second, third] = unsafe { [TIM1::steal(), TIM1::steal()] };
    (
        Channel { timer },
        Channel { timer: second },
        Channel { timer: third },
    )
}

impl<const C: usize> ErrorType for Channel<C> {
    type Error = Infallible;
}

impl<const C: usize> SetDutyCycle for Channel<C> {
    #[inline]
    fn max_duty_cycle(&self) -> u16 {
        PWM_COUNTS
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        const { assert!(C < 4) };
        self.timer.ccr(C).write(|w| w.ccr().set(duty));
        Ok(())
    }
}
