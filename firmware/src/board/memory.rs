//! Copies and fills of memory, which compiled code calls by these names. Those that come with the
//! compiler are for speed and take 1,150 to 1,400 bytes more, a twentieth of the smallest program.

#[allow(unsafe_code, reason = "compiled code calls them by name")]
// From the end, in words where the places are of whole words. They change what a call may: r0 to r3
// and the flags. What this is assembled to is tried by emulator/src/core/tests/copying.rs.
mod names {
    core::arch::global_asm!(
        ".pushsection .text.memory, \"ax\", %progbits",
        ".macro names of",
        ".irp name, __aeabi_\\of, __aeabi_\\of\\()4, __aeabi_\\of\\()8",
        ".global \\name; .type \\name, %function; .size \\name, 3f - \\name + 2; \\name:",
        ".endr",
        ".endm",
        "names memcpy",
        "movs r3, r0; orrs r3, r1; lsls r3, r3, #30; bne 4f",
        "1: lsls r3, r2, #30; beq 2f",
        "subs r2, #1; ldrb r3, [r1, r2]; strb r3, [r0, r2]; b 1b",
        "2: subs r2, #4; bcc 3f; ldr r3, [r1, r2]; str r3, [r0, r2]; b 2b",
        "4: subs r2, #1; bcc 3f; ldrb r3, [r1, r2]; strb r3, [r0, r2]; b 4b",
        "3: bx lr",
        "names memclr",
        "movs r2, #0",
        "names memset",
        "lsls r2, r2, #24; lsrs r3, r2, #8; orrs r2, r3; lsrs r3, r2, #16; orrs r2, r3",
        "lsls r3, r0, #30; bne 4f",
        "1: lsls r3, r1, #30; beq 2f; subs r1, #1; strb r2, [r0, r1]; b 1b",
        "2: subs r1, #4; bcc 3f; str r2, [r0, r1]; b 2b",
        "4: subs r1, #1; bcc 3f; strb r2, [r0, r1]; b 4b",
        "3: bx lr",
        ".popsection",
    );
}
