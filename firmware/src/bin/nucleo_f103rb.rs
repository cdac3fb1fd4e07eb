//! The whisker module on a NUCLEO-F103RB: one whisker, the left. The board is
//! `board/nucleo_f103rb.rs`, the program `board/program.rs`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../board/mod.rs"]
pub mod board;
#[cfg(target_os = "none")]
#[allow(dead_code, reason = "an image has no use for some of it")]
#[path = "../board/nucleo_f103rb.rs"]
mod here;

#[cfg(all(target_os = "none", not(feature = "bus")))]
program!(tick: TIM3, end_of_frame: DMA1_CHANNEL2);
#[cfg(all(target_os = "none", feature = "bus"))]
program!(
    tick: TIM3, end_of_frame: DMA1_CHANNEL2, bus: USB_LP_CAN1_RX0, USB_HP_CAN1_TX
);

/// On a PC there is nothing to do: this program is for the board.
#[cfg(not(target_os = "none"))]
fn main() {}
