//! What driver and models take from the chips' manuals, as a list: where peripherals stand,
//! their gates, interrupts, pins and requests, and the bits of their registers. Every value is
//! the one that the models use.

use firmware::BoardCode;

use super::fields::Field;
use super::model::Unit;
use super::rcc::Bus;
use super::timer::Kind;
use super::wiring::{CAN, CAN_IRQS, PWM, Pin, Request, SERIAL, SERIAL_DMA};
use super::{Model, SUPPLY_IRQ, can, lines, mux, power, remap, spi, timer, usart, watchdog};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FactKind {
    /// Bytes of flash, or of RAM; bits of a priority in the NVIC.
    Chip,
    Address,
    /// The register of RCC, from its base, and the bit in it that clocks a peripheral.
    Gate,
    Reset,
    Interrupt,
    Pin,
    /// What selects a request: the channel of a stream, or the number of DMAMUX.
    Request,
    /// A register, from the base of its peripheral, and bits of it.
    Bits,
    /// The kind of a peripheral, and the bus whose clock it has: 1 or 2; of a DMA none.
    Kind,
}

#[derive(Debug, Clone)]
pub(crate) struct Fact {
    pub(crate) kind: FactKind,
    /// The peripheral, by the name that the manuals have for it.
    pub(crate) of: String,
    pub(crate) part: String,
    pub(crate) value: [u32; 2],
}

fn fact(kind: FactKind, of: &str, part: impl Into<String>, value: [u32; 2]) -> Fact {
    Fact {
        kind,
        of: of.to_owned(),
        part: part.into(),
        value,
    }
}

/// The manuals' name of a unit.
fn name(model: &Model, unit: Unit) -> &'static str {
    match unit {
        Unit::Tim(n) => model.timers[n].0,
        Unit::Watchdog => "IWDG",
        Unit::Spi(n) => ["SPI1", "SPI2"][n],
        Unit::Gpio(n) => ["GPIOA", "GPIOB", "GPIOC"][n],
        Unit::Rcc => "RCC",
        Unit::Flash => "FLASH",
        Unit::Dma(n) => ["DMA1", "DMA2"][n],
        Unit::Requests => "DMAMUX1",
        Unit::Remap => "AFIO",
        Unit::System => "SYSCFG",
        Unit::Debug => "DBGMCU",
        Unit::Power => "PWR",
        Unit::Lines => "EXTI",
        Unit::Usart => "USART2",
        // A chip with one of them does not number it.
        Unit::Can if model.facts.code == BoardCode::NucleoF103rb => "CAN",
        Unit::Can => "CAN1",
    }
}

fn fields(model: &Model, unit: Unit) -> Vec<Field> {
    match unit {
        Unit::Tim(n) => timer::fields(model.timers[n].1),
        Unit::Watchdog => watchdog::FIELDS.to_vec(),
        Unit::Spi(_) => spi::fields(model.spi_version),
        Unit::Gpio(n) => model.ports[n].layout.fields.to_vec(),
        Unit::Rcc => model.rcc.fields(),
        Unit::Flash => power::options(model.power)
            .into_iter()
            .chain(model.flash_interface.fields())
            .collect(),
        Unit::Power => power::fields(model.power),
        Unit::Lines => lines::fields(model.lines),
        Unit::Dma(n) => model.dmas[n].fields.to_vec(),
        Unit::Usart => usart::fields(model.usart),
        Unit::Can => can::fields(),
        Unit::Requests => mux::FIELDS.to_vec(),
        Unit::Remap => remap::FIELDS.to_vec(),
        _ => Vec::new(),
    }
}

pub(crate) fn facts(model: &Model) -> Vec<Fact> {
    let levels = model.priority_bits.into();
    let mut facts = vec![
        fact(FactKind::Chip, "flash", "", [model.flash, 0]),
        fact(FactKind::Chip, "RAM", "", [model.ram, 0]),
        fact(FactKind::Chip, "NVIC", "priority bits", [levels, 0]),
    ];
    for &(unit, base, gate) in model.map {
        let of = name(model, unit);
        facts.push(fact(FactKind::Address, of, "", [base, 0]));
        if let Some((bus, bit)) = gate {
            facts.extend(gates(model, of, bus, bit));
        }
    }
    facts.extend(kinds(model));
    facts.extend(wired(model));
    // Of several alike one is enough; that the others are is in their addresses' list.
    let mut known: Vec<Vec<Field>> = Vec::new();
    for &(unit, ..) in model.map {
        let of_unit = fields(model, unit);
        if !known.contains(&of_unit) {
            let of = name(model, unit);
            facts.extend(of_unit.iter().map(|field| bits(of, field)));
            known.push(of_unit);
        }
    }
    facts
}

fn kinds(model: &Model) -> Vec<Fact> {
    let kind = |unit, kind: &str, bus: Option<Bus>| {
        let bus = bus.map_or(0, |bus| if bus == Bus::Apb2 { 2 } else { 1 });
        fact(FactKind::Kind, name(model, unit), kind, [bus, 0])
    };
    let timers = model.timers.iter().enumerate().map(|(n, (_, of, bus))| {
        let word = match of {
            Kind::Basic => "TIM_BASIC",
            Kind::General => "TIM_GP16",
            Kind::Wide => "TIM_GP32",
            Kind::Advanced => "TIM_ADV",
        };
        kind(Unit::Tim(n), word, Some(*bus))
    });
    let spis = model.spis.iter().enumerate().map(|(n, bus)| {
        let has_queues = model.spi_version == spi::Version::Queues;
        let word = if has_queues { "queues" } else { "no queues" };
        kind(Unit::Spi(n), word, Some(*bus))
    });
    let dmas = model.dmas.iter().enumerate().map(|(n, layout)| {
        let word = if layout.has_channels { "bdma" } else { "dma" };
        kind(Unit::Dma(n), word, None)
    });
    timers.chain(spis).chain(dmas).collect()
}

fn gates(model: &Model, of: &str, bus: Bus, bit: u32) -> impl Iterator<Item = Fact> {
    let gate = model.rcc.gate(bus);
    let gate = gate.map(|register| fact(FactKind::Gate, of, "", [register, bit]));
    let reset = model.rcc.reset(bus);
    let reset = reset.map(|register| fact(FactKind::Reset, of, "", [register, bit]));
    gate.into_iter().chain(reset)
}

fn bits(of: &str, field: &Field) -> Fact {
    let part = match field.name {
        "" => field.register.to_owned(),
        name => format!("{}.{name}", field.register),
    };
    fact(FactKind::Bits, of, part, [field.offset, field.bits])
}

fn wired(model: &Model) -> Vec<Fact> {
    let wiring = &model.wiring;
    let timer = |n| name(model, Unit::Tim(n));
    let interrupt =
        |of, part: &str, number: u16| fact(FactKind::Interrupt, of, part, [number.into(), 0]);
    let mut facts = vec![
        interrupt(timer(wiring.tick), "UP", wiring.tick_irq),
        interrupt("PVD", "by EXTI", SUPPLY_IRQ),
    ];
    for (n, side) in wiring.sides.iter().enumerate() {
        let (spi, dma) = (name(model, Unit::Spi(n)), name(model, Unit::Dma(side.dma)));
        let frame = interrupt(dma, &channel(model, side.dma, side.rx), side.end_of_frame);
        facts.push(frame);
        for (of, signal, request) in [
            (spi, "RX", side.rx),
            (timer(side.byte_timer), side.byte_signal.name(), side.tx),
        ] {
            let part = format!("{signal} on {dma}_{}", channel(model, side.dma, request));
            facts.push(fact(FactKind::Request, of, part, [request.channel, 0]));
        }
        let signals = ["SCK", "MISO", "MOSI"];
        facts.extend(pins(spi, &signals, &side.pins.spi, wiring.spi_function));
        let encoder = timer(side.encoder_timer);
        let function = side.encoder_function;
        facts.extend(pins(encoder, &["CH1", "CH2"], &side.pins.encoder, function));
    }
    let (usart, dma) = (name(model, Unit::Usart), name(model, Unit::Dma(SERIAL_DMA)));
    for (signal, request) in [("RX", wiring.serial_rx), ("TX", wiring.serial_tx)] {
        let part = format!("{signal} on {dma}_{}", channel(model, SERIAL_DMA, request));
        facts.push(fact(FactKind::Request, usart, part, [request.channel, 0]));
    }
    let function = wiring.serial_function;
    facts.extend(pins(usart, &["TX", "RX"], &SERIAL, function));
    if let Some(function) = wiring.can_function {
        let can = name(model, Unit::Can);
        let parts = ["RX0", "TX"].into_iter().zip(CAN_IRQS);
        facts.extend(parts.map(|(part, number)| interrupt(can, part, number)));
        facts.extend(pins(can, &["RX", "TX"], &CAN, function));
    }
    let pwm = timer(wiring.pwm_timer);
    let signals = ["CH1", "CH2", "CH3"];
    facts.extend(pins(pwm, &signals, &PWM, wiring.pwm_function));
    facts
}

fn pins(of: &str, signals: &[&str], pins: &[Pin], function: u32) -> Vec<Fact> {
    let pins = signals.iter().zip(pins).map(|(signal, pin)| {
        let part = format!("{signal} on P{}{}", ["A", "B", "C"][pin.port], pin.number);
        fact(FactKind::Pin, of, part, [function, 0])
    });
    pins.collect()
}

/// The manuals' name of a stream, or of a channel, which are counted from 1.
fn channel(model: &Model, dma: usize, request: Request) -> String {
    let first = usize::from(model.dmas[dma].has_channels);
    format!("CH{}", request.stream + first)
}
