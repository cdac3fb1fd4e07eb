//! What a core must not execute, seen to trap.

mod arithmetic;
mod copying;

use rsemu::cpu::arm::v7m::sys::{DEMCR_TRCENA, DWT_CTRL_CYCCNTENA};

use super::{Core, EXCEPTION, IT_BLOCK, ROUND_CYCLES, ROUND_INSTRUCTIONS, v6m};
use crate::chip::{Chip, CoreKind, MODELS};
use crate::memory::{FLASH, Memories, RAM, Shared};

const CODE: u32 = FLASH + 0x100;
const HANDLER: u32 = FLASH + 0x80;
const HARD_FAULT: u32 = 3;

impl Core {
    fn step(&mut self) -> u64 {
        self.step_at(self.pc())
    }
}

/// A core of that kind whose flash begins with a vector table, a handler of hard faults that
/// loops, one of the NMI that returns, and the code.
fn core(kind: CoreKind, code: &[u16]) -> Core {
    core_in_memory(kind, code).0
}

fn core_in_memory(kind: CoreKind, code: &[u16]) -> (Core, Memories) {
    let mut words = vec![0_u32; 0x40];
    words[0] = RAM + 0x800;
    words[1] = CODE | 1;
    words[2] = (HANDLER + 4) | 1;
    words[3] = HANDLER | 1;
    words[0x20] = 0xE7FE_E7FE;
    words[0x21] = 0x4770_4770;
    let mut flash: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    flash.extend(code.iter().flat_map(|half| half.to_le_bytes()));
    let model = MODELS.iter().find(|model| model.core == kind).unwrap();
    let segments = std::iter::once((FLASH, flash.as_slice()));
    let memories = Memories::flashed(segments, 0x200, 0x1000).unwrap();
    let shared = Shared::new(Chip::new(model).unwrap());
    let space = memories.space(&shared).unwrap();
    let mut core = Core::new(model, &memories, space);
    core.step();
    (core, memories)
}

/// Whether the first instruction traps, with its own address for the return.
fn traps(core: &mut Core, steps: usize) -> bool {
    for _ in 0..steps {
        core.step();
    }
    let in_handler = core.xpsr() & 0x1FF == HARD_FAULT && !core.has_locked_up();
    in_handler && core.pc() & !3 == HANDLER
}

#[test]
fn every_opcode_of_16_bits_that_v6m_lacks_traps() {
    let mut lacking = 0;
    for first in (0..0xE800).filter(|&first| !v6m::is_known(first, 0)) {
        lacking += 1;
        let mut core = core(CoreKind::M0Plus, &[first, 0xBF00]);
        assert!(traps(&mut core, 1), "{first:#06x}");
    }
    // By group: CBZ and CBNZ 1024, IT 240, other CPS and SETEND's place 254, the unused
    // parts of 0xB6, 0xB7, 0xB8 and 0xBA, BX and BLX with low bits 224, UDF 256.
    assert_eq!(lacking, 1024 + 240 + 254 + 512 + 64 + 224 + 256);
}

#[test]
fn every_opcode_of_32_bits_that_v6m_lacks_traps() {
    // Of every first half-word some second ones, among them those of the six that are known.
    let seconds = [
        0x0000, 0x0F80, 0x1A20, 0x2100, 0x8000, 0x8400, 0x8810, 0x8811, 0x8F2F, 0x8F4F, 0x8F5F,
        0x8F6F, 0x9000, 0xA000, 0xC000, 0xE000, 0xF8D1, 0xFFFF,
    ];
    let known = |first: u16, second: u16| match first {
        0xF000..=0xF7FF if second & 0xD000 == 0xD000 => true,
        0xF3BF => matches!(second, 0x8F4F | 0x8F5F | 0x8F6F),
        0xF380..=0xF38F => second == 0x8810,
        0xF3EF => matches!(second, 0x8000 | 0x8400 | 0x8810),
        _ => false,
    };
    for first in 0xE800..=0xFFFF {
        for second in seconds {
            let found = v6m::is_known(first, second);
            assert_eq!(found, known(first, second), "{first:#06x} {second:#06x}");
        }
        let mut core = core(CoreKind::M0Plus, &[first, 0xF8D1, 0xBF00]);
        let lacking = !known(first, 0xF8D1);
        assert_eq!(traps(&mut core, 1), lacking, "{first:#06x}");
    }
}

#[test]
fn no_access_of_v6m_but_an_aligned_one() {
    // ldr, str, ldrh, strh, ldrsh of r1 at r0 or r0 + r2; ldm and stm at r0.
    for (what, code, bytes) in [
        ("ldr", 0x6801, 4),
        ("str", 0x6001, 4),
        ("ldrh", 0x8801, 2),
        ("strh", 0x8001, 2),
        ("ldrsh", 0x5E81, 2),
        ("ldm", 0xC802, 4),
        ("stm", 0xC002, 4),
    ] {
        for offset in 0..4 {
            let mut core = core(CoreKind::M0Plus, &[code, 0xBF00]);
            core.set_reg(0, RAM + offset);
            core.set_reg(2, 0);
            let aligned = offset % bytes == 0;
            // The access faults; the next step enters the handler.
            assert_eq!(traps(&mut core, 2), !aligned, "{what} at {offset}");
        }
    }
}

#[test]
fn a_cortex_m3_has_neither_dsp_nor_fpu() {
    for (what, code) in [
        ("qadd", [0xFA82, 0xF381]),
        ("sadd16", [0xFA92, 0xF301]),
        ("smulbb", [0xFB11, 0xF302]),
        ("smmulr", [0xFB51, 0xF312]),
        ("smlad", [0xFB21, 0x3302]),
        ("pkhbt", [0xEAC1, 0x0302]),
        ("uxtab", [0xFA51, 0xF382]),
        ("vadd.f32", [0xEE30, 0x1A20]),
        ("vldr", [0xED90, 0x0A00]),
        ("vmov", [0xEE10, 0x0A10]),
    ] {
        let mut m3 = core(CoreKind::M3, &code);
        m3.set_reg(0, RAM);
        assert!(traps(&mut m3, 2), "{what}");
    }
    // What it has: smull, sdiv, an access that is not aligned.
    for code in [[0xFB81, 0x1302], [0xFB91, 0xF3F2], [0xF8D0, 0x1001]] {
        let mut m3 = core(CoreKind::M3, &code);
        m3.set_reg(0, RAM);
        m3.set_reg(2, 1);
        assert!(!traps(&mut m3, 1), "{code:x?}");
        assert_eq!(m3.pc(), CODE + 4);
    }
}

#[test]
fn within_a_hard_fault_there_is_only_the_lock_up() {
    let mut core = core(CoreKind::M0Plus, &[0xBF08, 0xBF00]);
    core.step();
    assert!(!core.has_locked_up());
    core.set_pc(CODE);
    core.step();
    assert!(core.has_locked_up());
}

#[test]
fn an_interrupt_within_an_it_block_returns_into_it() {
    // cmp r0, #1; ite eq; moveq r1, #5; movne r2, #6
    let code = [0x2801, 0xBF0C, 0x2105, 0x2206, 0xBF00];
    for kind in [CoreKind::M3, CoreKind::M4F] {
        for before in 0..=4 {
            let (mut core, memories) = core_in_memory(kind, &code);
            for register in 0..3 {
                core.set_reg(register, 0);
            }
            let mut block = 0;
            for step in 0..7 {
                if step == before {
                    core.raise_nmi();
                }
                core.step();
                let xpsr = core.xpsr();
                if step == before {
                    assert_eq!(xpsr & EXCEPTION, 2, "the NMI is taken");
                    core.keep_block(block, 0, &memories).unwrap();
                }
                block = xpsr & IT_BLOCK;
            }
            assert_eq!((core.reg(1), core.reg(2)), (0, 6), "{kind:?}, {before}");
        }
    }
}

/// A core whose counters count, after the first round of a loop that counts R3 down from `from`.
fn counting_down(kind: CoreKind, code: &[u16], from: u32) -> (Core, Memories) {
    let (mut core, memories) = core_in_memory(kind, code);
    core.set_reg(3, from);
    core.with_sys(|sys| {
        sys.demcr = DEMCR_TRCENA;
        sys.dwt_ctrl = DWT_CTRL_CYCCNTENA;
        (sys.syst_csr, sys.syst_rvr) = (5, 13);
    });
    core.step();
    core.step();
    (core, memories)
}

/// subs r3, #1; bne back
const LOOP: [u16; 2] = [0x3B01, 0xD1FD];

#[test]
fn rounds_at_once_are_as_one_after_the_other() {
    let seen = |core: &Core| {
        let counters = core.with_sys(|sys| (sys.dwt_cyccnt, sys.syst_cvr, sys.syst_csr));
        (core.regs(), counters)
    };
    for kind in [CoreKind::M0Plus, CoreKind::M3, CoreKind::M4F] {
        for (most, made) in [(0, 0), (1, 1), (7, 7), (98, 98), (99, 98), (u64::MAX, 98)] {
            let (mut core, memories) = counting_down(kind, &LOOP, 100);
            assert_eq!(core.count_down(most, &memories), made);
            let (mut stepped, _) = counting_down(kind, &LOOP, 100);
            let cycles: u64 = (0..ROUND_INSTRUCTIONS * made).map(|_| stepped.step()).sum();
            assert_eq!(cycles, ROUND_CYCLES * made);
            assert_eq!(seen(&core), seen(&stepped), "{kind:?}, {made}");
        }
    }
}

#[test]
fn no_rounds_at_once_of_what_is_more_than_counting() {
    // subs r3, #2; subs r4, #1 with a counter that is not above zero; bne further back
    for code in [[0x3B02, 0xD1FD], [0x3C01, 0xD1FD], [0x3B01, 0xD1FC]] {
        let (mut core, memories) = counting_down(CoreKind::M4F, &code, 100);
        core.set_pc(CODE);
        assert_eq!(core.count_down(9, &memories), 0, "{code:x?}");
    }
    let (mut core, memories) = counting_down(CoreKind::M4F, &LOOP, 100);
    core.with_sys(|sys| sys.syst_csr |= 2);
    assert_eq!(core.count_down(9, &memories), 0, "SysTick interrupts");
    // From here on the flags are others.
    let (mut core, memories) = counting_down(CoreKind::M4F, &LOOP, 0x8000_0001);
    assert_eq!(core.count_down(9, &memories), 0, "it is negative");
}
