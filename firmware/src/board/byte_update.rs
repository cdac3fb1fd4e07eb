//! The byte timer requests a byte at each of its updates.

use stm32_metapac::timer::TimBasic;

/// Nothing to set: updates need no more than the period.
pub(crate) fn set_up(_: u16) {}

#[inline]
pub(crate) fn begin(timer: TimBasic) {
    timer.dier().write(|w| w.set_ude(true));
}
