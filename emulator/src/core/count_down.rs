//! Loops that do nothing but count a register down, as `cortex_m::asm::delay` has them: four fifths
//! of the instructions of a start. Rounds of one that the core is in are made at once.

use rsemu::cpu::arm::v7m::Regs;

use super::{Core, IT_BLOCK, half};
use crate::memory::Memories;

/// Cycles of a branch that is taken.
pub(crate) const BRANCH_CYCLES: u64 = 3;
/// Cycles and instructions of a round.
pub(crate) const ROUND_CYCLES: u64 = 1 + BRANCH_CYCLES;
pub(crate) const ROUND_INSTRUCTIONS: u64 = 2;

/// SUBS of one from a register of the first eight, which is in its bits from [`COUNTER`] on.
const SUBS_ONE: u16 = 0x3801;
const COUNTER: u32 = 8;
/// BNE back to the instruction before.
const BNE_BACK: u16 = 0xD1FD;

/// The flags in xPSR, and what they are after each round but the last: nothing is borrowed.
const FLAGS: u32 = 0xF << 28;
const CARRY: u32 = 1 << 29;
/// SysTick interrupts.
const TICKINT: u32 = 1 << 1;

/// The register that a loop at `pc` counts down.
fn counter(pc: u32, memories: &Memories) -> Option<u8> {
    let [first, second] = [half(pc, memories)?, half(pc.wrapping_add(2), memories)?];
    let counter = (first >> COUNTER) & 7;
    let is_loop = first == SUBS_ONE | counter << COUNTER && second == BNE_BACK;
    is_loop.then_some(counter as u8)
}

impl Core {
    /// Makes at most so many rounds of a loop that counts down and has just branched back, but
    /// not its last, and says how many. The core is then as if it had stepped through them, with
    /// no interrupt meanwhile.
    pub(crate) fn count_down(&mut self, most: u64, memories: &Memories) -> u64 {
        let Regs { r, xpsr, .. } = self.inner.regs();
        let Some(counter) = counter(r[15], memories) else {
            return 0;
        };
        let left = r[usize::from(counter)];
        let is_under_way = xpsr & (FLAGS | IT_BLOCK) == CARRY && left.cast_signed() > 0;
        if !is_under_way || self.inner.with_sys(|sys| sys.syst_csr & TICKINT != 0) {
            return 0;
        }
        let rounds = most.min(u64::from(left - 1));
        self.inner.set_reg(counter, left - rounds as u32);
        self.inner.with_sys(|sys| {
            sys.tick_cyccnt(rounds * ROUND_CYCLES);
            sys.tick_systick(rounds * ROUND_CYCLES);
        });
        rounds
    }
}
