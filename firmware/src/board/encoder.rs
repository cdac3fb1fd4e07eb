//! The whisker's angle: a quadrature encoder on a timer of 16 or 32 bits, four
//! counts a line.

use firmware::AngleInput;
use stm32_metapac::timer::vals::{CcmrInputCcs, FilterValue, Sms};

use super::pin_config::{Mode, PinConfig};
use super::wiring::{EncoderA, EncoderB};
use crate::here::{ENCODER, ENCODER_FUNCTION, encoder_count};

/// A level counts after eight equal samples of the timer's clock: 100 ns at 80 MHz.
const FILTER: FilterValue = FilterValue::FCK_INT_N8;
/// A capture channel uses its own input (the register description names
/// the setting after channel 4's).
const OWN_INPUT: CcmrInputCcs = CcmrInputCcs::TI4;

/// What a timer counts; wraps around.
pub(crate) trait Count: Copy {
    /// From `earlier` to now, the short way round.
    fn since(self, earlier: Self) -> i32;
}

impl Count for u16 {
    #[inline]
    fn since(self, earlier: Self) -> i32 {
        self.wrapping_sub(earlier).cast_signed().into()
    }
}

impl Count for u32 {
    #[inline]
    fn since(self, earlier: Self) -> i32 {
        self.wrapping_sub(earlier).cast_signed()
    }
}

/// A timer as encoder input, widened to 32 bits: right as long as less than
/// half of its round passes between two ticks.
pub(crate) struct Widened<C> {
    last: C,
    counts: i32,
}

/// What the board's encoder timer makes of it.
pub(crate) type Encoder = Widened<crate::here::EncoderCount>;

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
        self.counts = self.counts.wrapping_add(now.since(self.last));
        self.last = now;
        self.counts
    }
}
