//! The board's wires: the pins, and the timers, DMA streams and interrupts behind them.
//!
//! The numbers, in the chips' files, are those of the reference manuals and the data
//! sheets. Each is held against another source, the description that stm32-metapac makes
//! from ST's configuration tool: `cargo xtask descriptions`.

use super::rcc::Bus;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pin {
    pub(super) port: usize,
    pub(super) number: u32,
}

impl Pin {
    pub(super) const fn new(port: char, number: u32) -> Self {
        let port = port as usize - 'A' as usize;
        Self { port, number }
    }
}

/// What a stream or channel of a DMA controller listens to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Request {
    /// The stream, or the channel of a controller without streams; counted from 0.
    pub(super) stream: usize,
    /// The channel of the stream, or the number of DMAMUX; nothing where it is wired.
    pub(super) channel: u32,
}

impl Request {
    pub(super) const fn new(stream: usize, channel: u32) -> Self {
        Self { stream, channel }
    }
}

#[derive(Debug)]
pub(super) struct SidePins {
    /// SCK, MISO and MOSI of the sensor's SPI (SPI1 on the left, SPI2 on the right).
    pub(super) spi: [Pin; 3],
    pub(super) select: Pin,
    pub(super) encoder: [Pin; 2],
    pub(super) direction: Pin,
}

#[derive(Debug)]
pub(super) struct Side {
    pub(super) pins: SidePins,
    /// The timer that asks for the next byte of a frame, and by what.
    pub(super) byte_timer: usize,
    pub(super) byte_signal: ByteSignal,
    /// The DMA controller that moves the bytes, DMA1 first.
    pub(super) dma: usize,
    /// Reception by the SPI.
    pub(super) rx: Request,
    /// The byte timer's signal.
    pub(super) tx: Request,
    /// The interrupt of the rx stream in the NVIC.
    pub(super) end_of_frame: u16,
    pub(super) encoder_timer: usize,
    pub(super) encoder_function: u32,
}

/// What of a timer asks for a byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteSignal {
    Update,
    /// A match of its channel 1.
    Compare,
}

impl ByteSignal {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Update => "UP",
            Self::Compare => "CH1",
        }
    }
}

#[derive(Debug)]
pub(super) struct Wiring {
    pub(super) sides: &'static [Side],
    /// The timer that makes the ticks, and its interrupt in the NVIC.
    pub(super) tick: usize,
    pub(super) tick_irq: u16,
    /// The timer of the motors' PWM, TIM1.
    pub(super) pwm_timer: usize,
    /// The alternate functions of the pins of PWM and SPIs.
    pub(super) pwm_function: u32,
    pub(super) spi_function: u32,
    /// Of the serial port that the ST-LINK is on: USART2, whose bytes DMA1 moves.
    pub(super) serial_function: u32,
    pub(super) serial_rx: Request,
    pub(super) serial_tx: Request,
    /// Of the pins of a head's bus, where the chip has one.
    pub(super) can_function: Option<u32>,
}

pub(crate) const SIDE_NAMES: [&str; 2] = ["left", "right"];

/// Channels 1 to 3 of TIM1 on every board: an H-bridge a side on the first two, or three
/// half-bridges.
pub(super) const PWM: [Pin; 3] = [Pin::new('A', 8), Pin::new('A', 9), Pin::new('A', 10)];
pub(super) const ENABLES: [Pin; 3] = [Pin::new('C', 10), Pin::new('C', 11), Pin::new('C', 12)];
/// The user button, low while it is pressed.
pub(super) const BUTTON: Pin = Pin::new('C', 13);
/// The bus of USART2 and of the CAN, and the DMA that moves the bytes of the first.
pub(super) const PORTS_BUS: Bus = Bus::Apb1;
pub(super) const SERIAL_DMA: usize = 0;
/// What USART2 sends and receives, CAN RX and TX, and the pins of contact and of decisions.
pub(super) const SERIAL: [Pin; 2] = [Pin::new('A', 2), Pin::new('A', 3)];
pub(super) const CAN: [Pin; 2] = [Pin::new('A', 11), Pin::new('A', 12)];
/// The interrupts of its first FIFO, and of its mailboxes.
pub(super) const CAN_IRQS: [u16; 2] = [20, 19];
pub(super) const SIGNALS: [Pin; 2] = [Pin::new('B', 8), Pin::new('B', 9)];
pub(super) const HALLS: [Pin; 3] = [Pin::new('A', 15), Pin::new('B', 3), Pin::new('B', 10)];

/// The bits of a board's number in a head, the lowest first: low where a jumper is.
pub(super) const NUMBER: [Pin; 5] = [
    Pin::new('C', 0),
    Pin::new('C', 1),
    Pin::new('C', 2),
    Pin::new('C', 3),
    Pin::new('C', 4),
];

/// Those of the left side, which every board has.
pub(super) const LEFT_PINS: SidePins = SidePins {
    spi: [Pin::new('A', 5), Pin::new('A', 6), Pin::new('A', 7)],
    select: Pin::new('B', 6),
    encoder: [Pin::new('A', 0), Pin::new('A', 1)],
    direction: Pin::new('B', 5),
};
