//! The checks of one chip: `MODEL` against the description in `metapac`.

use super::MODEL;
use super::metapac::metadata::ir::{BitOffset, IR, RegularBitOffset};
use super::metapac::metadata::{
    METADATA, Peripheral, PeripheralRccKernelClock, PeripheralRccRegister,
};
use crate::chip::map::Unit;
use crate::chip::rcc::Bus::{Apb1, Apb2};
use crate::chip::tests::Rig;
use crate::chip::timers::Kind;
use crate::chip::wiring::{ENABLES, HALLS, PWM, Pin, Request};
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
fn the_memories_are_the_chips() {
    let find = |name: &str| {
        let mut regions = METADATA.memory[0].iter();
        let found = regions
            .find(|region| region.name.starts_with(name))
            .unwrap();
        (found.address, found.size)
    };
    // The sizes of several banks that lie side by side add up.
    let sum = |kind: &str| -> u32 {
        let regions = METADATA.memory[0].iter();
        let named = regions.filter(|region| region.name.starts_with(kind));
        named.map(|region| region.size).sum()
    };
    assert_eq!(find("BANK_1").0, crate::memory::FLASH);
    assert_eq!(sum("BANK_1"), MODEL.flash);
    assert_eq!((find("SRAM").0, sum("SRAM")), (0x2000_0000, MODEL.ram));
    assert_eq!(METADATA.nvic_priority_bits, Some(MODEL.priority_bits));
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

/// Whether a peripheral has `signal` on `pin` by that alternate function; by that place of
/// its pins without remapping, where there are no functions.
fn has_pin(name: &str, signal: &str, Pin { port, number }: Pin, function: u32) -> bool {
    let pin = format!("P{}{number}", ["A", "B", "C"][port]);
    let peripheral = peripheral(name);
    let mut pins = peripheral.pins.iter();
    let found = pins.any(|at| {
        let by_function = at.af.is_none_or(|af| u32::from(af) == function);
        at.pin == pin && at.signal == signal && by_function
    });
    let in_place = peripheral.afio.as_ref().is_none_or(|afio| {
        let place = afio.values.iter().find(|place| place.value == 0).unwrap();
        place.pins.contains(&pin.as_str())
    });
    found && in_place
}

#[test]
fn every_pin_has_its_peripheral_by_its_function() {
    let wiring = &MODEL.wiring;
    for (side, spi) in wiring.sides.iter().zip(SPIS) {
        for (pin, signal) in side.spi.into_iter().zip(["SCK", "MISO", "MOSI"]) {
            let function = wiring.spi_function;
            assert!(has_pin(spi, signal, pin, function), "{spi} {pin:?}");
        }
        let timer = timer_name(side.encoder_timer);
        for (pin, signal) in side.encoder.into_iter().zip(["CH1", "CH2"]) {
            let function = side.encoder_function;
            assert!(has_pin(timer, signal, pin, function), "{timer} {pin:?}");
        }
    }
    assert_eq!(timer_name(wiring.pwm_timer), "TIM1");
    for (pin, signal) in PWM.into_iter().zip(["CH1", "CH2", "CH3"]) {
        let function = wiring.pwm_function;
        assert!(has_pin("TIM1", signal, pin, function), "{pin:?}");
    }
}

#[test]
fn no_pin_is_used_twice() {
    let mut pins: Vec<Pin> = [PWM, ENABLES, HALLS].concat();
    for side in MODEL.wiring.sides {
        pins.extend(side.spi);
        pins.extend(side.encoder);
        pins.extend([side.select, side.direction]);
    }
    for (n, pin) in pins.iter().enumerate() {
        assert!(!pins[..n].contains(pin), "{pin:?}");
    }
}

/// Whether a peripheral's `signal` can ask that stream or channel of a DMA controller.
fn asks(name: &str, signal: &str, dma: usize, request: Request) -> bool {
    let channel = match MODEL.dmas[dma] {
        dma::Version::Streams => format!("{}_CH{}", DMAS[dma], request.stream),
        // Channels are counted from 1.
        dma::Version::Channels => format!("{}_CH{}", DMAS[dma], request.stream + 1),
    };
    let mut all = peripheral(name).dma_channels.iter();
    all.any(|found| {
        // By way of a DMAMUX every channel can be asked.
        let reaches = found.channel.is_none_or(|found| found == channel);
        // What is wired has no number.
        let selected = found.request.map_or(0, u32::from);
        found.signal == signal && reaches && selected == request.channel
    })
}

#[test]
fn every_request_reaches_its_stream() {
    for (side, spi) in MODEL.wiring.sides.iter().zip(SPIS) {
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
