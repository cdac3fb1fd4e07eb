//! Pins of chips with four bits of configuration a pin (STM32F1).

use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{CnfIn, CnfOut, Mode as Direction};

use crate::board::pin_config::{Mode, PinConfig, Pull, Speed};

#[inline(never)]
pub(crate) fn configure(port: Gpio, n: usize, config: PinConfig) {
    let output = match config.mode {
        Mode::Output => Some(CnfOut::PUSH_PULL),
        Mode::AlternateOutput(_) => Some(CnfOut::ALT_PUSH_PULL),
        Mode::AlternateOpenDrain(_) => Some(CnfOut::ALT_OPEN_DRAIN),
        // A peripheral's input is an ordinary input on these chips.
        Mode::Input | Mode::AlternateInput(_) => None,
    };
    if config.pull == Pull::Up {
        // The output register selects the direction of an input's pull.
        port.bsrr().write(|w| w.set_bs(n, true));
    }
    port.cr(n / 8).modify(|w| {
        if let Some(kind) = output {
            let direction = match config.speed {
                Speed::Low => Direction::OUTPUT2MHZ,
                Speed::High => Direction::OUTPUT10MHZ,
            };
            w.set_mode(n % 8, direction);
            w.set_cnf_out(n % 8, kind);
        } else {
            let kind = match config.pull {
                Pull::Floating => CnfIn::FLOATING,
                Pull::Up => CnfIn::PULL,
            };
            w.set_mode(n % 8, Direction::INPUT);
            w.set_cnf_in(n % 8, kind);
        }
    });
}
