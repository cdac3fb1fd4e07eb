//! The STM32G071RB on its NUCLEO board (RM0444).

use firmware::boards;

use crate::chip::gpio::Reset;
use crate::chip::model::{CoreKind, Model, Unit};
use crate::chip::rcc::{self, Bus};
use crate::chip::timer::Kind;
use crate::chip::wiring::{ByteSignal, LEFT_PINS, Request, Side, Wiring};
use crate::chip::{dma, flash, lines, power, spi, usart};

const TIM2: usize = 0;
const TIM3: usize = 1;
const TIM6: usize = 2;
const TIM1: usize = 3;

pub(crate) static G071: Model = Model {
    program: "nucleo_g071rb",
    core: CoreKind::M0Plus,
    priority_bits: 2,
    flash: 128 * 1024,
    ram: 36 * 1024,
    facts: &boards::NUCLEO_G071RB,
    map: &[
        (Unit::Tim(TIM2), 0x4000_0000, Some((Bus::Apb1, 0))),
        (Unit::Tim(TIM3), 0x4000_0400, Some((Bus::Apb1, 1))),
        (Unit::Tim(TIM6), 0x4000_1000, Some((Bus::Apb1, 4))),
        (Unit::Watchdog, 0x4000_3000, None),
        (Unit::Usart, 0x4000_4400, Some((Bus::Apb1, 17))),
        (Unit::Power, 0x4000_7000, Some((Bus::Apb1, 28))),
        (Unit::System, 0x4001_0000, Some((Bus::Apb2, 0))),
        (Unit::Tim(TIM1), 0x4001_2C00, Some((Bus::Apb2, 11))),
        (Unit::Spi(0), 0x4001_3000, Some((Bus::Apb2, 12))),
        (Unit::Debug, 0x4001_5800, Some((Bus::Apb1, 27))),
        (Unit::Dma(0), 0x4002_0000, Some((Bus::Ahb, 0))),
        (Unit::Requests, 0x4002_0800, Some((Bus::Ahb, 0))),
        (Unit::Rcc, 0x4002_1000, None),
        (Unit::Lines, 0x4002_1800, None),
        (Unit::Flash, 0x4002_2000, None),
        (Unit::Gpio(0), 0x5000_0000, Some((Bus::Ports, 0))),
        (Unit::Gpio(1), 0x5000_0400, Some((Bus::Ports, 1))),
        (Unit::Gpio(2), 0x5000_0800, Some((Bus::Ports, 2))),
    ],
    power: &power::G0,
    lines: &lines::G0,
    rcc: &rcc::G0,
    timers: &[
        ("TIM2", Kind::Wide, Bus::Apb1),
        ("TIM3", Kind::General, Bus::Apb1),
        ("TIM6", Kind::Basic, Bus::Apb1),
        ("TIM1", Kind::Advanced, Bus::Apb2),
    ],
    spi_version: spi::Version::Queues,
    usart: &usart::TWO,
    spis: &[Bus::Apb2],
    dmas: &[&dma::CHANNELS],
    ports: [
        Reset::v2([0xEBFF_FFFF, 0x0C00_0000, 0x2400_0000]),
        Reset::v2([0xFFFF_FFFF, 0, 0]),
        Reset::v2([0xFFFF_FFFF, 0, 0]),
    ],
    lsi_hz: 32_000,
    has_window: true,
    flash_interface: &flash::G0,
    // RM0444, table of the wait states in range 1.
    flash_hz: &[(1_700, 24_000_000)],
    debug_registers: &[(0x04, 0), (0x08, 0), (0x0C, 0)],
    wiring: Wiring {
        sides: &[LEFT],
        tick: TIM3,
        tick_irq: 16,
        pwm_timer: TIM1,
        pwm_function: 2,
        spi_function: 0,
        serial_function: 1,
        serial_rx: Request::new(2, 52),
        serial_tx: Request::new(3, 53),
        can_function: None,
    },
};

const LEFT: Side = Side {
    pins: LEFT_PINS,
    byte_timer: TIM6,
    byte_signal: ByteSignal::Update,
    dma: 0,
    // SPI1_RX and TIM6_UP in DMAMUX.
    rx: Request::new(0, 16),
    tx: Request::new(1, 38),
    end_of_frame: 9,
    encoder_timer: TIM2,
    encoder_function: 2,
};
