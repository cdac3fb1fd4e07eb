//! The NUCLEO-G071RB: STM32G071RB, Cortex-M0+ at 64 MHz, no FPU.
//!
//! One whisker: [`LEFT`] says what it hangs on. A brushless motor has TIM1's outputs PA8 to PA10,
//! PC10 to PC12, and Halls on PA15, PB3 and PB10. TIM3 makes the ticks, SysTick measures them.

use firmware::StartCause;
use firmware::boards::{self, BoardFacts, Clocks};
use stm32_metapac::Interrupt;
use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Pllm, Plln, Pllr, Pllsrc, Sw};
use stm32_metapac::spi::Spi;
use stm32_metapac::spi::vals::Br;
use stm32_metapac::timer::TimGp16;
use stm32_metapac::usart::Usart;
use stm32_metapac::{DBGMCU, DMAMUX1, FLASH, RCC, SPI1, SYSCFG, TIM2, TIM3, TIM6, USART2};

use crate::board::pin_config::AlternateFunction;
use crate::board::reset::{ClockSource, NoClock, settle, wait};
pub(crate) use crate::board::systick::SysTick as Counter;
use crate::board::wiring::{
    EncoderPort, LEFT_BRIDGE, LEFT_ENCODER, LEFT_SENSOR, Received, SensorPort, Side,
};
use dma::Route;

pub(crate) const FACTS: BoardFacts = boards::NUCLEO_G071RB;
/// Its clocks, before they are halved for slow sensors.
pub(crate) const CLOCKS: Clocks = FACTS.clocks;
pub(crate) type Number = whisking::Fix;

/// The chip's own oscillator, Hz, within 1 % from 0 to 85 °C (data sheet). The
/// board comes without a clock on the HSE input; so the tick is as exact as this.
const HSI_HZ: u32 = 16_000_000;
/// PLL multiplier: 128 MHz, of 96 to 344. Its input is not divided: 2.66 to 16 MHz are allowed.
const PLL_N: u8 = 8;
/// PLL output divider, towards the core.
const PLL_R: u32 = 2;
/// Core clock, Hz: the chip's highest. Buses and timers have it too.
const CORE_HZ: u32 = HSI_HZ * PLL_N as u32 / PLL_R;
/// Wait states of the flash: one for each 24 MHz begun after the first, at the supply's range 1.
const FLASH_WAIT_STATES: u8 = ((CORE_HZ - 1) / 24_000_000) as u8;

const _: () = assert!(CORE_HZ == 64_000_000);

// All the same: no bus is divided.
const _: () = assert!(
    CLOCKS.core_hz == CORE_HZ
        && CLOCKS.spi_hz == CORE_HZ / 256
        && CLOCKS.byte_timer_hz == CORE_HZ
        && CLOCKS.tick_timer_hz == CORE_HZ
        && CLOCKS.counter_hz == CORE_HZ
        && CLOCKS.pwm_hz == CORE_HZ
        && CLOCKS.serial_hz == CORE_HZ
);

#[path = "byte_update.rs"]
pub(crate) mod byte_request;
#[path = "dma_channels.rs"]
pub(crate) mod dma;
#[path = "flash_g0.rs"]
pub(crate) mod flash;
#[path = "gpio_v2.rs"]
pub(crate) mod gpio;
#[path = "power_g0.rs"]
pub(crate) mod power;
#[path = "spi_v2.rs"]
pub(crate) mod spi;
#[path = "usart_v2.rs"]
pub(crate) mod usart;

pub(crate) const TICK_TIMER: TimGp16 = TIM3;
pub(crate) const TICK_INTERRUPT: Interrupt = Interrupt::TIM3;

/// DMA1 channel 1, counted from 0; it has an interrupt of its own.
const RX_DMA: usize = 0;
/// DMA1 channel 2.
const TX_DMA: usize = 1;
/// Numbers of requests (RM0444, table of the DMAMUX inputs).
const SPI1_RX: u8 = 16;
const TIM6_UP: u8 = 38;
const USART2_RX: u8 = 52;
const USART2_TX: u8 = 53;
/// Alternate function of the PWM's pins, TIM1.
pub(crate) const PWM_FUNCTION: AlternateFunction = 2;

/// The ST-LINK's serial port: USART2 by DMA1.
pub(crate) const SERIAL_USART: Usart = USART2;
/// DMA1 channels 3 and 4.
pub(crate) const SERIAL_ROUTE: Route = Route { rx: 2, tx: 3 };
pub(crate) const SERIAL_FUNCTION: AlternateFunction = 1;

/// The whisker: SPI1 by TIM6 and DMA1, PWM 1, TIM2.
pub(crate) static LEFT: Side = Side {
    sensor: SensorPort {
        spi: SPI1,
        divider: Br::DIV256,
        byte_timer: TIM6,
        byte_timer_divider: 1,
        dma: Route {
            rx: RX_DMA,
            tx: TX_DMA,
        },
        received: {
            static RECEIVED: Received = Received::new();
            &RECEIVED
        },
        pins: LEFT_SENSOR,
        function: 0,
    },
    bridge: LEFT_BRIDGE,
    encoder: EncoderPort {
        #[allow(unsafe_code, reason = "a timer of 32 bits has the registers of one of 16")]
        // SAFETY: the registers of both have the same offsets, and the lower halves of
        // count, reload and compare values the same bits (RM0444, chapter 22).
        timer: unsafe { TimGp16::from_ptr(TIM2.as_ptr()) },
        a: LEFT_ENCODER[0],
        b: LEFT_ENCODER[1],
        function: 2,
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
        (flags.pwrrstf(), StartCause::Power),
        (flags.pinrstf(), StartCause::Pin),
    ])
}

pub(crate) fn start_clocks() -> Result<ClockSource, NoClock> {
    const { assert!(PLL_N == 8 && PLL_R == 2) };
    RCC.pllcfgr().write(|w| {
        w.set_pllsrc(Pllsrc::HSI);
        w.set_pllm(Pllm::DIV1);
        w.set_plln(Plln::MUL8);
        w.set_pllr(Pllr::DIV2);
        w.set_pllren(true);
    });
    RCC.cr().modify(|w| w.set_pllon(true));
    wait(|| RCC.cr().read().pllrdy())?;

    // Wait states before the clock that needs them.
    let wait_states = Latency::from_bits(FLASH_WAIT_STATES);
    FLASH.acr().modify(|w| {
        w.set_prften(true);
        w.set_icen(true);
        w.set_latency(wait_states);
    });
    wait(|| FLASH.acr().read().latency() == wait_states)?;
    RCC.cfgr().modify(|w| w.set_sw(Sw::PLL1_R));
    wait(|| RCC.cfgr().read().sws() == Sw::PLL1_R)?;

    RCC.apbenr1().modify(|w| w.set_tim3en(true));
    settle();
    Ok(ClockSource::Own)
}

/// Whether the non-maskable interrupt is that of a clock: this one runs by its own
/// oscillator, which nothing watches. What is left is memory (RM0444, chapter 11.3).
pub(crate) const fn has_clock_stopped() -> bool {
    false
}

pub(crate) fn clock_ports() {
    RCC.gpioenr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
    });
    settle();
}

pub(crate) fn clock_sensors(_: u8) {
    RCC.ahbenr().modify(|w| w.set_dma1en(true));
    RCC.apbenr1().modify(|w| w.set_tim6en(true));
    RCC.apbenr2().modify(|w| w.set_spi1en(true));
    settle();
    DMAMUX1.ccr(RX_DMA).write(|w| w.set_dmareq_id(SPI1_RX));
    DMAMUX1.ccr(TX_DMA).write(|w| w.set_dmareq_id(TIM6_UP));
}

/// Its USART has the bus's clock after a reset.
pub(crate) fn clock_serial() {
    RCC.ahbenr().modify(|w| w.set_dma1en(true));
    RCC.apbenr1().modify(|w| w.set_usart2en(true));
    settle();
    DMAMUX1
        .ccr(SERIAL_ROUTE.rx)
        .write(|w| w.set_dmareq_id(USART2_RX));
    DMAMUX1
        .ccr(SERIAL_ROUTE.tx)
        .write(|w| w.set_dmareq_id(USART2_TX));
}

pub(crate) fn reset_spi(_: Spi) {
    RCC.apbrstr2().modify(|w| w.set_spi1rst(true));
    RCC.apbrstr2().modify(|w| w.set_spi1rst(false));
}

/// From the reset on PA8 and PB15 are pulled down, as the pins of a USB-C socket with an
/// empty battery are, until the strobe of their controller, which is never switched on, lets
/// go of them (RM0444, section 8.1.1; embassy-stm32's `ucpd::init` does the same).
pub(crate) fn clock_motors(_: u8) {
    RCC.apbenr1().modify(|w| w.set_tim2en(true));
    RCC.apbenr2().modify(|w| {
        w.set_tim1en(true);
        w.set_syscfgen(true);
    });
    settle();
    SYSCFG.cfgr1().modify(|w| {
        w.set_ucpd1_strobe(true);
        w.set_ucpd2_strobe(true);
    });
}

/// The debugger has no claim to them on this chip.
pub(crate) fn free_hall_pins() {}

/// Keeps the log readable in sleep; a debugger that halts the core stops TIM1, whose outputs go
/// low then, and the watchdog.
pub(crate) fn prepare_for_debuggers() {
    RCC.apbenr1().modify(|w| w.set_dbgen(true));
    settle();
    // No bit is for sleep (RM0444, DBG_CR): bus and RAM keep their clocks in it, as they do
    // after a reset (RCC_AHBSMENR), and the log can be read.
    DBGMCU.apb1fzr().modify(|w| w.set_iwdg(true));
    DBGMCU.apb2fzr().modify(|w| w.set_tim1(true));
}
