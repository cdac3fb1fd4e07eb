//! The model's numbers against another source: the description of the STM32F446RE in
//! stm32-metapac, which is made from ST's configuration tool and register files.

use stm32_metapac::metadata::ir::{BitOffset, IR, RegularBitOffset};
use stm32_metapac::metadata::{
    METADATA, Peripheral, PeripheralRccKernelClock, PeripheralRccRegister,
};

use super::super::registers::{MAP, Unit};
use super::super::timers::{KINDS, Kind, TIM1, TIM2, TIM3, TIM5, TIM6, TIM7, TIM8};
use super::super::wiring::{self, PWM, PWM_FUNCTION, Pin, Request, SIDES, SPI_FUNCTION};
use super::{RCC, Rig};
use crate::chip::{FRAME_IRQS, TICK, TICK_IRQ};

const SPIS: [&str; 2] = ["SPI1", "SPI2"];
const DMAS: [&str; 2] = ["DMA1", "DMA2"];

fn timer_name(n: usize) -> &'static str {
    match n {
        TIM1 => "TIM1",
        TIM2 => "TIM2",
        TIM3 => "TIM3",
        TIM5 => "TIM5",
        TIM6 => "TIM6",
        TIM7 => "TIM7",
        TIM8 => "TIM8",
        _ => panic!("no timer {n}"),
    }
}

fn name(unit: Unit) -> &'static str {
    match unit {
        Unit::Tim(n) => timer_name(n),
        Unit::Watchdog => "IWDG",
        Unit::Spi(n) => SPIS[n],
        Unit::Gpio(n) => ["GPIOA", "GPIOB", "GPIOC"][n],
        Unit::Rcc => "RCC",
        Unit::Flash => "FLASH",
        Unit::Dma(n) => DMAS[n],
        Unit::Debug => "DBGMCU",
    }
}

fn peripheral(name: &str) -> &'static Peripheral {
    let mut all = METADATA.peripherals.iter();
    all.find(|peripheral| peripheral.name == name).unwrap()
}

/// The address of a register of RCC, and the bit of a field in it.
fn place(of: &PeripheralRccRegister) -> (u32, u32) {
    let rcc: &IR = peripheral("RCC").registers.as_ref().unwrap().ir;
    let named = |name: &str, other: &str| name.eq_ignore_ascii_case(other);
    let mut registers = rcc.blocks[0].items.iter();
    let register = registers.find(|item| named(item.name, of.register));
    let mut sets = rcc.fieldsets.iter();
    let set = sets.find(|set| named(set.name, of.register)).unwrap();
    let field = set.fields.iter().find(|field| named(field.name, of.field));
    let BitOffset::Regular(RegularBitOffset { offset }) = field.unwrap().bit_offset else {
        panic!("{} is not in one place", of.field);
    };
    (RCC + register.unwrap().byte_offset, offset)
}

#[test]
fn every_unit_stands_where_the_chip_has_it_and_has_its_gate_and_reset() {
    for (unit, base, gate) in MAP {
        let name = name(unit);
        let found = peripheral(name);
        assert_eq!(u64::from(base), found.address, "{name}");
        let Some((bus, bit)) = gate else {
            continue;
        };
        let rcc = found.rcc.as_ref().unwrap();
        let (enable, enable_bit) = place(rcc.enable.as_ref().unwrap());
        let (reset, reset_bit) = place(rcc.reset.as_ref().unwrap());
        assert_eq!([enable_bit, reset_bit], [bit; 2], "{name}");
        let mut rig = Rig::new();
        rig.write(enable, 1 << bit);
        let is_clocked = |rig: &Rig| rig.chip.find(base).unwrap().1;
        assert!(is_clocked(&rig), "{name}");
        rig.write(enable, !(1 << bit));
        assert!(!is_clocked(&rig), "{name}");
        rig.write(reset, 1 << bit);
        assert!(rig.chip.rcc.take_reset(bus, bit), "{name}");
    }
}

#[test]
fn timers_and_spis_have_their_kind_and_their_bus() {
    let mut rig = Rig::new();
    rig.run_fast();
    let clocks = rig.chip.clocks;
    let clock = |name: &str| {
        let rcc = peripheral(name).rcc.as_ref().unwrap();
        match rcc.kernel_clock {
            PeripheralRccKernelClock::Clock("PCLK1") => clocks.apb1,
            PeripheralRccKernelClock::Clock("PCLK2") => clocks.apb2,
            PeripheralRccKernelClock::Clock("PCLK1_TIM") => clocks.apb1_timer,
            PeripheralRccKernelClock::Clock("PCLK2_TIM") => clocks.apb2_timer,
            ref other => panic!("{name}: {other:?}"),
        }
    };
    for n in [TIM1, TIM2, TIM3, TIM5, TIM6, TIM7, TIM8] {
        let name = timer_name(n);
        let kind = match peripheral(name).registers.as_ref().unwrap().block {
            "TIM_BASIC" => Kind::Basic,
            "TIM_GP16" => Kind::General,
            "TIM_GP32" => Kind::Wide,
            "TIM_ADV" => Kind::Advanced,
            other => panic!("{name}: {other}"),
        };
        assert_eq!(KINDS[n], kind, "{name}");
        assert_eq!(rig.chip.timer_clock(n), clock(name), "{name}");
    }
    for (n, name) in SPIS.into_iter().enumerate() {
        assert_eq!(rig.chip.spi_clock(n), clock(name), "{name}");
    }
}

/// Whether a peripheral has `signal` on `pin` by that alternate function.
fn has_pin(name: &str, signal: &str, Pin { port, number }: Pin, function: u32) -> bool {
    let pin = format!("P{}{number}", ["A", "B", "C"][port]);
    let mut pins = peripheral(name).pins.iter();
    pins.any(|at| at.pin == pin && at.signal == signal && at.af.map(u32::from) == Some(function))
}

#[test]
fn every_pin_has_its_peripheral_by_its_function() {
    for (side, spi) in SIDES.iter().zip(SPIS) {
        for (pin, signal) in side.spi.into_iter().zip(["SCK", "MISO", "MOSI"]) {
            assert!(has_pin(spi, signal, pin, SPI_FUNCTION), "{spi} {pin:?}");
        }
        let timer = timer_name(side.encoder_timer);
        for (pin, signal) in side.encoder.into_iter().zip(["CH1", "CH2"]) {
            let function = side.encoder_function;
            assert!(has_pin(timer, signal, pin, function), "{timer} {pin:?}");
        }
    }
    for (pin, signal) in PWM.into_iter().zip(["CH1", "CH2", "CH3"]) {
        assert!(has_pin("TIM1", signal, pin, PWM_FUNCTION), "{pin:?}");
    }
}

#[test]
fn no_pin_is_used_twice() {
    let mut pins: Vec<Pin> = [wiring::PWM, wiring::ENABLES, wiring::HALLS].concat();
    for side in &SIDES {
        pins.extend(side.spi);
        pins.extend(side.encoder);
        pins.extend([side.select, side.direction]);
    }
    for (n, pin) in pins.iter().enumerate() {
        assert!(!pins[..n].contains(pin), "{pin:?}");
    }
}

/// Whether a peripheral's `signal` can ask that stream of a DMA controller.
fn asks(name: &str, signal: &str, dma: usize, request: Request) -> bool {
    let stream = format!("{}_CH{}", DMAS[dma], request.stream);
    let mut channels = peripheral(name).dma_channels.iter();
    channels.any(|channel| {
        channel.signal == signal
            && channel.channel == Some(&stream)
            && channel.request == Some(request.channel)
    })
}

#[test]
fn every_request_reaches_its_stream() {
    for (side, spi) in SIDES.iter().zip(SPIS) {
        assert!(asks(spi, "RX", side.dma, side.rx), "{spi}");
        let timer = timer_name(side.byte_timer);
        assert!(asks(timer, "UP", side.dma, side.tx), "{timer}");
    }
}

/// The number in the NVIC of a peripheral's interrupt.
fn interrupt(name: &str, signal: &str) -> Option<u32> {
    let mut signals = peripheral(name).interrupts.iter();
    let found = signals.find(|found| found.signal == signal)?;
    let mut all = METADATA.interrupts.iter();
    let number = all.find(|interrupt| interrupt.name == found.interrupt)?;
    Some(number.number)
}

#[test]
fn every_interrupt_has_its_number() {
    let tick = interrupt(timer_name(TICK), "UP");
    assert_eq!(tick, Some(TICK_IRQ.into()));
    for (side, irq) in SIDES.iter().zip(FRAME_IRQS) {
        let signal = format!("CH{}", side.rx.stream);
        assert_eq!(interrupt(DMAS[side.dma], &signal), Some(irq.into()));
    }
}
