//! Holds facts of a chip, as `emulator facts` prints them, against its description in
//! stm32-metapac, which is made from ST's configuration tool and register files.

mod registers;

use std::io::BufRead;
use std::process::ExitCode;

use stm32_metapac::metadata::ir::{BitOffset, IR};
use stm32_metapac::metadata::{
    METADATA, Peripheral, PeripheralRccKernelClock, PeripheralRccRegister,
};

/// A fact: its kind, the peripheral, what of it, and its value; and whether no description is
/// said to have it.
struct Fact<'l> {
    kind: &'l str,
    of: &'l str,
    part: &'l str,
    value: [u32; 2],
    is_alone: bool,
}

impl<'l> Fact<'l> {
    fn read(line: &'l str) -> Option<Self> {
        let mut cells = line.split(',');
        let (kind, of, part) = (cells.next()?, cells.next()?, cells.next()?);
        let value = [cells.next()?.parse().ok()?, cells.next()?.parse().ok()?];
        Some(Self {
            kind,
            of,
            part,
            value,
            is_alone: !cells.next()?.is_empty(),
        })
    }

    /// Whether the description says the same.
    fn is_described(&self) -> bool {
        let [first, _] = self.value;
        match self.kind {
            "chip" => chip(self.of) == Some(first),
            "address" => peripheral(self.of).is_some_and(|p| p.address == u64::from(first)),
            "gate" => self.is_in_rcc(|rcc| rcc.enable.as_ref()),
            "reset" => self.is_in_rcc(|rcc| rcc.reset.as_ref()),
            "interrupt" => interrupt(self.of, self.part) == Some(first),
            "pin" => self.is_pin(),
            "request" => self.is_request(),
            "bits" => peripheral(self.of).is_some_and(|p| registers::has(p, self.part, self.value)),
            "kind" => self.is_kind() == Some(true),
            _ => false,
        }
    }

    /// What a timer, SPI or DMA controller is, and the bus whose clock it has.
    fn is_kind(&self) -> Option<bool> {
        let found = peripheral(self.of)?;
        let registers = found.registers.as_ref()?;
        let bus = match &found.rcc.as_ref()?.kernel_clock {
            _ if self.of.starts_with("DMA") => 0,
            // Its buses have one clock.
            _ if METADATA.name.starts_with("STM32G0") => self.value[0],
            PeripheralRccKernelClock::Clock(name) if name.starts_with("PCLK2") => 2,
            PeripheralRccKernelClock::Clock(name) if name.starts_with("PCLK1") => 1,
            // A choice is the bus's clock after a reset.
            PeripheralRccKernelClock::Mux(_) => 1,
            PeripheralRccKernelClock::Clock(_) => return None,
        };
        let kind = match &self.of[..3] {
            "DMA" => registers.kind,
            "SPI" if registers.version.starts_with("v3") => "queues",
            "SPI" => "no queues",
            _ => registers.block,
        };
        Some(kind == self.part && bus == self.value[0])
    }

    fn is_in_rcc(
        &self,
        of: impl Fn(
            &'static stm32_metapac::metadata::PeripheralRcc,
        ) -> Option<&'static PeripheralRccRegister>,
    ) -> bool {
        // DMAMUX has the gate of its DMA controller.
        let of_whom = if self.of == "DMAMUX1" {
            "DMA1"
        } else {
            self.of
        };
        let rcc = peripheral(of_whom).and_then(|found| found.rcc.as_ref());
        rcc.and_then(of).and_then(place) == Some(self.value)
    }

    /// `CH1 on PA8`, by that alternate function; where there are no functions, without
    /// remapping.
    fn is_pin(&self) -> bool {
        let (Some(found), Some((signal, pin))) =
            (peripheral(self.of), self.part.split_once(" on "))
        else {
            return false;
        };
        let in_place = found.afio.as_ref().is_none_or(|afio| {
            let mut places = afio.values.iter();
            places.any(|place| place.value == 0 && place.pins.contains(&pin))
        });
        in_place
            && found.pins.iter().any(|at| {
                let function = at.af.map_or(0, u32::from);
                at.pin == pin && at.signal == signal && function == self.value[0]
            })
    }

    /// `RX on DMA1_CH2`; by way of a DMAMUX every channel can be asked.
    fn is_request(&self) -> bool {
        let (Some(found), Some((signal, channel))) =
            (peripheral(self.of), self.part.split_once(" on "))
        else {
            return false;
        };
        found.dma_channels.iter().any(|at| {
            let reaches = at.channel.is_none_or(|at| at == channel);
            // What is wired has no number.
            at.signal == signal && reaches && at.request.unwrap_or(0) == self.value[0]
        })
    }
}

fn peripheral(name: &str) -> Option<&'static Peripheral> {
    METADATA.peripherals.iter().find(|found| found.name == name)
}

/// Sizes of the memories, whose banks add up, and bits of a priority.
fn chip(of: &str) -> Option<u32> {
    let start = match of {
        "flash" => "BANK_1",
        "RAM" => "SRAM",
        _ => return METADATA.nvic_priority_bits.map(u32::from),
    };
    let regions = METADATA.memory.first()?.iter();
    let named = regions.filter(|region| region.name.starts_with(start));
    Some(named.map(|region| region.size).sum())
}

/// The offset in RCC of a register, and the bit of a field in it.
fn place(of: &PeripheralRccRegister) -> Option<[u32; 2]> {
    let rcc: &IR = peripheral("RCC")?.registers.as_ref()?.ir;
    let named = |name: &str, other: &str| name.eq_ignore_ascii_case(other);
    let mut registers = rcc.blocks.first()?.items.iter();
    let register = registers.find(|item| named(item.name, of.register))?;
    let mut sets = rcc.fieldsets.iter();
    let set = sets.find(|set| named(set.name, of.register))?;
    let field = set
        .fields
        .iter()
        .find(|field| named(field.name, of.field))?;
    match &field.bit_offset {
        BitOffset::Regular(at) => Some([register.byte_offset, at.offset]),
        BitOffset::Cursed(_) => None,
    }
}

fn interrupt(name: &str, signal: &str) -> Option<u32> {
    if name == "PVD" {
        let mut all = METADATA.interrupts.iter();
        return Some(all.find(|at| at.name.starts_with(name))?.number);
    }
    let mut signals = peripheral(name)?.interrupts.iter();
    let found = signals.find(|found| found.signal == signal)?;
    let mut all = METADATA.interrupts.iter();
    Some(all.find(|at| at.name == found.interrupt)?.number)
}

fn main() -> ExitCode {
    let (mut compared, mut wrong) = (0, 0);
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        let Some(fact) = Fact::read(&line) else {
            eprintln!("no fact: {line}");
            wrong += 1;
            continue;
        };
        match (fact.is_described(), fact.is_alone) {
            (true, false) => compared += 1,
            (false, true) => {}
            (true, true) => {
                eprintln!("described after all: {line}");
                wrong += 1;
            }
            (false, false) => {
                eprintln!("not as described: {line}");
                wrong += 1;
            }
        }
    }
    println!(
        "{}: {compared} facts as described, {wrong} not",
        METADATA.name
    );
    if compared > 0 && wrong == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
