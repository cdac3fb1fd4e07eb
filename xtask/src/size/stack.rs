//! A bound for the stack of a program, from its instructions: what each
//! function takes, which it calls, and the deepest way from the reset plus the
//! deepest interrupt. All interrupts of the firmware have one priority, so one
//! is on the stack at a time. Faults are apart: they end in a reset.
//!
//! Measured depths, by painting, are at most this.

use std::path::Path;

use crate::elf::calls::Calls;
use crate::firmware::Board;
use crate::run::Fault;

/// What the core itself puts on the stack at an interrupt: eight words; with an
/// FPU eighteen more; and one for alignment.
const EXCEPTION: u64 = 9 * 4;
const EXCEPTION_FPU: u64 = EXCEPTION + 18 * 4;

/// Functions that no way comes back from: a panic or another fault.
const FAULTS: [&str; 3] = ["core::panicking::", "rust_begin_unwind", "board::faults::"];

/// The most bytes of stack that `elf` takes on `board`. A recursion and a call through a pointer
/// have no bound, and fail.
pub(super) fn worst(board: Board, elf: &Path) -> Result<u64, Fault> {
    let calls = Calls::of(elf)?;
    let bound = || -> Result<u64, Fault> {
        let mut interrupt = 0;
        for task in calls.tasks()? {
            interrupt = depth(&calls, task, &mut Vec::new())?.max(interrupt);
        }
        let exception = if board.facts.has_fpu {
            EXCEPTION_FPU
        } else {
            EXCEPTION
        };
        Ok(depth(&calls, calls.reset()?, &mut Vec::new())? + exception + interrupt)
    };
    bound().map_err(|fault| format!("{}: {fault}", elf.display()))
}

/// Bytes from the entry of the function at `start` to the deepest of those it
/// calls; `way` is how it was reached.
fn depth(calls: &Calls, start: u64, way: &mut Vec<u64>) -> Result<u64, Fault> {
    let function = calls.at(start)?;
    if FAULTS.iter().any(|fault| function.name.contains(fault)) {
        return Ok(0);
    }
    if way.contains(&start) {
        return Err(format!("{} calls itself", function.name));
    }
    if function.is_open {
        return Err(format!("{} calls through a pointer", function.name));
    }
    way.push(start);
    let mut below = 0;
    for call in &function.calls {
        below = depth(calls, *call, way)?.max(below);
    }
    way.pop();
    Ok(function.own + below)
}
