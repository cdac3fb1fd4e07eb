//! What befalls a core in the middle of a tick.

use crate::chip::{Fault, Ps};
use crate::core::Core;
use crate::memory::{Memories, RAM};

/// An instruction of every tick's handler that is neither its first nor its last.
pub(crate) const MIDDLE: u64 = 200;

/// Between flash and RAM.
const NOWHERE: u32 = 0x1800_0000;
const SP: u8 = 13;
/// R0 to R15, and xPSR after them.
pub(crate) const REGISTERS: [&str; 17] = [
    "r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8", "r9", "r10", "r11", "r12", "sp", "lr",
    "pc", "xpsr",
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Upset {
    /// It executes nothing for so long while the peripherals go on: a tick that is too long.
    Held(Ps),
    /// There is no memory where it goes on.
    Astray,
    /// Its stack is used up.
    NoStack,
    /// Bits of a byte of RAM are inverted.
    Ram { address: u32, bits: u8 },
    /// Bits of a register, by its place in [`REGISTERS`], are inverted.
    Core { register: u8, bits: u32 },
}

impl Upset {
    /// Lets it happen now; for how long the core is held.
    pub(crate) fn happen(self, core: &Core, memories: &Memories) -> Result<Ps, Fault> {
        match self {
            Self::Held(time) => return Ok(time),
            Self::Astray => core.set_pc(NOWHERE),
            Self::NoStack => core.set_reg(SP, RAM + 8),
            Self::Ram { address, bits } => memories.flip(address, bits)?,
            Self::Core { register, bits } if register < 16 => {
                core.set_reg(register, core.reg(register) ^ bits);
            }
            Self::Core { bits, .. } => core.set_xpsr(core.xpsr() ^ bits),
        }
        Ok(0)
    }
}

#[derive(Debug, Default)]
pub(crate) struct Planned {
    /// Before which instruction of the next tick's handler, counted from 1.
    next: Option<(u64, Upset)>,
    /// The same, once that tick has begun, by the count of instructions in all ticks.
    now: Option<(u64, Upset)>,
}

impl Planned {
    /// Lets something befall the core before an instruction of the next tick's handler, counted
    /// from 1; if that has fewer, in the tick after it.
    pub(crate) const fn plan(&mut self, instruction: u64, upset: Upset) {
        self.next = Some((instruction, upset));
    }

    /// A tick begins after so many instructions of ticks.
    pub(crate) fn tick_begins(&mut self, spent: u64) {
        if let Some((instruction, upset)) = self.next.take() {
            self.now = Some((spent + instruction, upset));
        }
    }

    /// In the tick that has begun last, if one has, nothing is to happen any more.
    pub(crate) const fn is_none(&self) -> bool {
        self.now.is_none()
    }

    pub(crate) fn due(&mut self, spent: u64) -> Option<Upset> {
        let (_, upset) = self.now.take_if(|(at, _)| *at <= spent)?;
        Some(upset)
    }
}
