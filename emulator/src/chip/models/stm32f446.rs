//! The STM32F446RE on its NUCLEO board (RM0390).

use firmware::boards;

use crate::chip::gpio::Reset;
use crate::chip::model::{CoreKind, Model, Unit};
use crate::chip::rcc::{self, Bus};
use crate::chip::timer::Kind;
use crate::chip::wiring::{ByteSignal, LEFT_PINS, Pin, Request, Side, SidePins, Wiring};
use crate::chip::{dma, flash, lines, power, spi, usart};

const TIM2: usize = 0;
const TIM3: usize = 1;
const TIM5: usize = 2;
const TIM6: usize = 3;
const TIM7: usize = 4;
const TIM1: usize = 5;
const TIM8: usize = 6;

pub(crate) static F446: Model = Model {
    program: "nucleo_f446re",
    core: CoreKind::M4F,
    priority_bits: 4,
    flash: 512 * 1024,
    ram: 128 * 1024,
    facts: &boards::NUCLEO_F446RE,
    map: &[
        (Unit::Tim(TIM2), 0x4000_0000, Some((Bus::Apb1, 0))),
        (Unit::Tim(TIM3), 0x4000_0400, Some((Bus::Apb1, 1))),
        (Unit::Tim(TIM5), 0x4000_0C00, Some((Bus::Apb1, 3))),
        (Unit::Tim(TIM6), 0x4000_1000, Some((Bus::Apb1, 4))),
        (Unit::Tim(TIM7), 0x4000_1400, Some((Bus::Apb1, 5))),
        (Unit::Watchdog, 0x4000_3000, None),
        (Unit::Spi(1), 0x4000_3800, Some((Bus::Apb1, 14))),
        (Unit::Usart, 0x4000_4400, Some((Bus::Apb1, 17))),
        (Unit::Can, 0x4000_6400, Some((Bus::Apb1, 25))),
        (Unit::Power, 0x4000_7000, Some((Bus::Apb1, 28))),
        (Unit::Tim(TIM1), 0x4001_0000, Some((Bus::Apb2, 0))),
        (Unit::Tim(TIM8), 0x4001_0400, Some((Bus::Apb2, 1))),
        (Unit::Spi(0), 0x4001_3000, Some((Bus::Apb2, 12))),
        (Unit::Lines, 0x4001_3C00, None),
        (Unit::Gpio(0), 0x4002_0000, Some((Bus::Ahb, 0))),
        (Unit::Gpio(1), 0x4002_0400, Some((Bus::Ahb, 1))),
        (Unit::Gpio(2), 0x4002_0800, Some((Bus::Ahb, 2))),
        (Unit::Rcc, 0x4002_3800, None),
        (Unit::Flash, 0x4002_3C00, None),
        (Unit::Dma(0), 0x4002_6000, Some((Bus::Ahb, 21))),
        (Unit::Dma(1), 0x4002_6400, Some((Bus::Ahb, 22))),
        (Unit::Debug, 0xE004_2000, None),
    ],
    power: &power::F4,
    lines: &lines::V1,
    rcc: &rcc::F4,
    timers: &[
        ("TIM2", Kind::Wide, Bus::Apb1),
        ("TIM3", Kind::General, Bus::Apb1),
        ("TIM5", Kind::Wide, Bus::Apb1),
        ("TIM6", Kind::Basic, Bus::Apb1),
        ("TIM7", Kind::Basic, Bus::Apb1),
        ("TIM1", Kind::Advanced, Bus::Apb2),
        ("TIM8", Kind::Advanced, Bus::Apb2),
    ],
    spi_version: spi::Version::One,
    usart: &usart::ONE,
    spis: &[Bus::Apb2, Bus::Apb1],
    dmas: &[&dma::STREAMS; 2],
    ports: [
        Reset::v2([0xA800_0000, 0x0C00_0000, 0x6400_0000]),
        Reset::v2([0x0000_0280, 0x0000_00C0, 0x0000_0100]),
        Reset::v2([0; 3]),
    ],
    lsi_hz: 32_000,
    has_window: false,
    flash_interface: &flash::F4,
    // RM0390, table 5.
    flash_hz: &[
        (2_700, 30_000_000),
        (2_400, 24_000_000),
        (2_100, 22_000_000),
        (1_800, 20_000_000),
    ],
    debug_registers: &[(0x04, 0), (0x08, 0), (0x0C, 0)],
    wiring: Wiring {
        sides: &[LEFT, RIGHT],
        tick: TIM7,
        tick_irq: 55,
        pwm_timer: TIM1,
        pwm_function: 1,
        spi_function: 5,
        serial_function: 7,
        serial_rx: Request::new(5, 4),
        serial_tx: Request::new(6, 4),
        can_function: Some(9),
    },
};

const LEFT: Side = Side {
    pins: LEFT_PINS,
    byte_timer: TIM8,
    byte_signal: ByteSignal::Update,
    dma: 1,
    rx: Request::new(0, 3),
    tx: Request::new(1, 7),
    end_of_frame: 56,
    encoder_timer: TIM2,
    encoder_function: 1,
};

const RIGHT: Side = Side {
    pins: SidePins {
        spi: [Pin::new('B', 13), Pin::new('B', 14), Pin::new('B', 15)],
        select: Pin::new('B', 12),
        encoder: [Pin::new('C', 6), Pin::new('C', 7)],
        direction: Pin::new('C', 8),
    },
    byte_timer: TIM6,
    byte_signal: ByteSignal::Update,
    dma: 0,
    rx: Request::new(3, 0),
    tx: Request::new(1, 7),
    end_of_frame: 14,
    encoder_timer: TIM3,
    encoder_function: 2,
};
