//! The whisker module on a NUCLEO-F446RE: one whisker a side. The board is
//! `board/nucleo_f446re.rs`, the program `board/program.rs`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../board/mod.rs"]
pub mod board;
#[cfg(target_os = "none")]
#[allow(dead_code, reason = "an image has no use for some of it")]
#[path = "../board/nucleo_f446re.rs"]
mod here;

#[cfg(all(target_os = "none", not(any(feature = "both-sides", feature = "bus"))))]
program!(tick: TIM7, end_of_frame: DMA2_STREAM0);
#[cfg(all(target_os = "none", feature = "both-sides", not(feature = "bus")))]
program!(tick: TIM7, end_of_frame: DMA2_STREAM0, end_of_right_frame: DMA1_STREAM3);
#[cfg(all(target_os = "none", not(feature = "both-sides"), feature = "bus"))]
program!(tick: TIM7, end_of_frame: DMA2_STREAM0, bus: CAN1_RX0, CAN1_TX);
#[cfg(all(target_os = "none", feature = "both-sides", feature = "bus"))]
program!(
    tick: TIM7, end_of_frame: DMA2_STREAM0,
    end_of_right_frame: DMA1_STREAM3, bus: CAN1_RX0, CAN1_TX
);

/// On a PC there is nothing to do: this program is for the board.
#[cfg(not(target_os = "none"))]
fn main() {}
