//! How much stack a program has used: cortex-m-rt fills it with a pattern at the
//! reset, and what was never written still has it.

use crate::chip::Fault;
use crate::memory::Memories;
use crate::program::Program;

/// What cortex-m-rt fills the stack with (its feature `paint-stack`).
const PAINT: u32 = 0xCCCC_CCCC;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stack {
    /// The lowest address.
    end: u32,
    /// Where it begins, to grow down.
    start: u32,
}

impl Stack {
    pub(crate) fn new(program: &Program) -> Result<Self, Fault> {
        Ok(Self {
            end: program.symbol("_stack_end")?,
            start: program.symbol("_stack_start")?,
        })
    }

    pub(crate) fn used(self, memories: &Memories) -> Result<u32, Fault> {
        if memories.word(self.end)? != PAINT {
            let what = "the stack was not painted, or ran over its end";
            return Err(Fault::Program(what.to_owned()));
        }
        for address in (self.end..self.start).step_by(4) {
            if memories.word(address)? != PAINT {
                return Ok(self.start - address);
            }
        }
        Ok(0)
    }
}
