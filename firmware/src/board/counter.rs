//! Time: TIM3 makes the ticks, TIM5 runs freely to measure them.
//!
//! Not the core's cycle counter, which may stand still while the core sleeps.

use firmware::Clock;
use stm32f4xx_hal::pac::{RCC, TIM3, TIM5};
use stm32f4xx_hal::rcc::{Enable, Reset};

use super::timing::TickPeriod;

/// TIM3, interrupting once a tick.
pub(crate) struct Ticker {
    timer: TIM3,
}

impl Ticker {
    /// The first tick comes one period from now.
    pub(crate) fn start(timer: TIM3, period: TickPeriod, rcc: &mut RCC) -> Self {
        TIM3::enable(rcc);
        TIM3::reset(rcc);
        timer.psc().write(|w| w.psc().set(period.prescaler - 1));
        timer.arr().write(|w| w.arr().set(period.period - 1));
        // The prescaler takes effect with an update; that one is no tick.
        timer.cr1().write(|w| w.urs().set_bit());
        timer.egr().write(|w| w.ug().set_bit());
        timer.dier().write(|w| w.uie().set_bit());
        timer.cr1().modify(|_, w| w.cen().set_bit());
        Self { timer }
    }

    /// The interrupt has been seen.
    #[inline]
    pub(crate) fn acknowledge(&mut self) {
        self.timer.sr().write(|w| w.uif().clear_bit());
    }
}

/// TIM5, counting at [`APB1_TIMER_HZ`](super::timing::APB1_TIMER_HZ) through 32 bits.
pub struct Counter {
    timer: TIM5,
}

impl Counter {
    /// Counts from now on.
    pub(crate) fn start(timer: TIM5, rcc: &mut RCC) -> Self {
        TIM5::enable(rcc);
        TIM5::reset(rcc);
        timer.cr1().write(|w| w.cen().set_bit());
        Self { timer }
    }
}

impl Clock for Counter {
    #[inline]
    fn now(&mut self) -> u32 {
        self.timer.cnt().read().bits()
    }
}
