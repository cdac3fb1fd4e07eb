//! Registers and their bits, as the description has them: blocks that extend others and lie in
//! others, arrays of registers and of fields.

use stm32_metapac::metadata::Peripheral;
use stm32_metapac::metadata::ir::{Array, BitOffset, Block, BlockItemInner, Field, FieldSet, IR};

struct Register {
    offset: u32,
    name: &'static str,
    bits: Option<&'static str>,
}

/// Whether a peripheral has a register at this offset and, unless `bits` are all, a field that
/// begins with their lowest and holds the others. See [`alike`] for names.
pub fn has(peripheral: &Peripheral, part: &str, [offset, bits]: [u32; 2]) -> bool {
    let Some(found) = &peripheral.registers else {
        return false;
    };
    let ir = found.ir;
    let mut registers = Vec::new();
    gather(ir, found.block, 0, &mut registers);
    let mut registers = registers.iter().filter(|found| found.offset == offset);
    match part.split_once('.') {
        None => registers.any(|found| alike(found.name, part)),
        Some((_, name)) => registers.any(|found| {
            let mut fields = found.bits.into_iter().flat_map(|set| fields(ir, set));
            fields.any(|field| alike(field.name, name) && places(field, bits))
        }),
    }
}

fn gather(ir: &'static IR, block: &str, base: u32, into: &mut Vec<Register>) {
    let mut blocks = ir.blocks.iter();
    let Some(block) = blocks.find(|found: &&Block| plain(found.name) == plain(block)) else {
        return;
    };
    if let Some(extended) = block.extends {
        gather(ir, extended, base, into);
    }
    for item in block.items {
        for step in steps(item.array.as_ref()) {
            let offset = base + item.byte_offset + step;
            match &item.inner {
                BlockItemInner::Block(inner) => gather(ir, inner.block, offset, into),
                BlockItemInner::Register(register) => into.push(Register {
                    offset,
                    name: item.name,
                    bits: register.fieldset,
                }),
            }
        }
    }
}

fn fields(ir: &'static IR, set: &str) -> Vec<&'static Field> {
    let mut sets = ir.fieldsets.iter();
    let Some(set) = sets.find(|found: &&FieldSet| plain(found.name) == plain(set)) else {
        return Vec::new();
    };
    let extended = set.extends.map(|extended| fields(ir, extended));
    set.fields
        .iter()
        .chain(extended.unwrap_or_default())
        .collect()
}

/// Whether a field, or one of its array, begins with the lowest of `bits` and holds them.
fn places(field: &Field, bits: u32) -> bool {
    let (first, size) = match &field.bit_offset {
        BitOffset::Regular(at) => (at.offset, field.bit_size),
        // In several places: the first is looked at.
        BitOffset::Cursed(places) => match places.ranges.first() {
            Some(range) => (*range.start(), range.end() - range.start() + 1),
            None => return false,
        },
    };
    steps(field.array.as_ref()).into_iter().any(|step| {
        let held = (u64::from(u32::MAX) >> (32 - size)) << (first + step);
        bits.trailing_zeros() == first + step && u64::from(bits) & !held == 0
    })
}

/// The distances of an array's elements from the first.
fn steps(array: Option<&Array>) -> Vec<u32> {
    match array {
        None => vec![0],
        Some(Array::Regular(array)) => (0..array.len).map(|n| n * array.stride).collect(),
        Some(Array::Cursed(array)) => array.offsets.to_vec(),
    }
}

/// A name without underscores, in capitals: `TIM_CORE` and `TimCore` are the same.
fn plain(name: &str) -> String {
    let letters = name.chars().filter(|letter| *letter != '_');
    letters.map(|letter| letter.to_ascii_uppercase()).collect()
}

/// What the description calls otherwise, without numbers.
const OTHERWISE: [(&str, &str); 2] = [("PINRSTF", "PADRSTF"), ("CNF", "CNFIN")];

/// Whether a name of the description is that of the manual, without numbers. The manual's may
/// begin with more, as S0NDTR does, which is the NDTR of an element there.
fn alike(described: &str, manual: &str) -> bool {
    let letters = |name: &str| -> String {
        let plain = plain(name);
        plain.chars().filter(|c| !c.is_ascii_digit()).collect()
    };
    let (manual, described) = (letters(manual), letters(described));
    manual.ends_with(&described) || OTHERWISE.contains(&(&manual, &described))
}
