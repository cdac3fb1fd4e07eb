//! The words of a board's RAM that a program uses, by the names of its variables.

use crate::chip::Fault;
use crate::debug_info::DebugInfo;
use crate::program::Program;

/// Bytes at the top of the stack, where idle's frames lie between two ticks.
const STACK: u32 = 128;
/// The log's buffer is written by the program and read by a probe only.
const LOG: [&str; 2] = ["_SEGGER_RTT", "BUFFER"];

/// The words of a program's static RAM and of its stack.
#[derive(Debug)]
pub(super) struct Words {
    words: Vec<(u32, String)>,
}

impl Words {
    /// # Errors
    /// [`Fault::Program`] for a program without debug information.
    pub(super) fn new(program: &Program) -> Result<Self, Fault> {
        let info = DebugInfo::new(program)?;
        let mut words = Vec::new();
        for leaf in info.leaves()? {
            if LOG.iter().any(|log| leaf.path.starts_with(log)) {
                continue;
            }
            let first = leaf.address / 4;
            let last = (leaf.address + leaf.size.max(1) - 1) / 4;
            words.extend((first..=last).map(|word| (4 * word, leaf.path.clone())));
        }
        let top = program.symbol("_stack_start")?;
        let stack = (top - STACK..top).step_by(4);
        words.extend(stack.map(|address| (address, "stack".to_owned())));
        words.sort();
        words.dedup_by_key(|(address, _)| *address);
        if words.is_empty() {
            return Err(Fault::Program("it has no variables".to_owned()));
        }
        Ok(Self { words })
    }

    /// The address and name of a word.
    pub(super) fn pick(&self, detail: u64) -> (u32, &str) {
        let n = (detail % self.words.len() as u64) as usize;
        self.words
            .get(n)
            .map_or((0, ""), |(address, name)| (*address, name))
    }
}
