//! Motor PWM: TIM1, edge aligned, one compare channel a phase.
//!
//! Compare values are buffered: a new duty takes effect at the next period.
//! The timer may raise its outputs again by itself (AOE) in no case: what
//! [`outputs`](super::outputs) took low stays low.

use core::convert::Infallible;

use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32_metapac::TIM1;
use stm32_metapac::timer::vals::{Ossi, Ossr};

use crate::here::CLOCKS;

const COUNTS: u16 = CLOCKS.pwm_counts();
/// PWM mode 1: high while the count is below the compare value. As a number,
/// because its type has another name in each version of the timer.
const PWM_MODE_1: u8 = 6;
/// Channels in use.
const CHANNELS: usize = 3;

/// Channel `C` + 1 of TIM1.
pub(crate) struct Channel<const C: usize>(());

/// Starts the timer with all duties zero. The pins are the caller's.
pub(crate) fn start() -> (Channel<0>, Channel<1>, Channel<2>) {
    TIM1.arr().write(|w| w.set_arr(COUNTS - 1));
    for pair in 0..CHANNELS.div_ceil(2) {
        TIM1.ccmr_output(pair).write(|w| {
            for channel in 0..2.min(CHANNELS - 2 * pair) {
                w.set_ocm(channel, PWM_MODE_1.into());
                w.set_ocpe(channel, true);
            }
        });
    }
    TIM1.ccer().write(|w| {
        for channel in 0..CHANNELS {
            w.set_cce(channel, true);
        }
    });
    // With outputs off (a fault, a debugger) the timer drives its idle level,
    // low, instead of letting the pins float.
    TIM1.bdtr().write(|w| {
        w.set_ossi(Ossi::IDLE_LEVEL);
        w.set_ossr(Ossr::IDLE_LEVEL);
        w.set_moe(true);
    });
    TIM1.egr().write(|w| w.set_ug(true));
    TIM1.cr1().write(|w| {
        w.set_arpe(true);
        w.set_cen(true);
    });
    (Channel(()), Channel(()), Channel(()))
}

impl<const C: usize> ErrorType for Channel<C> {
    type Error = Infallible;
}

impl<const C: usize> SetDutyCycle for Channel<C> {
    #[inline]
    fn max_duty_cycle(&self) -> u16 {
        COUNTS
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        const { assert!(C < CHANNELS) };
        TIM1.ccr(C).write(|w| w.set_ccr(duty));
        Ok(())
    }
}
