//! The board's wires, a side each: the pins, and the timers, DMA streams and
//! interrupts behind them.
//!
//! The numbers are those of RM0390 and the chip's data sheet. Each is held against
//! another source, the description that stm32-metapac makes from ST's configuration
//! tool, in `tests/description.rs`.

use super::timers::{TIM2, TIM3, TIM6, TIM8};

/// A pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pin {
    /// The port, GPIOA first.
    pub(super) port: usize,
    pub(super) number: u32,
}

impl Pin {
    const fn new(port: char, number: u32) -> Self {
        let port = port as usize - 'A' as usize;
        Self { port, number }
    }
}

/// What a stream of a DMA controller listens to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) stream: usize,
    pub(super) channel: u32,
}

/// One side of the board.
#[derive(Debug)]
pub(super) struct Side {
    /// SCK, MISO and MOSI of the sensor's SPI (SPI1 on the left, SPI2 on the right).
    pub(super) spi: [Pin; 3],
    /// /SS of the sensor.
    pub(super) select: Pin,
    /// The timer whose update asks for the next byte of a frame.
    pub(super) byte_timer: usize,
    /// The DMA controller that moves the bytes, DMA1 first.
    pub(super) dma: usize,
    /// Reception by the SPI.
    pub(super) rx: Request,
    /// Update of the byte timer.
    pub(super) tx: Request,
    /// The interrupt of the rx stream in the NVIC.
    pub(super) end_of_frame: u16,
    /// Channels A and B of the encoder.
    pub(super) encoder: [Pin; 2],
    pub(super) encoder_timer: usize,
    /// The alternate function of the encoder's pins.
    pub(super) encoder_function: u32,
    /// Direction of the H-bridge.
    pub(super) direction: Pin,
}

/// Left and right.
pub(super) const SIDES: [Side; 2] = [
    Side {
        spi: [Pin::new('A', 5), Pin::new('A', 6), Pin::new('A', 7)],
        select: Pin::new('B', 6),
        byte_timer: TIM8,
        dma: 1,
        rx: Request {
            stream: 0,
            channel: 3,
        },
        tx: Request {
            stream: 1,
            channel: 7,
        },
        end_of_frame: 56,
        encoder: [Pin::new('A', 0), Pin::new('A', 1)],
        encoder_timer: TIM2,
        encoder_function: 1,
        direction: Pin::new('B', 5),
    },
    Side {
        spi: [Pin::new('B', 13), Pin::new('B', 14), Pin::new('B', 15)],
        select: Pin::new('B', 12),
        byte_timer: TIM6,
        dma: 0,
        rx: Request {
            stream: 3,
            channel: 0,
        },
        tx: Request {
            stream: 1,
            channel: 7,
        },
        end_of_frame: 14,
        encoder: [Pin::new('C', 6), Pin::new('C', 7)],
        encoder_timer: TIM3,
        encoder_function: 2,
        direction: Pin::new('C', 8),
    },
];

/// What messages and the log call the sides.
pub(crate) const SIDE_NAMES: [&str; 2] = ["left", "right"];

/// The alternate function of the SPIs' pins.
pub(super) const SPI_FUNCTION: u32 = 5;

/// Channels 1 to 3 of TIM1: an H-bridge a side on the first two, or three half-bridges.
pub(super) const PWM: [Pin; 3] = [Pin::new('A', 8), Pin::new('A', 9), Pin::new('A', 10)];
/// The alternate function of the PWM's pins.
pub(super) const PWM_FUNCTION: u32 = 1;
/// Enable inputs of three half-bridges.
pub(super) const ENABLES: [Pin; 3] = [Pin::new('C', 10), Pin::new('C', 11), Pin::new('C', 12)];
/// The user button, low while it is pressed.
pub(super) const BUTTON: Pin = Pin::new('C', 13);
/// Hall sensors of a brushless motor.
pub(super) const HALLS: [Pin; 3] = [Pin::new('A', 15), Pin::new('B', 3), Pin::new('B', 10)];
