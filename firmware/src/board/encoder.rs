//! The whisker's angle: a quadrature encoder on TIM2, four counts a line,
//! 32 bits.

use firmware::AngleInput;
use stm32f4xx_hal::gpio::{PA0, PA1, Pull};
use stm32f4xx_hal::pac::{RCC, TIM2};
use stm32f4xx_hal::rcc::{Enable, Reset};

/// Input filter setting 3: a level counts after eight equal samples of the
/// timer's clock, 100 ns.
const FILTER: u8 = 3;

/// TIM2 as encoder input.
pub struct Encoder {
    timer: TIM2,
}

impl Encoder {
    /// Counts from zero at the whisker's present angle. Channels A and B are
    /// pulled up, for encoders with open collectors.
    pub(crate) fn start(timer: TIM2, a: PA0, b: PA1, rcc: &mut RCC) -> Self {
        a.into_alternate::<1>().internal_resistor(Pull::Up);
        b.into_alternate::<1>().internal_resistor(Pull::Up);
        TIM2::enable(rcc);
        TIM2::reset(rcc);
        timer.ccmr1_input().write(|w| {
            w.cc1s().ti1().cc2s().ti2();
            w.ic1f().set(FILTER).ic2f().set(FILTER)
        });
        timer.smcr().write(|w| w.sms().encoder_mode_3());
        timer.cr1().write(|w| w.cen().set_bit());
        Self { timer }
    }
}

impl AngleInput for Encoder {
    #[inline]
    fn counts(&mut self) -> i32 {
        self.timer.cnt().read().bits().cast_signed()
    }
}
