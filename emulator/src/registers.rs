//! The facts of the chips: as a table, to be compared with their descriptions, and as the page
//! `docs/registers.md`.

use std::fmt::Write as _;

use host_sim::Error;

use crate::chip::{Fact, FactKind, MODELS, Model, facts};

const HEAD: &str = include_str!("registers/head.md");

struct Chip {
    program: &'static str,
    title: &'static str,
    /// Who says the same of its pins, and of its requests.
    pins: &'static str,
    requests: &'static str,
}

const CHIPS: [Chip; 3] = [
    Chip {
        program: "nucleo_f446re",
        title: "NUCLEO-F446RE: STM32F446RE (RM0390)",
        pins: "stm32f4xx-hal `src/gpio/alt/f4.rs`",
        requests: "stm32f4xx-hal `src/dma/traits/f4.rs`",
    },
    Chip {
        program: "nucleo_f103rb",
        title: "NUCLEO-F103RB: STM32F103RB (RM0008)",
        pins: "stm32f1xx-hal `src/afio.rs`, in place 0",
        requests: "stm32f1xx-hal `src/spi/dma.rs` of SPI1, `src/serial.rs` of USART2, none of TIM4",
    },
    Chip {
        program: "nucleo_g071rb",
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
    let mut text = format!(
        "<!-- written by cargo xtask descriptions -->\n{}",
        HEAD.trim_end()
    );
    for chip in &CHIPS {
        let model = MODELS.iter().find(|model| model.program == chip.program);
        if let Some(model) = model {
            text += &of_chip(chip, model);
        }
    }
    text + "\n"
}

fn of_chip(chip: &Chip, model: &Model) -> String {
    let facts = facts(model);
    let of = |kind: FactKind| facts.iter().filter(move |fact| fact.kind == kind);
    let mut text = format!("\n\n## {}\n", chip.title);
    let mut line = |line: String| {
        // Writing to a string does not fail.
        let _ = write!(text, "\n{line}");
    };
    let sizes: Vec<u32> = of(FactKind::Chip).map(|fact| fact.value[0]).collect();
    if let [flash, ram, bits] = sizes[..] {
        let (flash, ram) = (flash / 1024, ram / 1024);
        line(format!(
            "{flash} KiB of flash, {ram} KiB of RAM, {bits} bits of a priority."
        ));
    }
    line(
        "\n| peripheral | base | gate: RCC +, bit | reset: RCC +, bit |\n|---|---|---|---|"
            .to_owned(),
    );
    for address in of(FactKind::Address) {
        let cell = |kind| cell(model, of(kind).find(|fact| fact.of == address.of));
        let (gate, reset) = (cell(FactKind::Gate), cell(FactKind::Reset));
        line(format!(
            "| {} | {} | {gate} | {reset} |",
            address.of,
            hex(address.value[0])
        ));
    }
    let others = |others| format!("\nThe same say {others}.\n");
    let (pins, requests) = (others(chip.pins), others(chip.requests));
    for (kind, before, title) in [
        (FactKind::Interrupt, String::new(), "interrupt | number"),
        (FactKind::Pin, pins, "pin | alternate function"),
        (
            FactKind::Request,
            requests,
            "DMA request | channel or number",
        ),
    ] {
        line(format!("{before}\n| {title} |\n|---|---|"));
        for fact in of(kind) {
            line(format!("| {} {} | {} |", fact.of, fact.part, fact.value[0]));
        }
    }
    line("\n| register | offset | bits |\n|---|---|---|".to_owned());
    let bits: Vec<&Fact> = of(FactKind::Bits).collect();
    for register in bits.chunk_by(|a, b| a.of == b.of && register(a) == register(b)) {
        if let [first, ..] = register {
            let names: Vec<String> = register.iter().map(|fact| places(fact)).collect();
            let (of, name) = (&first.of, self::register(first));
            let offset = first.value[0];
            line(format!(
                "| {of} {name} | 0x{offset:02X} | {} |",
                names.join(", ")
            ));
        }
    }
    text
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
