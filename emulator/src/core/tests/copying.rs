//! The copies and fills of memory that `firmware/src/board/memory.rs` has in assembly, as assembled
//! there: against what a PC copies and fills, at all places within a word.

use super::{CODE, HANDLER, core_in_memory};
use crate::chip::CoreKind;
use crate::memory::RAM;

const COPY: [u16; 21] = [
    0x0003, 0x430B, 0x079B, 0xD10A, 0x0793, 0xD003, 0x3A01, 0x5C8B, 0x5483, 0xE7F9, 0x3A04, 0xD307,
    0x588B, 0x5083, 0xE7FA, 0x3A01, 0xD302, 0x5C8B, 0x5483, 0xE7FA, 0x4770,
];
/// To zero from its beginning, to any byte from the second instruction on.
const FILL: [u16; 22] = [
    0x2200, 0x0612, 0x0A13, 0x431A, 0x0C13, 0x431A, 0x0783, 0xD108, 0x078B, 0xD002, 0x3901, 0x5442,
    0xE7FA, 0x3904, 0xD305, 0x5042, 0xE7FB, 0x3901, 0xD301, 0x5442, 0xE7FB, 0x4770,
];

/// What stands in RAM after a call with these arguments, of what stood there before.
fn called(code: &[u16], entry: u32, arguments: [u32; 3], before: &[u8]) -> Vec<u8> {
    let [first, second] = [CoreKind::M0Plus, CoreKind::M4F].map(|kind| {
        let (mut core, memories) = core_in_memory(kind, code);
        memories.write(RAM, before).unwrap();
        for (register, argument) in (0..).zip(arguments) {
            core.set_reg(register, argument);
        }
        core.set_reg(14, HANDLER | 1);
        core.set_pc(entry);
        let steps = (0..1_000).take_while(|_| {
            core.step();
            core.pc() & !1 != HANDLER
        });
        assert!(steps.count() < 1_000);
        let words = (RAM..).step_by(4).take(before.len() / 4);
        let words = words.map(|at| memories.word(at).unwrap());
        words.flat_map(u32::to_le_bytes).collect::<Vec<u8>>()
    });
    assert_eq!(first, second);
    first
}

#[test]
fn memory_is_copied_and_filled_to_the_byte() {
    let before: Vec<u8> = (1..=128).collect();
    for (to, from) in (0..4).flat_map(|to| (0..4).map(move |from| (to, from + 64))) {
        for length in (0..10).chain([31, 32]) {
            let place = to..to + length;
            let mut copied = before.clone();
            copied.copy_within(from..from + length, to);
            let arguments = [RAM + to as u32, RAM + from as u32, length as u32];
            assert_eq!(called(&COPY, CODE, arguments, &before), copied);
            for (entry, byte) in [(CODE, 0), (CODE + 2, 0xA5)] {
                let mut filled = before.clone();
                filled[place.clone()].fill(byte);
                // What is above the byte does not count.
                let arguments = [arguments[0], length as u32, 0x7F00 | u32::from(byte)];
                assert_eq!(called(&FILL, entry, arguments, &before), filled);
            }
        }
    }
}
