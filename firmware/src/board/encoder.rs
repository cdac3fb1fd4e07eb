//! The whisker's angle: a quadrature encoder on a timer, four counts a line.

use firmware::AngleInput;
use stm32_metapac::timer::TimGp16;
use stm32_metapac::timer::vals::{CcmrInputCcs, FilterValue, Sms};

use super::gpio::Pin;
use super::pin_config::{Mode, PinConfig};
use super::wiring::EncoderPort;

/// A level counts after eight equal samples of the timer's clock: 111 ns at 72 MHz.
const FILTER: FilterValue = FilterValue::FCK_INT_N8;
/// Its own input, which the register description names after channel 4's.
const OWN_INPUT: CcmrInputCcs = CcmrInputCcs::TI4;

/// Widened from 16 bits: right as long as less than half of their round passes between two ticks.
pub(crate) struct Encoder {
    timer: TimGp16,
    last: u16,
    counts: i32,
}

impl Encoder {
    /// Counts from zero at the whisker's present angle.
    pub(crate) fn start(port: &EncoderPort) -> Self {
        // Pulled up, for encoders with open collectors.
        let input = PinConfig::new(Mode::AlternateInput(port.function)).pulled_up();
        for pin in [port.a, port.b] {
            Pin::new(pin, input);
        }
        let timer = port.timer;
        timer.ccmr_input(0).write(|w| {
            for channel in 0..2 {
                w.set_ccs(channel, OWN_INPUT);
                w.set_icf(channel, FILTER);
            }
        });
        // The round of 16 bits that the difference below relies on, whatever a boot loader left.
        timer.arr().write(|w| w.set_arr(u16::MAX));
        timer.smcr().write(|w| w.set_sms(Sms::ENCODER_MODE_3));
        timer.cr1().write(|w| w.set_cen(true));
        let last = timer.cnt().read().cnt();
        let counts = 0;
        Self {
            timer,
            last,
            counts,
        }
    }
}

impl AngleInput for Encoder {
    #[inline]
    fn counts(&mut self) -> i32 {
        let now = self.timer.cnt().read().cnt();
        // The short way round.
        let moved = now.wrapping_sub(self.last).cast_signed();
        self.counts = self.counts.wrapping_add(moved.into());
        self.last = now;
        self.counts
    }
}
