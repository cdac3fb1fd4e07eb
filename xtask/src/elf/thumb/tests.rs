//! Instructions as llvm-objdump shows them, from 0x0800_0000 on.

use super::{Code, Instruction, Step};

const AT: u64 = 0x0800_0000;

/// The steps of instructions, and of constants behind them.
fn found(code: &str, constants: &[u8]) -> Vec<Step> {
    let mut instructions = Vec::new();
    let mut at = AT;
    for line in code.split("; ") {
        let (name, operands) = line.split_once(' ').unwrap_or((line, ""));
        let wide = ["b.w", "bl", "tbb", "tbh", "adr.w", "add.w"];
        let bytes = if wide.contains(&name) {
            "f000 f800"
        } else {
            "bf00"
        };
        let line = format!(" {at:x}: {bytes}    \t{name}\t{operands}");
        let read = Instruction::read(&line).unwrap();
        at = read.end;
        instructions.push(read);
    }
    let bytes = [vec![0; (at - AT) as usize], constants.to_vec()].concat();
    let (instructions, bytes) = (&*instructions, &*bytes);
    Code {
        instructions,
        bytes,
        begin: AT,
    }
    .steps()
}

#[test]
fn data_and_headings_are_no_instructions() {
    for line in [
        "",
        "Disassembly of section .text:",
        "080000c0 <__stext>:",
        " 80000f8: 68 18 00 20  \t.word\t0x20001868",
    ] {
        assert!(Instruction::read(line).is_none(), "{line}");
    }
    let line = " 8000098: f00b fdaa    \tbl\t0x800bbf0 <__pre_init>  @ imm = #0xbb54";
    let read = Instruction::read(line).unwrap();
    let (name, operands) = (&*read.name, &*read.operands);
    assert_eq!((read.address, read.end), (0x0800_0098, 0x0800_009C));
    assert_eq!((name, operands), ("bl", "0x800bbf0"));
    assert_eq!(read.refers_to, Some(0x0800_BBF0));
}

#[test]
fn what_moves_the_stack_or_goes_elsewhere_is_read() {
    let go = Some(Step::Go(0x0800_0122));
    for (line, step) in [
        ("push {r4, r5, r6, r7, lr}", Some(Step::Push(20))),
        ("push.w {r8, r9, r10, r11}", Some(Step::Push(16))),
        ("vpush {d8, d9}", Some(Step::Push(16))),
        ("vpush {s16}", Some(Step::Push(4))),
        ("sub sp, #0x8", Some(Step::Push(8))),
        ("sub.w sp, sp, #0x200", Some(Step::Push(512))),
        ("subw sp, sp, #0x404", Some(Step::Push(1028))),
        ("str r11, [sp, #-0x4]!", Some(Step::Push(4))),
        ("strd r0, r1, [sp, #-0x10]!", Some(Step::Push(16))),
        ("add sp, r4", Some(Step::Open)),
        ("sub.w sp, sp, r4", Some(Step::Open)),
        ("add sp, #0x8", None),
        ("sub.w sp, r7, #0x18", None),
        ("mov sp, r7", None),
        ("str r0, [sp, r4]", None),
        ("bl 0x8000122 <f>  @ imm = #0x2", go),
        ("b.w 0x8000122 <f>", go),
        ("beq 0x8000122 <f>", go),
        ("cbnz r0, 0x8000122 <f>", go),
        ("adr r1, #8 <f+0x7f6>", None),
        ("bx r3", Some(Step::Open)),
        ("blx r3", Some(Step::Open)),
        ("ldr.w pc, [pc, #0x4]  @ 0x8000122 <f>", Some(Step::Open)),
        ("ldm r1, {r0, pc}", Some(Step::Open)),
        ("bx lr", None),
        ("pop {r4, pc}", None),
        ("ldr pc, [sp], #4", None),
        ("ldm.w sp!, {r4, pc}", None),
        ("udf #0x0", Some(Step::Trap)),
        ("bkpt #0x0", Some(Step::Trap)),
    ] {
        assert_eq!(found(line, &[]), Vec::from_iter(step), "{line}");
    }
}

#[test]
fn a_large_frame_is_read_from_its_constant() {
    for (add, constant, expected) in [
        ("add sp, r6", -2028_i32, Step::Push(2028)),
        // Upwards, and another register.
        ("add sp, r6", 2028, Step::Open),
        ("add sp, r5", -2028, Step::Open),
    ] {
        let code = format!("ldr r6, [pc, #0x0]  @ 0x8000004 <f+0x4>; {add}");
        let found = found(&code, &constant.to_le_bytes());
        assert_eq!(found, [expected], "{add} {constant}");
    }
}

#[test]
fn a_call_by_a_constant_is_a_call_of_that_function() {
    let called = Step::Go(0x0800_0122);
    for (to, between, low, expected) in [
        ("r4", "movs r0, #0x1", 0x23, called),
        ("r4", "str r0, [r4]", 0x23, called),
        ("r4", "mov r0, r4", 0x23, called),
        ("r4", "cmp r4, #0x0", 0x23, called),
        ("r0", "mov r4, r0", 0x23, called),
        ("r4", "mov r4, r0", 0x23, Step::Open),
        ("r4", "ldr r4, [r0]", 0x23, Step::Open),
        ("r4", "str r0, [r4, #0x4]!", 0x23, Step::Open),
        ("r4", "pop {r4}", 0x23, Step::Open),
        ("r0", "movs r0, #0x1", 0x23, Step::Open),
        // No address of code.
        ("r4", "movs r0, #0x1", 0x22, Step::Open),
    ] {
        let load = format!("ldr {to}, [pc, #0x4]  @ 0x8000008 <f+0x8>");
        let found = found(&format!("{load}; {between}; blx r4; nop"), &[low, 1, 0, 8]);
        assert_eq!(found, [expected], "{to} {between}");
    }
    let lost = "ldr r0, [pc, #0x8]  @ 0x800000a <f+0xa>; bl 0x8000122 <g>; blx r0; nop";
    assert_eq!(found(lost, &[0x23, 1, 0, 8]), [called, Step::Open]);
}

#[test]
fn a_jump_by_a_table_stays_or_is_open() {
    for (code, table, stays) in [
        ("tbb [pc, lr]", &[0, 0][..], true),
        ("tbb [pc, lr]", &[0, 200], false),
        ("tbb [r1, r2]", &[0, 0], false),
        ("tbh [pc, r6, lsl #1]", &[0, 0, 1, 0], true),
        ("tbh [pc, r6, lsl #1]", &[0, 0, 0, 1], false),
        (
            "ldrb r5, [r5]; lsls r5, r5, #0x1; add pc, r5",
            &[0; 4],
            true,
        ),
        (
            "ldr r5, [r5]; lsls r5, r5, #0x1; add pc, r5",
            &[0; 4],
            false,
        ),
        ("nop; nop; mov pc, r4", &[1, 0, 0, 8, 5, 0, 0, 8], true),
        ("nop; nop; mov pc, r4", &[1, 0, 0, 8, 5, 0, 0, 9], false),
        ("mov pc, r4", &[], false),
    ] {
        let found = found(code, table);
        assert_eq!(found.is_empty(), stays, "{code} {table:?}: {found:?}");
    }
    // A constant behind the table, or one that stands in it; the table behind a constant.
    let (behind, before) = ([1, 1, 0, 0, 200, 0, 0, 32], [200, 0, 0, 32, 1, 0, 2, 0]);
    for (constant, code, table, stays) in [
        ("800000c", "nop; tbb [pc, lr]", behind, true),
        ("8000008", "nop; tbb [pc, lr]", behind, false),
        (
            "800000c",
            "nop; adr.w r1, #8; tbh [r1, r5, lsl #1]",
            before,
            true,
        ),
        (
            "800000c",
            "nop; adr.w r2, #8; tbh [r1, r5, lsl #1]",
            before,
            false,
        ),
    ] {
        let load = format!("ldr r0, [pc, #0x8]  @ 0x{constant} <f+0x8>");
        let found = found(&format!("{load}; {code}"), &table);
        assert_eq!(found.is_empty(), stays, "{constant} {code}: {found:?}");
    }
}

#[test]
fn a_jump_to_one_of_the_branches_behind_it_goes_where_they_go() {
    let jump = "adr.w r4, #8; add.w r4, r4, r0, lsl #2; mov pc, r4";
    let code = format!("{jump}; b.w 0x800000a <f+0xa>; b.w 0x800020e <g>");
    assert_eq!(found(&code, &[]), [0x0800_000A, 0x0800_020E].map(Step::Go));
}
