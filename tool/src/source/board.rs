//! What building a board's program, and looking for the board, must know of it.

use firmware::boards::{BoardFacts, NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB};

use super::program::BoardName;

pub(crate) struct Board {
    pub(crate) name: &'static str,
    pub(crate) program: &'static str,
    pub(crate) target: &'static str,
    pub(crate) facts: &'static BoardFacts,
    pub(crate) chip: &'static str,
    /// The identity of its chip (RM0390, RM0008 and RM0444, "Debug support", "MCU device ID
    /// code": DEV_ID).
    pub(crate) chip_id: u16,
}

impl BoardName {
    pub(crate) const fn board(self) -> Board {
        match self {
            Self::NucleoF446re => Board {
                name: "nucleo-f446re",
                program: "nucleo_f446re",
                target: "thumbv7em-none-eabihf",
                facts: &NUCLEO_F446RE,
                chip: "STM32F446RETx",
                chip_id: 0x421,
            },
            Self::NucleoF103rb => Board {
                name: "nucleo-f103rb",
                program: "nucleo_f103rb",
                target: "thumbv7m-none-eabi",
                facts: &NUCLEO_F103RB,
                chip: "STM32F103RBTx",
                chip_id: 0x410,
            },
            Self::NucleoG071rb => Board {
                name: "nucleo-g071rb",
                program: "nucleo_g071rb",
                target: "thumbv6m-none-eabi",
                facts: &NUCLEO_G071RB,
                chip: "STM32G071RBTx",
                chip_id: 0x460,
            },
        }
    }
}
