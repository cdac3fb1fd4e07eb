//! Which pin does what. A side's pins and the peripherals behind them are a table in the
//! board's own file; the left side has the same pins on every board.

use core::sync::atomic::AtomicU32;

use mlx90333::FRAME_LEN;
use stm32_metapac::spi::Spi;
use stm32_metapac::spi::vals::Br;
use stm32_metapac::timer::{TimBasic, TimGp16};

use super::gpio::PinName;
use super::pin_config::AlternateFunction;
use crate::here::dma::Route;

pub(crate) struct Side {
    pub(crate) sensor: SensorPort,
    /// Its motor, if that has brushes.
    pub(crate) bridge: BridgePort,
    pub(crate) encoder: EncoderPort,
}

pub(crate) struct SensorPort {
    pub(crate) spi: Spi,
    pub(crate) divider: Br,
    pub(crate) byte_timer: TimBasic,
    /// From its clock to that of [`CLOCKS`](crate::here::CLOCKS).
    pub(crate) byte_timer_divider: u16,
    pub(crate) dma: Route,
    pub(crate) received: &'static Received,
    pub(crate) pins: SensorPins,
    /// Alternate function of the three that are the SPI's.
    pub(crate) function: AlternateFunction,
}

/// As words; atomic, because the compiler does not see the DMA's writes.
pub(crate) struct Received(pub(crate) [AtomicU32; FRAME_LEN / 4]);

impl Received {
    pub(crate) const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; FRAME_LEN / 4])
    }
}

pub(crate) struct SensorPins {
    pub(crate) sck: PinName,
    /// Data from the sensor; joined to `mosi` outside, one open-drain line.
    pub(crate) miso: PinName,
    pub(crate) mosi: PinName,
    /// /SS.
    pub(crate) select: PinName,
}

pub(crate) struct BridgePort {
    /// Of the PWM's timer, counted from 0.
    pub(crate) output: usize,
    pub(crate) pwm: PinName,
    pub(crate) direction: PinName,
}

pub(crate) struct EncoderPort {
    /// A timer of at least 16 bits.
    pub(crate) timer: TimGp16,
    pub(crate) a: PinName,
    pub(crate) b: PinName,
    pub(crate) function: AlternateFunction,
}

const fn pin(port: char, number: u8) -> PinName {
    PinName::new(port, number)
}

pub(crate) const LEFT_SENSOR: SensorPins = SensorPins {
    sck: pin('A', 5),
    miso: pin('A', 6),
    mosi: pin('A', 7),
    select: pin('B', 6),
};

pub(crate) const LEFT_ENCODER: [PinName; 2] = [pin('A', 0), pin('A', 1)];

pub(crate) const LEFT_BRIDGE: BridgePort = BridgePort {
    output: 0,
    pwm: PWMS[0],
    direction: pin('B', 5),
};

/// The outputs of the PWM's timer: three half-bridges, or an H-bridge each.
pub(crate) const PWMS: [PinName; 3] = [pin('A', 8), pin('A', 9), pin('A', 10)];
/// Enable inputs of the three half-bridges.
pub(crate) const ENABLES: [PinName; 3] = [pin('C', 10), pin('C', 11), pin('C', 12)];
/// The user button B1, low while it is pressed, with a pull-up on the board (UM1724, UM2324).
pub(crate) const USER_BUTTON: PinName = pin('C', 13);
/// The ST-LINK's serial port: what the board sends, and what it receives (UM1724, UM2324).
pub(crate) const SERIAL: [PinName; 2] = [pin('A', 2), pin('A', 3)];
/// Contact, and that a decision fell: D15 and D14 of every board (UM1724, UM2324).
pub(crate) const SIGNALS: [PinName; 2] = [pin('B', 8), pin('B', 9)];
pub(crate) const HALLS: [PinName; 3] = [pin('A', 15), pin('B', 3), pin('B', 10)];
