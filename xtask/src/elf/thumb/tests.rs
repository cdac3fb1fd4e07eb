//! Instructions as assembled by LLVM for thumbv7em and thumbv6m at 0x0800_0000.

use super::{Step, steps};

const AT: u64 = 0x0800_0000;

fn bytes(halves: &[u16]) -> Vec<u8> {
    halves.iter().flat_map(|half| half.to_le_bytes()).collect()
}

/// The steps of code without constants.
fn found(halves: &[u16]) -> Vec<Step> {
    steps(&bytes(halves), AT, |_| true)
}

#[test]
fn what_moves_the_stack_is_read() {
    let cases: [(&[u16], &[Step]); 10] = [
        (&[0xB5F0], &[Step::Push(20)]),                   // push {r4-r7, lr}
        (&[0xB082], &[Step::Push(8)]),                    // sub sp, #8
        (&[0xE92D, 0x0F00], &[Step::Push(16)]),           // push.w {r8-r11}
        (&[0xF84D, 0xBD04], &[Step::Push(4)]),            // str r11, [sp, #-4]!
        (&[0xED2D, 0x8B04], &[Step::Push(16)]),           // vpush {d8, d9}
        (&[0xF5AD, 0x7D00], &[Step::Push(512)]),          // sub.w sp, sp, #512
        (&[0xF2AD, 0x4D04], &[Step::Push(1028)]),         // subw sp, sp, #1028
        (&[0x4798], &[Step::Open]),                       // blx r3
        (&[0x44A5], &[Step::Open]),                       // add sp, r4
        (&[0xB002, 0xBDF0, 0x4770, 0xF84D, 0xB004], &[]), // add sp; pop; bx lr; str [sp, r4]
    ];
    for (halves, expected) in cases {
        assert_eq!(found(halves), expected, "{halves:04x?}");
    }
}

#[test]
fn a_large_frame_is_read_from_its_constant() {
    // ldr r6, [pc, #0]; add sp, r6; the constant.
    let cases: [(u16, [u8; 4], Step); 3] = [
        (0x44B5, [0x14, 0xF8, 0xFF, 0xFF], Step::Push(2028)),
        // Upwards, and another register.
        (0x44B5, [0x14, 0x08, 0, 0], Step::Open),
        (0x44AD, [0x14, 0xF8, 0xFF, 0xFF], Step::Open),
    ];
    for (add, constant, expected) in cases {
        let bytes = [&bytes(&[0x4E00, add])[..], &constant].concat();
        let found = steps(&bytes, AT, |at| at < AT + 4);
        assert_eq!(found, [expected], "{add:04x} {constant:02x?}");
    }
}

#[test]
fn a_call_by_a_constant_is_a_call_of_that_function() {
    const LOAD: u16 = 0x4C01; // ldr r4, [pc, #4]
    const CALL: u16 = 0x47A0; // blx r4
    let open = Step::Open;
    let called = Step::Go(0x0800_0122);
    let cases: [(u16, u16, u8, Step); 7] = [
        (LOAD, 0x2001, 0x23, called),   // movs r0, #1
        (LOAD, 0x6020, 0x23, called),   // str r0, [r4]
        (0x4801, 0x4604, 0x23, called), // ldr r0, [pc, #4]; mov r4, r0
        (LOAD, 0x4604, 0x23, open),     // mov r4, r0
        (LOAD, 0x6804, 0x23, open),     // ldr r4, [r0]
        (0x4D01, 0x2001, 0x23, open),   // ldr r5, [pc, #4]
        (LOAD, 0x2001, 0x22, open),     // no address of code
    ];
    for (load, between, low, expected) in cases {
        let code = bytes(&[load, between, CALL, 0xBF00]);
        let bytes = [&code[..], &[low, 0x01, 0x00, 0x08]].concat();
        let found = steps(&bytes, AT, |at| at < AT + 8);
        assert_eq!(found, [expected], "{load:04x} {between:04x}");
    }
}

#[test]
fn where_branches_go_is_read() {
    let cases: [(&[u16], u64); 8] = [
        (&[0xF000, 0xF801], 0x0800_0006), // bl +2
        (&[0xF7FF, 0xFFFE], 0x0800_0000), // bl -4
        (&[0xF000, 0xB8FE], 0x0800_0200), // b.w +0x1fc
        (&[0xE7FE], 0x0800_0000),         // b .
        (&[0xD0FE], 0x0800_0000),         // beq .
        (&[0xB101], 0x0800_0004),         // cbz r1, +0
        (&[0xBB00], 0x0800_0044),         // cbnz r0, +0x40
        (&[0xF43F, 0xAFFE], 0x0800_0000), // beq.w .
    ];
    for (halves, expected) in cases {
        assert_eq!(found(halves), [Step::Go(expected)], "{halves:04x?}");
    }
}

#[test]
fn what_goes_anywhere_is_told_from_what_goes_back() {
    let open: [&[u16]; 7] = [
        &[0x4718],         // bx r3
        &[0x4798],         // blx r3
        &[0x46A7],         // mov pc, r4, without a table
        &[0x44AF],         // add pc, r5, the same
        &[0xF8DF, 0xF004], // ldr.w pc, [pc, #4]
        &[0xE891, 0x8001], // ldm r1, {r0, pc}
        &[0xE8D1, 0xF002], // tbb [r1, r2]
    ];
    let back: [&[u16]; 4] = [
        &[0x4770],         // bx lr
        &[0xBD10],         // pop {r4, pc}
        &[0xF85D, 0xFB04], // ldr pc, [sp], #4
        &[0xE8BD, 0x8FF0], // pop.w {r4-r11, pc}
    ];
    for halves in open {
        assert_eq!(found(halves), [Step::Open], "{halves:04x?}");
    }
    for halves in back {
        assert_eq!(found(halves), [], "{halves:04x?}");
    }
    assert_eq!(found(&[0xDE00]), [Step::Trap], "udf");
    assert_eq!(found(&[0xF7F0, 0xA000]), [Step::Trap], "udf.w");
}

#[test]
fn a_jump_by_a_table_stays_or_is_open() {
    // Code, and the bytes of its table; four more of code follow.
    let cases: [(&[u16], &[u8], bool); 12] = [
        (&[0xE8DF, 0xF00E], &[2, 1], true),    // tbb [pc, lr]
        (&[0xE8DF, 0xF00E], &[2, 200], false), // beyond the end
        // ldr r0, [pc, #4] loads what stands behind the table.
        (
            &[0x4801, 0xBF00, 0xE8DF, 0xF00E],
            &[1, 1, 0, 0, 200, 0, 0, 32],
            false,
        ),
        (
            &[0x4802, 0xBF00, 0xE8DF, 0xF00E],
            &[1, 1, 0, 0, 200, 0, 0, 32],
            true,
        ),
        (&[0xE8DF, 0xF016], &[2, 0, 1, 0], true), // tbh [pc, r6, lsl #1]
        (&[0xE8DF, 0xF016], &[2, 0, 0, 1], false), // beyond the end
        // ldr r0; adr.w r1 or r2; tbh [r1, r5, lsl #1]; the table stands behind a literal.
        (
            &[0x4802, 0xBF00, 0xF20F, 0x0108, 0xE8D1, 0xF015],
            &[200, 0, 0, 32, 4, 0, 5, 0],
            true,
        ),
        (
            &[0x4802, 0xBF00, 0xF20F, 0x0208, 0xE8D1, 0xF015],
            &[200, 0, 0, 32, 4, 0, 5, 0],
            false,
        ),
        (&[0x792D, 0x006D, 0x44AF], &[0, 1], true), // ldrb, lsls, add pc, r5
        // adr r1; ldrh r0, [r1, r0]; lsls; add pc, r0; the table stands behind a literal.
        (
            &[0x4802, 0xA102, 0x5A08, 0x0040, 0x4487, 0x46C0],
            &[200, 0, 0, 32, 4, 0, 0xC0, 0x46],
            true,
        ),
        (&[0xBF00, 0xBF00, 0x46A7], &[1, 0, 0, 8, 5, 0, 0, 8], true), // mov pc, r4
        (&[0xBF00, 0xBF00, 0x46A7], &[1, 0, 0, 8, 5, 0, 0, 9], false), // far away
    ];
    for (code, table, stays) in cases {
        let code = bytes(code);
        let data = AT + code.len() as u64..AT + (code.len() + table.len()) as u64;
        let bytes = [&code, table, &[0x70, 0x47, 0x70, 0x47]].concat();
        let found = steps(&bytes, AT, |at| !data.contains(&at));
        assert_eq!(found.is_empty(), stays, "{bytes:02x?}: {found:?}");
    }
}

#[test]
fn a_jump_to_one_of_the_branches_behind_it_goes_where_they_go() {
    // adr.w r4, #8; add.w r4, r4, r0, lsl #2; mov pc, r4; b.w .; b.w +0x1fc.
    let code = [
        0xF20F, 0x0408, 0xEB04, 0x0480, 0x46A7, 0xF7FF, 0xBFFE, 0xF000, 0xB8FE,
    ];
    assert_eq!(found(&code), [0x0800_000A, 0x0800_020E].map(Step::Go));
}

#[test]
fn constants_are_no_instructions() {
    let bytes = [0x30, 0xB5, 0x30, 0xB5];
    assert_eq!(steps(&bytes, 0, |at| at == 0), [Step::Push(12)]);
}
