//! The core: rsemu's ARMv7-M, and for a Cortex-M0+ what that must not execute.
//!
//! A Cortex-M3 without the instructions of DSP and FPU is rsemu's own. ARMv6-M, which rsemu
//! does not have, is ARMv7-M in which every instruction that it lacks, and every access
//! that is not aligned, is a hard fault: what runs here runs on the chip.

mod count_down;
#[cfg(test)]
mod tests;
mod v6m;

pub(crate) use count_down::{BRANCH_CYCLES, ROUND_CYCLES, ROUND_INSTRUCTIONS};

use std::ops::Deref;
use std::sync::Arc;

use rsemu::core::space::AddressSpace;
use rsemu::cpu::arm::v7m::sys::Exception;
use rsemu::cpu::arm::v7m::{ArmV7m, Config};

use crate::chip::{CoreKind, Fault, Model, Ps};
use crate::memory::{FLASH, Memories};

/// The exception number in xPSR.
pub(crate) const EXCEPTION: u32 = 0x1FF;
/// What is left of an IT block, in xPSR.
pub(crate) const IT_BLOCK: u32 = 0x3F << 10 | 3 << 25;
const FRAME_XPSR: u32 = 28;
/// CPUID of a Cortex-M0+, r0p1.
const CPUID_M0_PLUS: u32 = 0x410C_C601;
/// CCR.UNALIGN_TRP, which is always set on ARMv6-M.
const UNALIGN_TRP: u32 = 1 << 3;
/// The priority of a hard fault: within it, or above it, there is only the lock-up.
const HARD_FAULT_PRIORITY: i32 = -1;

/// What an ARMv6-M executes.
#[derive(Debug)]
struct Known {
    /// Of each half-word of the flash, whether it begins an instruction that there is.
    flash: Vec<bool>,
    memories: Memories,
}

impl Known {
    fn new(memories: &Memories) -> Self {
        let memories = memories.clone();
        let flash = (FLASH..FLASH + memories.flash_len()).step_by(2);
        let flash = flash.map(|pc| is_known_at(pc, &memories)).collect();
        Self { flash, memories }
    }

    fn has(&self, pc: u32) -> bool {
        let place = pc.wrapping_sub(FLASH) as usize / 2;
        let known = self.flash.get(place).copied();
        known.unwrap_or_else(|| is_known_at(pc, &self.memories))
    }
}

/// Whether there is an instruction at `pc`. Where there is no memory the core tells.
fn is_known_at(pc: u32, memories: &Memories) -> bool {
    let second = || half(pc.wrapping_add(2), memories).unwrap_or(0);
    half(pc, memories).is_none_or(|first| v6m::is_known(first, second()))
}

fn half(at: u32, memories: &Memories) -> Option<u16> {
    let [low, high] = [memories.get(at), memories.get(at.wrapping_add(1))];
    Some(u16::from_le_bytes([low?, high?]))
}

#[derive(Debug)]
pub(crate) struct Core {
    inner: ArmV7m,
    known: Option<Known>,
    /// It has met an instruction that there is not where no fault can be taken.
    stuck: bool,
    /// Time that SysTick has not counted yet: less than a cycle.
    rest: Ps,
}

impl Core {
    pub(crate) fn new(model: &Model, memories: &Memories, space: AddressSpace) -> Self {
        let mut config = match model.core {
            CoreKind::M4F => Config::CORTEX_M4F,
            CoreKind::M3 | CoreKind::M0Plus => Config::CORTEX_M3,
        };
        let is_v6m = model.core == CoreKind::M0Plus;
        if is_v6m {
            config.cpuid = CPUID_M0_PLUS;
            config.bit_band = false;
        }
        let config = config.with_reset_vtor(FLASH);
        let inner = ArmV7m::new(config.with_priority_bits(model.priority_bits));
        inner.attach_space(Arc::new(space));
        if is_v6m {
            inner.with_sys(|sys| sys.ccr |= UNALIGN_TRP);
        }
        Self {
            inner,
            known: is_v6m.then(|| Known::new(memories)),
            stuck: false,
            rest: 0,
        }
    }

    /// Executes the instruction at `pc`, where the core is, or enters an exception; the cycles that
    /// it took.
    pub(crate) fn step_at(&mut self, pc: u32) -> u64 {
        if let Some(known) = &self.known
            && !known.has(pc)
            && !self.inner.is_asleep()
        {
            self.stuck |= self.inner.execution_priority() <= HARD_FAULT_PRIORITY;
            self.inner
                .with_sys(|sys| sys.set_pending(Exception::HARD_FAULT, true));
        }
        self.inner.step()
    }

    pub(crate) fn raise_nmi(&self) {
        self.inner
            .with_sys(|sys| sys.set_pending(Exception::NMI, true));
    }

    pub(crate) fn has_locked_up(&self) -> bool {
        self.stuck || self.inner.is_locked_up()
    }

    /// Has an exception that was entered within an IT block return into it: rsemu 0.0.7 leaves what
    /// is left of the `block` out of the frame, and runs the rest of it without its condition.
    /// `interrupted` is the exception before; one that takes its turn after that has no frame of
    /// its own.
    pub(crate) fn keep_block(
        &self,
        block: u32,
        interrupted: u32,
        memories: &Memories,
    ) -> Result<(), Fault> {
        let at = self.inner.msp().wrapping_add(FRAME_XPSR);
        let kept = memories.word(at)?;
        if kept & EXCEPTION != interrupted {
            return Ok(());
        }
        memories.write(at, &(kept | block).to_le_bytes())
    }

    /// Lets SysTick count while the core executes nothing for `time`.
    pub(crate) fn pass(&mut self, time: Ps, cycle: Ps) {
        self.rest += time;
        let cycles = self.rest / cycle;
        self.rest %= cycle;
        self.inner.with_sys(|sys| sys.tick_systick(cycles));
    }

    /// Fails where the program relies on a part of the core that is not modelled.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        const ENABLE: u32 = 1 << 0;
        const CLKSOURCE: u32 = 1 << 2;
        let control = self.inner.with_sys(|sys| sys.syst_csr);
        if control & (ENABLE | CLKSOURCE) == ENABLE {
            return Err(Fault::Misused {
                peripheral: "SysTick",
                what: "it counts a clock that is not the core's",
            });
        }
        Ok(())
    }
}

impl Deref for Core {
    type Target = ArmV7m;

    fn deref(&self) -> &ArmV7m {
        &self.inner
    }
}
