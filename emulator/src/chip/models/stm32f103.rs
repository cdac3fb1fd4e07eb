//! The STM32F103RB on its NUCLEO board (RM0008).

use firmware::boards;

use crate::chip::gpio::Reset;
use crate::chip::model::{CoreKind, Model, Unit};
use crate::chip::rcc::{self, Bus};
use crate::chip::timer::Kind;
use crate::chip::wiring::{ByteSignal, LEFT_PINS, Request, Side, Wiring};
use crate::chip::{dma, flash, lines, power, spi, usart};

const TIM2: usize = 0;
const TIM3: usize = 1;
const TIM4: usize = 2;
const TIM1: usize = 3;

/// Requests are wired to the channels.
const WIRED: u32 = 0;

pub(crate) static F103: Model = Model {
    program: "nucleo_f103rb",
    core: CoreKind::M3,
    priority_bits: 4,
    flash: 128 * 1024,
    ram: 20 * 1024,
    facts: &boards::NUCLEO_F103RB,
    map: &[
        (Unit::Tim(TIM2), 0x4000_0000, Some((Bus::Apb1, 0))),
        (Unit::Tim(TIM3), 0x4000_0400, Some((Bus::Apb1, 1))),
        (Unit::Tim(TIM4), 0x4000_0800, Some((Bus::Apb1, 2))),
        (Unit::Watchdog, 0x4000_3000, None),
        (Unit::Usart, 0x4000_4400, Some((Bus::Apb1, 17))),
        (Unit::Can, 0x4000_6400, Some((Bus::Apb1, 25))),
        (Unit::Power, 0x4000_7000, Some((Bus::Apb1, 28))),
        (Unit::Remap, 0x4001_0000, Some((Bus::Apb2, 0))),
        (Unit::Lines, 0x4001_0400, None),
        (Unit::Gpio(0), 0x4001_0800, Some((Bus::Apb2, 2))),
        (Unit::Gpio(1), 0x4001_0C00, Some((Bus::Apb2, 3))),
        (Unit::Gpio(2), 0x4001_1000, Some((Bus::Apb2, 4))),
        (Unit::Tim(TIM1), 0x4001_2C00, Some((Bus::Apb2, 11))),
        (Unit::Spi(0), 0x4001_3000, Some((Bus::Apb2, 12))),
        (Unit::Dma(0), 0x4002_0000, Some((Bus::Ahb, 0))),
        (Unit::Rcc, 0x4002_1000, None),
        (Unit::Flash, 0x4002_2000, None),
        (Unit::Debug, 0xE004_2000, None),
    ],
    power: &power::F1,
    lines: &lines::V1,
    rcc: &rcc::F1,
    timers: &[
        ("TIM2", Kind::General, Bus::Apb1),
        ("TIM3", Kind::General, Bus::Apb1),
        ("TIM4", Kind::General, Bus::Apb1),
        ("TIM1", Kind::Advanced, Bus::Apb2),
    ],
    spi_version: spi::Version::One,
    usart: &usart::ONE,
    spis: &[Bus::Apb2],
    dmas: &[&dma::CHANNELS],
    ports: [Reset::V1; 3],
    lsi_hz: 40_000,
    has_window: false,
    flash_interface: &flash::F1,
    // RM0008, chapter 3.3.3.
    flash_hz: &[(2_000, 24_000_000)],
    debug_registers: &[(0x04, 0)],
    wiring: Wiring {
        sides: &[LEFT],
        tick: TIM3,
        tick_irq: 29,
        pwm_timer: TIM1,
        pwm_function: 0,
        spi_function: 0,
        serial_function: 0,
        serial_rx: Request::new(5, WIRED),
        serial_tx: Request::new(6, WIRED),
        can_function: Some(0),
    },
};

const LEFT: Side = Side {
    pins: LEFT_PINS,
    byte_timer: TIM4,
    byte_signal: ByteSignal::Compare,
    dma: 0,
    rx: Request::new(1, WIRED),
    tx: Request::new(0, WIRED),
    end_of_frame: 12,
    encoder_timer: TIM2,
    encoder_function: 0,
};
