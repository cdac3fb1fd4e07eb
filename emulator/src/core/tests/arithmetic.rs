//! The emulated core against this PC's: the arithmetic that the firmware compiles to.
//!
//! rsemu is young, so what is relied on is checked here, on machine code
//! assembled elsewhere. Results that are not a number are compared as such:
//! the sign of one that is passed on is not defined the same everywhere.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{CODE, core_in_memory};
use crate::chip::CoreKind;
use crate::memory::RAM;

const CASES: usize = 20_000;

/// What stands in the fourth word of RAM after `steps` instructions of a code, by the three before.
fn runs(code: &[u16], steps: usize) -> impl FnMut([u32; 3]) -> u32 {
    let (mut core, memories) = core_in_memory(CoreKind::M4F, code);
    core.with_sys(|sys| sys.cpacr = 0xF << 20);
    core.set_reg(0, RAM);
    move |operands| {
        for (at, word) in (RAM..).step_by(4).zip(operands) {
            memories.write(at, &word.to_le_bytes()).unwrap();
        }
        core.set_pc(CODE);
        for _ in 0..steps {
            core.step();
        }
        memories.word(RAM + 12).unwrap()
    }
}

/// Operands: any bits, and those at which arithmetic goes wrong.
fn operands() -> impl Iterator<Item = [u32; 3]> {
    const EDGES: [u32; 14] = [
        0,
        1,
        0x7FFF_FFFF,
        0x8000_0000,
        u32::MAX,
        0x3F80_0000,
        0xBF80_0000,
        0x0080_0000,
        0x007F_FFFF,
        0x7F7F_FFFF,
        0x7F80_0000,
        0xFF80_0000,
        0x7FC0_0000,
        0x4F00_0000,
    ];
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    (0..CASES).map(move |_| {
        let mut word = || {
            let bits = random.next_u64();
            match bits >> 62 {
                0 => EDGES[(bits as usize) % EDGES.len()],
                // Near one: sums cancel.
                1 => {
                    0x3F00_0000
                        + (bits as u32 & 0x01FF_FFFF)
                        + ((bits >> 40) as u32 & 1) * 0x8000_0000
                }
                _ => bits as u32,
            }
        };
        [word(), word(), word()]
    })
}

/// Checks an operation on s0 and s1 (and s2) with the result in s2.
fn single(name: &str, operation: [u16; 2], expected: impl Fn(f32, f32, f32) -> f32) {
    let mut code = vec![0xED90, 0x0A00, 0xEDD0, 0x0A01, 0xED90, 0x1A02];
    code.extend(operation);
    code.extend([0xED80, 0x1A03]);
    let mut run = runs(&code, 5);
    for operands in operands() {
        let found = f32::from_bits(run(operands));
        let [a, b, c] = operands.map(f32::from_bits);
        let expected = expected(a, b, c);
        let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
        assert!(same, "{name} {operands:x?}: {found:?}, not {expected:?}");
    }
}

/// Checks an operation on r1, r2 and r3 with the result in r3.
fn integer(name: &str, operation: [u16; 2], expected: impl Fn(i32, i32, i32) -> i32) {
    let mut code = vec![0x6801, 0x6842, 0x6883];
    code.extend(operation);
    code.push(0x60C3);
    let mut run = runs(&code, 5);
    for operands in operands() {
        let found = run(operands).cast_signed();
        let [a, b, c] = operands.map(u32::cast_signed);
        assert_eq!(found, expected(a, b, c), "{name} {operands:x?}");
    }
}

#[test]
fn floating_point_is_this_machines() {
    single("vadd", [0xEE30, 0x1A20], |a, b, _| a + b);
    single("vsub", [0xEE30, 0x1A60], |a, b, _| a - b);
    single("vmul", [0xEE20, 0x1A20], |a, b, _| a * b);
    single("vdiv", [0xEE80, 0x1A20], |a, b, _| a / b);
    single("vfma", [0xEEA0, 0x1A20], f32::mul_add);
    single("vfms", [0xEEA0, 0x1A60], |a, b, c| (-a).mul_add(b, c));
    single("vsqrt", [0xEEB1, 0x1AC0], |a, _, _| a.sqrt());
}

#[test]
fn conversions_are_this_machines() {
    let to_int = |a: f32, _, _| f32::from_bits((a as i32).cast_unsigned());
    single("vcvt.s32", [0xEEBD, 0x1AC0], to_int);
    let from_int = |a: f32, _, _| a.to_bits().cast_signed() as f32;
    single("vcvt.f32", [0xEEB8, 0x1AC0], from_int);
}

#[test]
fn fixed_point_is_this_machines() {
    let high = |product: i64| (product >> 32) as i32;
    let wide = |a: i32, b: i32| i64::from(a) * i64::from(b);
    integer("smull", [0xFB81, 0x1302], |a, b, _| high(wide(a, b)));
    integer("smlal", [0xFBC1, 0x1302], |a, b, c| {
        let sum = i64::from(c) << 32 | i64::from(a.cast_unsigned());
        high(sum.wrapping_add(wide(a, b)))
    });
    integer("smmulr", [0xFB51, 0xF312], |a, b, _| {
        high(wide(a, b).wrapping_add(0x8000_0000))
    });
    integer("qadd", [0xFA82, 0xF381], |a, b, _| a.saturating_add(b));
    integer("qsub", [0xFA82, 0xF3A1], |a, b, _| a.saturating_sub(b));
    integer("sdiv", [0xFB91, 0xF3F2], |a, b, _| {
        a.checked_div(b).unwrap_or(if b == 0 { 0 } else { a })
    });
    integer("ssat", [0xF321, 0x03CE], |a, _, _| {
        (a >> 3).clamp(-16_384, 16_383)
    });
}
