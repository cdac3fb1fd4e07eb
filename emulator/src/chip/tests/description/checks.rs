//! The checks of one chip: what `MODEL` does against the description in `metapac`. Its numbers
//! are compared by `cargo xtask descriptions`.

use super::MODEL;
use super::metapac::metadata::ir::{BitOffset, IR, RegularBitOffset};
use super::metapac::metadata::{
    METADATA, Peripheral, PeripheralRccKernelClock, PeripheralRccRegister,
};
use crate::chip::map::Unit;
use crate::chip::rcc::Bus::{Apb1, Apb2};
use crate::chip::tests::Rig;
use crate::chip::timers::Kind;
use crate::chip::wiring::{ENABLES, HALLS, PWM, Pin, SERIAL, SIGNALS};
use crate::chip::{SUPPLY_IRQ, dma, spi};

const SPIS: [&str; 2] = ["SPI1", "SPI2"];
const DMAS: [&str; 2] = ["DMA1", "DMA2"];

fn peripheral(name: &str) -> &'static Peripheral {
    let mut all = METADATA.peripherals.iter();
    all.find(|peripheral| peripheral.name == name).unwrap()
}

fn base(unit: Unit) -> u32 {
    let mut map = MODEL.map.iter();
    map.find(|(found, ..)| *found == unit).unwrap().1
}

/// The timer in that place of the model: that of its address.
fn timer_name(n: usize) -> &'static str {
    let address = u64::from(base(Unit::Tim(n)));
    let mut all = METADATA.peripherals.iter();
    let found = all
        .find(|peripheral| peripheral.address == address)
        .unwrap();
    assert!(found.name.starts_with("TIM"), "{}", found.name);
    found.name
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
        Unit::Requests => "DMAMUX1",
        Unit::Remap => "AFIO",
        Unit::System => "SYSCFG",
        Unit::Debug => "DBGMCU",
        Unit::Power => "PWR",
        Unit::Lines => "EXTI",
        Unit::Usart => "USART2",
    }
}

fn block(name: &str) -> (&'static str, &'static str) {
    let registers = peripheral(name).registers.as_ref().unwrap();
    (registers.block, registers.version)
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
    (base(Unit::Rcc) + register.unwrap().byte_offset, offset)
}

#[test]
fn every_unit_stands_where_the_chip_has_it_and_has_its_gate_and_reset() {
    for &(unit, base, gate) in MODEL.map {
        let name = name(unit);
        let found = peripheral(name);
        assert_eq!(u64::from(base), found.address, "{name}");
        // DMAMUX has the gate of its DMA controller.
        let rcc = match unit {
            Unit::Requests => &peripheral("DMA1").rcc,
            _ => &found.rcc,
        };
        // The debug unit of the STM32G0 has a gate that the description does not know;
        // flash, RCC and EXTI run always.
        let (Some((bus, bit)), Some(rcc)) = (gate, rcc) else {
            let always = matches!(unit, Unit::Rcc | Unit::Flash | Unit::Lines);
            let may = always || matches!(unit, Unit::Watchdog | Unit::Debug);
            assert!(may, "{name}");
            continue;
        };
        let (enable, enable_bit) = place(rcc.enable.as_ref().unwrap());
        assert_eq!(enable_bit, bit, "{name}");
        let mut rig = Rig::of(&MODEL);
        rig.write(enable, 1 << bit);
        let is_clocked = |rig: &Rig| rig.chip.find(base).unwrap().1;
        assert!(is_clocked(&rig), "{name}");
        rig.write(enable, !(1 << bit));
        assert!(!is_clocked(&rig), "{name}");
        if let Some(reset) = &rcc.reset {
            let (reset, reset_bit) = place(reset);
            assert_eq!(reset_bit, bit, "{name}");
            rig.write(reset, 1 << bit);
            assert!(rig.chip.rcc.take_reset(bus, bit), "{name}");
        }
    }
}

#[test]
fn timers_and_spis_have_their_kind_and_their_bus() {
    let mut rig = Rig::of(&MODEL);
    rig.run_fast();
    let clocks = rig.chip.clocks;
    let clock = |name: &str| {
        let rcc = peripheral(name).rcc.as_ref().unwrap();
        match &rcc.kernel_clock {
            PeripheralRccKernelClock::Clock("PCLK1") => clocks.bus(Apb1),
            PeripheralRccKernelClock::Clock("PCLK2") => clocks.bus(Apb2),
            PeripheralRccKernelClock::Clock("PCLK2_TIM") => clocks.timer(Apb2),
            // A choice is the bus's clock after a reset.
            PeripheralRccKernelClock::Clock("PCLK1_TIM") | PeripheralRccKernelClock::Mux(_) => {
                clocks.timer(Apb1)
            }
            PeripheralRccKernelClock::Clock(other) => panic!("{name}: {other}"),
        }
    };
    for (n, (kind, _)) in MODEL.timers.iter().enumerate() {
        let name = timer_name(n);
        let expected = match block(name).0 {
            "TIM_BASIC" => Kind::Basic,
            "TIM_GP16" => Kind::General,
            "TIM_GP32" => Kind::Wide,
            "TIM_ADV" => Kind::Advanced,
            other => panic!("{name}: {other}"),
        };
        assert_eq!(*kind, expected, "{name}");
        assert_eq!(rig.chip.timer_clock(n), clock(name), "{name}");
    }
    for (n, name) in SPIS.into_iter().enumerate().take(MODEL.spis.len()) {
        assert_eq!(rig.chip.spi_clock(n), clock(name), "{name}");
        let queues = block(name).1.starts_with("v3");
        assert_eq!(MODEL.spi_version == spi::Version::Queues, queues, "{name}");
    }
    for (version, name) in MODEL.dmas.iter().zip(DMAS) {
        let kind = peripheral(name).registers.as_ref().unwrap().kind;
        assert_eq!(*version == dma::Version::Channels, kind == "bdma", "{name}");
    }
}

#[test]
fn no_pin_is_used_twice() {
    let mut pins: Vec<Pin> = [PWM, ENABLES, HALLS].concat();
    pins.extend([SERIAL, SIGNALS].concat());
    for side in MODEL.wiring.sides {
        pins.extend(side.spi);
        pins.extend(side.encoder);
        pins.extend([side.select, side.direction]);
    }
    for (n, pin) in pins.iter().enumerate() {
        assert!(!pins[..n].contains(pin), "{pin:?}");
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
    let wiring = &MODEL.wiring;
    let tick = interrupt(timer_name(wiring.tick), "UP");
    assert_eq!(tick, Some(wiring.tick_irq.into()));
    let mut all = METADATA.interrupts.iter();
    let supply = all.find(|interrupt| interrupt.name == "PVD");
    assert_eq!(supply.map(|found| found.number), Some(SUPPLY_IRQ.into()));
    for side in wiring.sides {
        let first = u32::from(MODEL.dmas[side.dma] == dma::Version::Channels);
        let signal = format!("CH{}", side.rx.stream as u32 + first);
        let number = interrupt(DMAS[side.dma], &signal);
        assert_eq!(number, Some(side.end_of_frame.into()));
    }
}
