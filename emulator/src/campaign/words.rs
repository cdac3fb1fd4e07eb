//! The words of a board's RAM that a program uses, by the names of its variables.

use crate::chip::Fault;
use crate::debug_info::DebugInfo;
use crate::program::Program;

pub(super) const STACK: &str = "stack";
/// Bytes at the top of the stack, which a tick with a decision uses.
const STACK_BYTES: u32 = 1024;
/// Rings of the log and of packets are written by the program and read by a probe only.
const RINGS: [&str; 3] = ["_SEGGER_RTT", "LOG_BYTES", "PACKETS"];

#[derive(Debug)]
pub(super) struct Words {
    words: Vec<(u32, String)>,
}

impl Words {
    pub(super) fn new(program: &Program) -> Result<Self, Fault> {
        let info = DebugInfo::new(program)?;
        let mut words = Vec::new();
        for leaf in info.leaves()? {
            if RINGS.iter().any(|ring| leaf.path.starts_with(ring)) {
                continue;
            }
            let first = leaf.address / 4;
            let last = (leaf.address + leaf.size.max(1) - 1) / 4;
            let name = leaf.path.clone();
            words.extend((first..=last).map(|word| (4 * word, name.clone())));
        }
        let top = program.symbol("_stack_start")?;
        let stack = (top - STACK_BYTES..top).step_by(4);
        words.extend(stack.map(|address| (address, STACK.to_owned())));
        words.sort();
        words.dedup_by_key(|(address, _)| *address);
        if words.is_empty() {
            return Err(Fault::Program("it has no variables".to_owned()));
        }
        Ok(Self { words })
    }

    pub(super) const fn len(&self) -> usize {
        self.words.len()
    }

    /// Counts from 0, and after the last from the first again.
    pub(super) fn pick(&self, n: u32) -> (u32, &str) {
        let n = n as usize % self.words.len();
        self.words
            .get(n)
            .map_or((0, ""), |(address, name)| (*address, name))
    }
}
