//! The NUCLEO-F103RB: STM32F103RB, Cortex-M3 at 72 MHz, no FPU.
//!
//! One whisker: [`LEFT`] says what it hangs on. A brushless motor has TIM1's outputs PA8 to
//! PA10, PC10 to PC12, and Halls on PA15, PB3 and PB10. The bus of a head is CAN on PA11 and PA12.
//! TIM3 makes the ticks, SysTick measures them.

use firmware::StartCause;
use firmware::boards::{self, BoardFacts, Clocks};
use stm32_metapac::Interrupt;
use stm32_metapac::afio::vals::SwjCfg;
use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Pllmul, Pllsrc, Ppre, Sw};
use stm32_metapac::spi::Spi;
use stm32_metapac::spi::vals::Br;
use stm32_metapac::timer::{TimBasic, TimGp16};
use stm32_metapac::usart::Usart;
use stm32_metapac::{AFIO, DBGMCU, FLASH, RCC, SPI1, TIM2, TIM3, TIM4, USART2};

use crate::board::pin_config::AlternateFunction;
use crate::board::reset::{ClockSource, NoClock, comes, wait};
pub(crate) use crate::board::systick::SysTick as Counter;
use crate::board::wiring::{
    EncoderPort, LEFT_BRIDGE, LEFT_ENCODER, LEFT_SENSOR, Received, SensorPort, Side,
};
use dma::Route;

pub(crate) const FACTS: BoardFacts = boards::NUCLEO_F103RB;
/// Its clocks, before they are halved for slow sensors.
pub(crate) const CLOCKS: Clocks = FACTS.clocks;
pub(crate) type Number = whisking::Fix;

/// The clock that the ST-LINK puts on the HSE input, Hz.
const HSE_HZ: u32 = 8_000_000;
const PLL_MUL: u8 = 9;
/// Core clock, Hz: the chip's highest. The fast bus APB2 has it too.
const CORE_HZ: u32 = HSE_HZ * PLL_MUL as u32;
/// Clock of the slow peripheral bus APB1, Hz: half the core's, its highest.
const APB1_HZ: u32 = CORE_HZ / 2;
/// Wait states of the flash: one for each 24 MHz begun after the first.
const FLASH_WAIT_STATES: u8 = ((CORE_HZ - 1) / 24_000_000) as u8;

const _: () = assert!(CORE_HZ == 72_000_000 && APB1_HZ <= 36_000_000);

// On APB1 timers count at twice the clock of their bus; APB2 is not divided.
const _: () = assert!(
    CLOCKS.core_hz == CORE_HZ
        && CLOCKS.spi_hz == CORE_HZ / 256
        && CLOCKS.byte_timer_hz == 2 * APB1_HZ
        && CLOCKS.tick_timer_hz == 2 * APB1_HZ
        && CLOCKS.counter_hz == CORE_HZ
        && CLOCKS.pwm_hz == CORE_HZ
        && CLOCKS.serial_hz == APB1_HZ
);

#[path = "byte_compare.rs"]
pub(crate) mod byte_request;
#[path = "dma_channels.rs"]
pub(crate) mod dma;
#[path = "flash_f1.rs"]
pub(crate) mod flash;
#[path = "gpio_v1.rs"]
pub(crate) mod gpio;
#[path = "power_f1.rs"]
pub(crate) mod power;
#[path = "spi_v1.rs"]
pub(crate) mod spi;
#[path = "usart_v1.rs"]
pub(crate) mod usart;

pub(crate) const TICK_TIMER: TimGp16 = TIM3;
pub(crate) const TICK_INTERRUPT: Interrupt = Interrupt::TIM3;

/// Each pin has one alternate function without remapping.
const ONLY: AlternateFunction = 0;
/// Alternate function of the PWM's pins, TIM1.
pub(crate) const PWM_FUNCTION: AlternateFunction = ONLY;

/// The ST-LINK's serial port: USART2 by DMA1.
pub(crate) const SERIAL_USART: Usart = USART2;
/// Channels 6 and 7: USART2_RX, USART2_TX (RM0008, table 78).
pub(crate) const SERIAL_ROUTE: Route = Route { rx: 5, tx: 6 };
pub(crate) const SERIAL_FUNCTION: AlternateFunction = ONLY;

/// The whisker: SPI1 by TIM4 and DMA1, PWM 1, TIM2.
pub(crate) static LEFT: Side = Side {
    sensor: SensorPort {
        spi: SPI1,
        divider: Br::DIV256,
        #[allow(unsafe_code, reason = "a general timer begins with a basic one's registers")]
        // SAFETY: the registers of both have the same offsets and bits (RM0008,
        // chapters 15 and 17).
        byte_timer: unsafe { TimBasic::from_ptr(TIM4.as_ptr()) },
        byte_timer_divider: 1,
        // Channels 2 and 1: SPI1_RX, TIM4_CH1 (RM0008, table 78).
        dma: Route { rx: 1, tx: 0 },
        received: {
            static RECEIVED: Received = Received::new();
            &RECEIVED
        },
        pins: LEFT_SENSOR,
        function: ONLY,
    },
    bridge: LEFT_BRIDGE,
    encoder: EncoderPort {
        timer: TIM2,
        a: LEFT_ENCODER[0],
        b: LEFT_ENCODER[1],
        function: ONLY,
    },
};

pub(crate) static SIDES: &[&Side] = &[&LEFT];

/// Reads why the chip started and forgets it, so that the next start tells its own.
pub(crate) fn reset_cause() -> StartCause {
    let flags = RCC.csr().read();
    RCC.csr().modify(|w| w.set_rmvf(true));
    StartCause::first([
        (flags.iwdgrstf(), StartCause::Watchdog),
        (flags.sftrstf(), StartCause::Software),
        (flags.porrstf(), StartCause::Power),
        (flags.pinrstf(), StartCause::Pin),
    ])
}

/// By the ST-LINK's clock where that comes, with the non-maskable interrupt should it stop;
/// otherwise at 64 MHz, the most that the PLL makes of the internal 8 MHz. Lets the timer of
/// the tick run.
pub(crate) fn start_clocks() -> Result<ClockSource, NoClock> {
    RCC.cr().modify(|w| w.set_hsebyp(true));
    RCC.cr().modify(|w| w.set_hseon(true));
    let is_fed = comes(|| RCC.cr().read().hserdy());
    let (source, factor) = if is_fed {
        (Pllsrc::HSE_DIV_PREDIV, Pllmul::MUL9)
    } else {
        RCC.cr().modify(|w| w.set_hseon(false));
        (Pllsrc::HSI_DIV2, Pllmul::MUL16)
    };

    // Wait states before the clock that needs them.
    FLASH.acr().modify(|w| {
        w.set_prftbe(true);
        w.set_latency(Latency::from_bits(FLASH_WAIT_STATES));
    });
    const { assert!(PLL_MUL == 9 && APB1_HZ * 2 == CORE_HZ) };
    RCC.cfgr().modify(|w| {
        w.set_pllsrc(source);
        w.set_pllmul(factor);
        w.set_ppre1(Ppre::DIV2);
    });
    RCC.cr().modify(|w| w.set_pllon(true));
    wait(|| RCC.cr().read().pllrdy())?;
    RCC.cfgr().modify(|w| w.set_sw(Sw::PLL1_P));
    wait(|| RCC.cfgr().read().sws() == Sw::PLL1_P)?;
    RCC.cr().modify(|w| w.set_csson(is_fed));

    RCC.apb1enr().modify(|w| w.set_tim3en(true));
    Ok(ClockSource::of(is_fed))
}

/// CSSF in RCC_CIR (RM0008, chapter 7.3.3).
pub(crate) fn has_clock_stopped() -> bool {
    RCC.cir().read().cssf()
}

pub(crate) fn clock_ports() {
    RCC.apb2enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
        w.set_afioen(true);
    });
}

pub(crate) fn clock_sensors(_: u8) {
    RCC.ahbenr().modify(|w| w.set_dma1en(true));
    RCC.apb1enr().modify(|w| w.set_tim4en(true));
    RCC.apb2enr().modify(|w| w.set_spi1en(true));
}

/// The controller of a head's bus, and the alternate function of its pins.
#[cfg(feature = "bus")]
pub(crate) const BUS: stm32_metapac::can::Can = stm32_metapac::CAN;
#[cfg(feature = "bus")]
pub(crate) const BUS_FUNCTION: AlternateFunction = ONLY;

#[cfg(feature = "bus")]
pub(crate) fn clock_bus() {
    RCC.apb1enr().modify(|w| w.set_canen(true));
}

pub(crate) fn clock_serial() {
    RCC.ahbenr().modify(|w| w.set_dma1en(true));
    RCC.apb1enr().modify(|w| w.set_usart2en(true));
}

pub(crate) fn reset_spi(_: Spi) {
    RCC.apb2rstr().modify(|w| w.set_spi1rst(true));
    RCC.apb2rstr().modify(|w| w.set_spi1rst(false));
}

pub(crate) fn clock_motors(_: u8) {
    RCC.apb1enr().modify(|w| w.set_tim2en(true));
    RCC.apb2enr().modify(|w| w.set_tim1en(true));
}

/// PA15 and PB3 are JTAG's after a reset; the ST-LINK needs the two other wires only.
pub(crate) fn free_hall_pins() {
    AFIO.mapr().modify(|w| w.set_swj_cfg(SwjCfg::JTAG_DISABLE));
}

/// Keeps the log readable in sleep; a debugger that halts the core stops TIM1, whose outputs go
/// low then, and the watchdog.
pub(crate) fn prepare_for_debuggers() {
    DBGMCU.cr().modify(|w| {
        w.set_dbg_sleep(true);
        w.set_tim1(true);
        w.set_iwdg(true);
    });
}
