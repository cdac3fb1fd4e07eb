//! Motor PWM: TIM1, edge aligned, one compare channel a phase.
//!
//! Compare values are buffered: a new duty takes effect at the next period. The timer may raise its
//! outputs again by itself (AOE) in no case: what [`outputs`](super::outputs) took low stays low.

use core::convert::Infallible;

use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32_metapac::TIM1;
use stm32_metapac::common::{RW, Reg};
use stm32_metapac::timer::regs::Ccr1ch;
use stm32_metapac::timer::vals::{Ossi, Ossr};

/// PWM mode 1, as a number: its type has another name in each version of the timer.
const PWM_MODE_1: u8 = 6;
const OUTPUTS: usize = 3;

pub(crate) struct Channel {
    compare: Reg<Ccr1ch, RW>,
    /// Of a period.
    counts: u16,
}

/// With all duties zero; the pins are the caller's.
pub(crate) fn start(counts: u16) {
    TIM1.arr().write(|w| w.set_arr(counts.saturating_sub(1)));
    for pair in 0..OUTPUTS.div_ceil(2) {
        TIM1.ccmr_output(pair).write(|w| {
            for channel in 0..2.min(OUTPUTS - 2 * pair) {
                w.set_ocm(channel, PWM_MODE_1.into());
                w.set_ocpe(channel, true);
            }
        });
    }
    TIM1.ccer().write(|w| {
        for channel in 0..OUTPUTS {
            w.set_cce(channel, true);
        }
    });
    // With outputs off (a fault, a debugger) its idle level is low, and pins do not float.
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
}

impl Channel {
    /// That of an output, counted from 0, once the timer was started with so many counts a period.
    pub(crate) fn of(output: usize, counts: u16) -> Self {
        let compare = TIM1.ccr(output % OUTPUTS);
        Self { compare, counts }
    }
}

impl ErrorType for Channel {
    type Error = Infallible;
}

impl SetDutyCycle for Channel {
    #[inline]
    fn max_duty_cycle(&self) -> u16 {
        self.counts
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.compare.write(|w| w.set_ccr(duty));
        Ok(())
    }
}
