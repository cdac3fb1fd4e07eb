//! The whisker's angle: a quadrature encoder on a timer of 16 or 32 bits, four
//! counts a line.

use firmware::AngleInput;
use stm32_metapac::timer::vals::{CcmrInputCcs, FilterValue, Sms};

use super::pin_config::{Mode, PinConfig};
use super::wiring::{EncoderA, EncoderB};
use crate::here::{ENCODER, ENCODER_BITS, ENCODER_FUNCTION, encoder_count};

/// A level counts after eight equal samples of the timer's clock: 100 ns at 80 MHz.
const FILTER: FilterValue = FilterValue::FCK_INT_N8;
/// A capture channel uses its own input (the register description names
/// the setting after channel 4's).
const OWN_INPUT: CcmrInputCcs = CcmrInputCcs::TI4;

/// The board's encoder timer, widened to 32 bits: right as long as less than
/// half of its round passes between two ticks.
pub(crate) struct Encoder {
    last: u32,
    counts: i32,
}

impl Encoder {
    /// Counts from zero at the whisker's present angle.
    pub(crate) fn start() -> Self {
        // Pulled up, for encoders with open collectors.
        let input = PinConfig::new(Mode::AlternateInput(ENCODER_FUNCTION)).pulled_up();
        EncoderA::new(input);
        EncoderB::new(input);
        ENCODER.ccmr_input(0).write(|w| {
            for channel in 0..2 {
                w.set_ccs(channel, OWN_INPUT);
                w.set_icf(channel, FILTER);
            }
        });
        ENCODER.smcr().write(|w| w.set_sms(Sms::ENCODER_MODE_3));
        ENCODER.cr1().write(|w| w.set_cen(true));
        Self {
            last: encoder_count(),
            counts: 0,
        }
    }
}

impl AngleInput for Encoder {
    #[inline]
    fn counts(&mut self) -> i32 {
        let now = encoder_count();
        // The short way round: the sign of the timer's bits.
        let above = u32::BITS - ENCODER_BITS;
        let moved = (now.wrapping_sub(self.last) << above).cast_signed() >> above;
        self.counts = self.counts.wrapping_add(moved);
        self.last = now;
        self.counts
    }
}
