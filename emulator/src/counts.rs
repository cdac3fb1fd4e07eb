//! The instructions of single kernels: runs the program `xtask/count`, which calls each.
//!
//! Counted are the call, the body and the return; a step of the core is an instruction.

use std::fmt::Write as _;
use std::path::Path;

use host_sim::Error;

use crate::chip::{Chip, Fault};
use crate::core::{Core, EXCEPTION};
use crate::memory::{Memories, Shared};
use crate::meter::Tally;
use crate::program::Program;
use crate::registers::model;

/// Bytes of flash and RAM: the program's own memory map, more than a chip has.
const FLASH_LEN: u32 = 1 << 20;
const RAM_LEN: u32 = 1 << 18;
/// An address of code names the instruction set in its lowest bit.
const THUMB: u32 = 1;

/// In a call the core is asked after so many instructions whether it has taken an exception.
const CHECKED: u64 = 10_000;

struct Kernel {
    name: String,
    body: u32,
    calls: Tally,
}

impl Kernel {
    fn read(at: u32, memories: &Memories) -> Result<Self, Fault> {
        let words = memories.bytes_at(at, 20)?;
        let mut words = words.as_chunks().0.iter().copied().map(u32::from_le_bytes);
        let mut word = || words.next().unwrap_or_default();
        let [name, name_len, format, format_len, body] = [(); 5].map(|()| word());
        let text = |at, length: u32| memories.bytes_at(at, length as usize);
        let name = [text(name, name_len)?, text(format, format_len)?].join(&b',');
        Ok(Self {
            name: String::from_utf8_lossy(&name).into_owned(),
            body: body & !THUMB,
            calls: Tally::default(),
        })
    }
}

/// Runs `program` on the core of `board`; gives `kernel,format,mean,worst`, a line a kernel.
pub(crate) fn count(program: &Path, board: &str) -> Result<String, Error> {
    let model = model(board)?;
    let program = Program::load(program)?;
    let announcement = program.symbol("count_calls")? & !THUMB;
    let memories = Memories::flashed(program.segments(), FLASH_LEN, RAM_LEN)?;
    let shared = Shared::new(Chip::new(model)?);
    let mut core = Core::new(model, &memories, memories.space(&shared)?);
    let mut kernels: Vec<Kernel> = Vec::new();
    while !core.is_asleep() {
        let pc = core.pc();
        if pc == announcement {
            kernels.push(Kernel::read(core.reg(0), &memories)?);
        } else if let Some(kernel) = kernels.last_mut()
            && kernel.body == pc
        {
            kernel.calls.add(call(&mut core)?);
            continue;
        }
        core.step_at(pc);
        without_exception(&core)?;
    }
    let mut lines = String::new();
    for Kernel { name, calls, .. } in &kernels {
        // Writing to a string does not fail.
        let _ = writeln!(lines, "{name},{:.3},{}", calls.mean(), calls.worst);
    }
    Ok(lines.trim_end().to_owned())
}

/// An exception never ends: it is a mistake in the program.
fn without_exception(core: &Core) -> Result<(), Fault> {
    if core.xpsr() & EXCEPTION == 0 {
        return Ok(());
    }
    let at = core.pc();
    Err(Fault::Program(format!("it takes an exception, {at:#010x}")))
}

/// The instructions of a call whose body begins here, the call itself among them.
fn call(core: &mut Core) -> Result<u64, Fault> {
    let end = core.reg(14) & !THUMB;
    let mut instructions = 1;
    loop {
        let pc = core.pc();
        if pc == end {
            return Ok(instructions);
        }
        core.step_at(pc);
        instructions += 1;
        if instructions % CHECKED == 0 {
            without_exception(core)?;
        }
    }
}
