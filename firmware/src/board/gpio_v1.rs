//! Pins of chips with four bits of configuration a pin (STM32F1).

use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{CnfIn, CnfOut, Mode as Speed};

use crate::board::gpio::Mode;

/// Puts pin `n` of `port`, 0 to 15, into `mode`.
#[inline(never)]
pub(crate) fn configure(port: Gpio, n: usize, mode: Mode) {
    let output = match mode {
        Mode::Output => Some((Speed::OUTPUT2MHZ, CnfOut::PUSH_PULL)),
        Mode::Drives(_) => Some((Speed::OUTPUT2MHZ, CnfOut::ALT_PUSH_PULL)),
        Mode::DrivesFast(_) => Some((Speed::OUTPUT10MHZ, CnfOut::ALT_PUSH_PULL)),
        Mode::DrivesOpenDrain(_) => Some((Speed::OUTPUT2MHZ, CnfOut::ALT_OPEN_DRAIN)),
        Mode::InputPulledUp | Mode::Hears(_) | Mode::HearsPulledUp(_) => None,
    };
    let pulled_up = matches!(mode, Mode::InputPulledUp | Mode::HearsPulledUp(_));
    if pulled_up {
        // An input with a pull has its direction in the output register.
        port.bsrr().write(|w| w.set_bs(n, true));
    }
    port.cr(n / 8).modify(|w| {
        if let Some((speed, kind)) = output {
            w.set_mode(n % 8, speed);
            w.set_cnf_out(n % 8, kind);
        } else {
            w.set_mode(n % 8, Speed::INPUT);
            let kind = if pulled_up {
                CnfIn::PULL
            } else {
                CnfIn::FLOATING
            };
            w.set_cnf_in(n % 8, kind);
        }
    });
}
