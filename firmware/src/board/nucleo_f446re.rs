//! The NUCLEO-F446RE: STM32F446RE, Cortex-M4F at 144 MHz.
//!
//! Two whiskers, one a side: [`LEFT`] and [`RIGHT`] say what each hangs on. A brushless motor, of
//! which there can be one, has TIM1's outputs PA8 to PA10, PC10 to PC12, and Halls on PA15, PB3 and
//! PB10. The bus of a head is CAN1 on PA11 and PA12. TIM7 makes the ticks, TIM5 measures them.

use firmware::boards::{self, BoardFacts, Clocks};
use firmware::{Clock, StartCause};
use stm32_metapac::Interrupt;
use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Pllp, Pllsrc, Ppre, Sw};
use stm32_metapac::spi::Spi;
use stm32_metapac::spi::vals::Br;
use stm32_metapac::timer::{TimBasic, TimGp16};
use stm32_metapac::usart::Usart;
use stm32_metapac::{DBGMCU, DMA1, DMA2, FLASH, RCC, SPI1, SPI2, USART2};
use stm32_metapac::{TIM2, TIM3, TIM5, TIM6, TIM7, TIM8};

use crate::board::gpio::PinName;
use crate::board::pin_config::AlternateFunction;
use crate::board::reset::{ClockSource, NoClock, comes, settle, wait};
use crate::board::wiring::{
    BridgePort, EncoderPort, LEFT_BRIDGE, LEFT_ENCODER, LEFT_SENSOR, PWMS, Received, SensorPins,
    SensorPort, Side,
};
use dma::Route;

pub(crate) const FACTS: BoardFacts = boards::NUCLEO_F446RE;
/// Its clocks, before they are halved for slow sensors.
pub(crate) const CLOCKS: Clocks = FACTS.clocks;
#[cfg(not(feature = "fixed"))]
pub(crate) type Number = f32;
#[cfg(feature = "fixed")]
pub(crate) type Number = whisking::Fix;

/// The clock that the ST-LINK puts on the HSE input, Hz.
const HSE_HZ: u32 = 8_000_000;
/// PLL input dividers of HSE and of the chip's 16 MHz: 2 MHz, the most it takes, for least jitter.
const PLL_M: u8 = 4;
const PLL_M_INTERNAL: u8 = 8;
/// PLL multiplier: 288 MHz, inside the oscillator's 100 to 432 MHz.
const PLL_N: u16 = 144;
/// PLL output divider, towards the core.
const PLL_P: u32 = 2;
/// Core clock, Hz. Why not the chip's 180 MHz: `firmware::boards`.
const CORE_HZ: u32 = HSE_HZ / PLL_M as u32 * PLL_N as u32 / PLL_P;
/// Clock of the slow peripheral bus APB1, Hz: a quarter of the core's.
const APB1_HZ: u32 = CORE_HZ / 4;
/// Clock of the fast peripheral bus APB2, Hz: half the core's.
const APB2_HZ: u32 = CORE_HZ / 2;
/// Wait states of the flash: one for each 30 MHz begun after the first, at 2.7 to 3.6 V.
const FLASH_WAIT_STATES: u8 = ((CORE_HZ - 1) / 30_000_000) as u8;

const _: () = assert!(CORE_HZ == 144_000_000 && CORE_HZ <= 168_000_000);
const _: () = assert!(APB1_HZ <= 45_000_000 && APB2_HZ <= 90_000_000);
// The two sides' SPIs and byte timers run alike, from buses that do not.
const _: () = assert!(APB2_HZ / 256 == APB1_HZ / 128 && APB2_HZ == 2 * APB1_HZ);

// Timers count at twice the clock of their bus.
const _: () = assert!(
    CLOCKS.core_hz == CORE_HZ
        && CLOCKS.spi_hz == APB2_HZ / 256
        && CLOCKS.byte_timer_hz == 2 * APB1_HZ
        && CLOCKS.tick_timer_hz == 2 * APB1_HZ
        && CLOCKS.counter_hz == 2 * APB1_HZ
        && CLOCKS.pwm_hz == 2 * APB2_HZ
        && CLOCKS.serial_hz == APB1_HZ
);

#[path = "byte_update.rs"]
pub(crate) mod byte_request;
#[path = "dma_streams.rs"]
pub(crate) mod dma;
#[path = "flash_f4.rs"]
pub(crate) mod flash;
#[path = "gpio_v2.rs"]
pub(crate) mod gpio;
#[path = "power_f4.rs"]
pub(crate) mod power;
#[path = "spi_v1.rs"]
pub(crate) mod spi;
#[path = "usart_v1.rs"]
pub(crate) mod usart;

pub(crate) const TICK_TIMER: TimBasic = TIM7;
pub(crate) const TICK_INTERRUPT: Interrupt = Interrupt::TIM7;
/// Alternate function of the PWM's pins, TIM1.
pub(crate) const PWM_FUNCTION: AlternateFunction = 1;

/// The ST-LINK's serial port: USART2 by DMA1.
pub(crate) const SERIAL_USART: Usart = USART2;
pub(crate) const SERIAL_ROUTE: Route = Route {
    dma: DMA1,
    rx: (5, 4),
    tx: (6, 4),
};
pub(crate) const SERIAL_FUNCTION: AlternateFunction = 7;

/// The left whisker: SPI1 by TIM8 and DMA2, PWM 1, TIM2.
pub(crate) static LEFT: Side = Side {
    sensor: SensorPort {
        spi: SPI1,
        divider: Br::DIV256,
        #[allow(unsafe_code, reason = "an advanced timer begins with a basic one's registers")]
        // SAFETY: the registers of both have the same offsets and bits (RM0390,
        // chapters 17 and 20).
        byte_timer: unsafe { TimBasic::from_ptr(TIM8.as_ptr()) },
        byte_timer_divider: 2,
        // SPI1_RX, TIM8_UP.
        dma: Route {
            dma: DMA2,
            rx: (0, 3),
            tx: (1, 7),
        },
        received: {
            static RECEIVED: Received = Received::new();
            &RECEIVED
        },
        pins: LEFT_SENSOR,
        function: 5,
    },
    bridge: LEFT_BRIDGE,
    encoder: EncoderPort {
        #[allow(unsafe_code, reason = "a timer of 32 bits has the registers of one of 16")]
        // SAFETY: the registers of both have the same offsets, and the lower halves of
        // count, reload and compare values the same bits (RM0390, chapter 18).
        timer: unsafe { TimGp16::from_ptr(TIM2.as_ptr()) },
        a: LEFT_ENCODER[0],
        b: LEFT_ENCODER[1],
        function: 1,
    },
};

/// The right whisker: SPI2 by TIM6 and DMA1, PWM 2, TIM3.
pub(crate) static RIGHT: Side = Side {
    sensor: SensorPort {
        spi: SPI2,
        divider: Br::DIV128,
        byte_timer: TIM6,
        byte_timer_divider: 1,
        // SPI2_RX, TIM6_UP.
        dma: Route {
            dma: DMA1,
            rx: (3, 0),
            tx: (1, 7),
        },
        received: {
            static RECEIVED: Received = Received::new();
            &RECEIVED
        },
        pins: SensorPins {
            sck: PinName::new('B', 13),
            miso: PinName::new('B', 14),
            mosi: PinName::new('B', 15),
            select: PinName::new('B', 12),
        },
        function: 5,
    },
    bridge: BridgePort {
        output: 1,
        pwm: PWMS[1],
        direction: PinName::new('C', 8),
    },
    encoder: EncoderPort {
        timer: TIM3,
        a: PinName::new('C', 6),
        b: PinName::new('C', 7),
        function: 2,
    },
};

/// TIM5, counting through 32 bits.
pub(crate) struct Counter(());

impl Counter {
    pub(crate) fn start(_: cortex_m::Peripherals) -> Self {
        TIM5.arr().write_value(u32::MAX);
        TIM5.cr1().write(|w| w.set_cen(true));
        Self(())
    }

    /// The same, which [counts](Self::start), for another reader.
    pub(crate) const fn running() -> Self {
        Self(())
    }
}

impl Clock for Counter {
    #[inline]
    fn now(&mut self) -> u32 {
        TIM5.cnt().read()
    }
}

/// Reads why the chip started and forgets it, so that the next start tells its own.
pub(crate) fn reset_cause() -> StartCause {
    let flags = RCC.csr().read();
    RCC.csr().modify(|w| w.set_rmvf(true));
    StartCause::first([
        (flags.wdgrstf(), StartCause::Watchdog),
        (flags.sftrstf(), StartCause::Software),
        // A brown-out reset sets its own flag alone, a power-up both (RM0390, chapter 6.3.21).
        (flags.porrstf(), StartCause::Power),
        (flags.borrstf(), StartCause::BrownOut),
        (flags.padrstf(), StartCause::Pin),
    ])
}

/// By the ST-LINK's clock where that comes, with the non-maskable interrupt should it stop.
/// Lets the timers of the tick run.
pub(crate) fn start_clocks() -> Result<ClockSource, NoClock> {
    RCC.cr().modify(|w| w.set_hsebyp(true));
    RCC.cr().modify(|w| w.set_hseon(true));
    let is_fed = comes(|| RCC.cr().read().hserdy());
    let (source, divider) = if is_fed {
        (Pllsrc::HSE, PLL_M)
    } else {
        RCC.cr().modify(|w| w.set_hseon(false));
        (Pllsrc::HSI, PLL_M_INTERNAL)
    };

    const { assert!(PLL_P == 2) };
    RCC.pllcfgr().modify(|w| {
        w.set_pllsrc(source);
        w.set_pllm(divider.into());
        w.set_plln(PLL_N.into());
        w.set_pllp(Pllp::DIV2);
    });
    RCC.cr().modify(|w| w.set_pllon(true));
    wait(|| RCC.cr().read().pllrdy())?;

    // Wait states before the clock that needs them.
    let wait_states = Latency::from_bits(FLASH_WAIT_STATES);
    FLASH.acr().modify(|w| {
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
        w.set_latency(wait_states);
    });
    wait(|| FLASH.acr().read().latency() == wait_states)?;
    const { assert!(APB1_HZ * 4 == CORE_HZ && APB2_HZ * 2 == CORE_HZ) };
    RCC.cfgr().modify(|w| {
        w.set_ppre1(Ppre::DIV4);
        w.set_ppre2(Ppre::DIV2);
        w.set_sw(Sw::PLL1_P);
    });
    wait(|| RCC.cfgr().read().sws() == Sw::PLL1_P)?;
    RCC.cr().modify(|w| w.set_csson(is_fed));

    RCC.apb1enr().modify(|w| {
        w.set_tim5en(true);
        w.set_tim7en(true);
    });
    settle();
    Ok(ClockSource::of(is_fed))
}

/// CSSF in RCC_CIR (RM0390, chapter 6.3.4).
pub(crate) fn has_clock_stopped() -> bool {
    RCC.cir().read().cssf()
}

pub(crate) fn clock_ports() {
    RCC.ahb1enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
    });
    settle();
}

#[cfg(feature = "both-sides")]
pub(crate) static SIDES: &[&Side] = &[&LEFT, &RIGHT];
#[cfg(not(feature = "both-sides"))]
pub(crate) static SIDES: &[&Side] = &[&LEFT];

/// Whether so many sides are both, which an image may be built without.
const fn are_both(sides: u8) -> bool {
    cfg!(feature = "both-sides") && sides > 1
}

pub(crate) fn clock_sensors(sides: u8) {
    RCC.ahb1enr().modify(|w| w.set_dma2en(true));
    RCC.apb2enr().modify(|w| {
        w.set_tim8en(true);
        w.set_spi1en(true);
    });
    if are_both(sides) {
        RCC.ahb1enr().modify(|w| w.set_dma1en(true));
        RCC.apb1enr().modify(|w| {
            w.set_tim6en(true);
            w.set_spi2en(true);
        });
    }
    settle();
}

/// The controller of a head's bus, and the alternate function of its pins.
#[cfg(feature = "bus")]
pub(crate) const BUS: stm32_metapac::can::Can = stm32_metapac::CAN1;
#[cfg(feature = "bus")]
pub(crate) const BUS_FUNCTION: AlternateFunction = 9;

#[cfg(feature = "bus")]
pub(crate) fn clock_bus() {
    RCC.apb1enr().modify(|w| w.set_can1en(true));
    settle();
}

pub(crate) fn clock_serial() {
    RCC.ahb1enr().modify(|w| w.set_dma1en(true));
    RCC.apb1enr().modify(|w| w.set_usart2en(true));
    settle();
}

pub(crate) fn reset_spi(spi: Spi) {
    if cfg!(feature = "both-sides") && spi == SPI2 {
        RCC.apb1rstr().modify(|w| w.set_spi2rst(true));
        RCC.apb1rstr().modify(|w| w.set_spi2rst(false));
    } else {
        RCC.apb2rstr().modify(|w| w.set_spi1rst(true));
        RCC.apb2rstr().modify(|w| w.set_spi1rst(false));
    }
}

pub(crate) fn clock_motors(sides: u8) {
    RCC.apb1enr().modify(|w| {
        w.set_tim2en(true);
        w.set_tim3en(are_both(sides));
    });
    RCC.apb2enr().modify(|w| w.set_tim1en(true));
    settle();
}

/// Setting a pin's mode takes it from the debugger on this chip.
pub(crate) fn free_hall_pins() {}

/// Keeps the log readable in sleep; a debugger that halts the core stops TIM1, whose outputs go
/// low then, and the watchdog.
pub(crate) fn prepare_for_debuggers() {
    DBGMCU.cr().modify(|w| w.set_dbg_sleep(true));
    DBGMCU.apb2fzr().modify(|w| w.set_tim1(true));
    DBGMCU.apb1fzr().modify(|w| w.set_iwdg(true));
}
