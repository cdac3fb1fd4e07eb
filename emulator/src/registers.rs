//! The facts of the chips: as a table, to be compared with their descriptions, and as the page
//! `docs/registers.md`.

use std::fmt::Write as _;

use host_sim::Error;

use crate::chip::{Fact, FactKind, MODELS, Model, facts};

const HEAD: &str = include_str!("registers/head.md.in");

struct Chip {
    title: &'static str,
    /// Who says the same of its pins, and of its requests.
    pins: &'static str,
    requests: &'static str,
}

/// In the order of [`MODELS`].
const CHIPS: [Chip; 3] = [
    Chip {
        title: "NUCLEO-F446RE: STM32F446RE (RM0390)",
        pins: "stm32f4xx-hal `src/gpio/alt/f4.rs`",
        requests: "stm32f4xx-hal `src/dma/traits/f4.rs`",
    },
    Chip {
        title: "NUCLEO-F103RB: STM32F103RB (RM0008)",
        pins: "stm32f1xx-hal `src/afio.rs`, in place 0",
        requests: "stm32f1xx-hal `src/spi/dma.rs` of SPI1, `src/serial.rs` of USART2, none of TIM4",
    },
    Chip {
        title: "NUCLEO-G071RB: STM32G071RB (RM0444)",
        pins: "stm32g0xx-hal `src/spi.rs` and `src/timer/pins.rs`",
        requests: "stm32g0xx-hal `src/dmamux.rs`",
    },
];

/// Where else a fact stands that no description has: the gate and the reset of a debug unit.
fn alone(model: &Model, fact: &Fact) -> Option<&'static str> {
    let is_gate = matches!(fact.kind, FactKind::Gate | FactKind::Reset);
    let is_alone = is_gate && model.program == "nucleo_g071rb" && fact.of == "DBGMCU";
    is_alone.then_some("stm32g0xx-hal `src/rcc/enable.rs`: DBG")
}

/// The model of the chip of a board, by its name.
pub(crate) fn model(board: &str) -> Result<&'static Model, Error> {
    let mut models = MODELS.iter().copied();
    let model = models.find(|model| model.program == board.replace('-', "_"));
    model.ok_or_else(|| Error::Input(format!("no board {board}")))
}

/// The facts of a board's chip, a line each: kind, peripheral, part, two numbers, and where
/// it stands if no description has it.
pub(crate) fn table(board: &str) -> Result<String, Error> {
    let model = model(board)?;
    let mut text = String::new();
    for fact in facts(model) {
        let alone = alone(model, &fact).unwrap_or_default();
        let kind = format!("{:?}", fact.kind).to_lowercase();
        let (of, part, [first, second]) = (fact.of, fact.part, fact.value);
        // Writing to a string does not fail.
        let _ = writeln!(text, "{kind},{of},{part},{first},{second},{alone}");
    }
    Ok(text)
}

pub(crate) fn page() -> String {
    let chips = MODELS.iter().zip(&CHIPS);
    let chips: String = chips.map(|(model, chip)| of_chip(chip, model)).collect();
    let head = HEAD.trim_end();
    format!("<!-- written by cargo xtask descriptions -->\n{head}{chips}\n")
}

fn of_chip(chip: &Chip, model: &Model) -> String {
    let facts = facts(model);
    let of = |kind: FactKind| facts.iter().filter(move |fact| fact.kind == kind);
    let peripherals = of(FactKind::Address).map(|address| {
        let cell = |kind| cell(model, of(kind).find(|fact| fact.of == address.of));
        let (gate, reset) = (cell(FactKind::Gate), cell(FactKind::Reset));
        let (name, base) = (&address.of, hex(address.value[0]));
        format!("| {name} | {base} | {gate} | {reset} |")
    });
    let number = |fact: &Fact| format!("| {} {} | {} |", fact.of, fact.part, fact.value[0]);
    let numbers = |kind| lines(of(kind).map(number));
    let bits: Vec<&Fact> = of(FactKind::Bits).collect();
    let registers = bits.chunk_by(|a, b| a.of == b.of && register(a) == register(b));
    let registers = registers.map(|facts| {
        let names: Vec<String> = facts.iter().map(|fact| places(fact)).collect();
        let (of, name, offset) = (&facts[0].of, register(facts[0]), facts[0].value[0]);
        format!("| {of} {name} | 0x{offset:02X} | {} |", names.join(", "))
    });
    format!(
        include_str!("registers/chip.md.in"),
        title = chip.title,
        flash = model.flash / 1024,
        ram = model.ram / 1024,
        bits = model.priority_bits,
        peripherals = lines(peripherals),
        interrupts = numbers(FactKind::Interrupt),
        same_pins = chip.pins,
        pins = numbers(FactKind::Pin),
        same_requests = chip.requests,
        requests = numbers(FactKind::Request),
        registers = lines(registers),
    )
}

fn lines(lines: impl Iterator<Item = String>) -> String {
    lines.collect::<Vec<_>>().join("\n")
}

fn cell(model: &Model, fact: Option<&Fact>) -> String {
    let Some(fact) = fact else {
        return String::new();
    };
    let [register, bit] = fact.value;
    let marked = alone(model, fact).map(|who| format!(" **†** {who}"));
    format!("0x{register:02X}, {bit}{}", marked.unwrap_or_default())
}

fn hex(address: u32) -> String {
    format!("0x{:04X}_{:04X}", address >> 16, address & 0xFFFF)
}

fn register(fact: &Fact) -> &str {
    fact.part.split('.').next().unwrap_or_default()
}

fn places(fact: &Fact) -> String {
    let Some((_, name)) = fact.part.split_once('.') else {
        return String::new();
    };
    let bits = fact.value[1];
    let (lowest, highest) = (bits.trailing_zeros(), 31 - bits.leading_zeros().min(31));
    if lowest == highest {
        format!("{name} {lowest}")
    } else {
        format!("{name} {highest}:{lowest}")
    }
}
