//! The step of each sample, whatever the rule: from codes to rows of tables, and from
//! these to the sums of the open block; at its end what its roughness says is added.
//!
//! The tables' records are read where they lie, on a board in flash. Nothing here is
//! generic: the code is there once, and as small as this crate is built.

use crate::format::{MAX_CLASSES, TableRecord};
use crate::model::{Model, Parts};
use crate::roughness::Roughness;
use crate::words::Words;

/// What is known of the open block, and of the touch by the blocks before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Sums {
    /// Samples to the end of the open block.
    pub(crate) left: u32,
    /// The check of the model keeps them below 2³¹.
    pub(crate) classes: [u32; MAX_CLASSES],
    pub(crate) roughness: Roughness,
    /// By how much each class exceeds its floors since the touch began: in samples,
    /// in roughness. Saturates.
    pub(crate) excess: [[i32; 2]; MAX_CLASSES],
}

impl Sums {
    pub(crate) const fn new(left: u32) -> Self {
        Self {
            left,
            classes: [0; MAX_CLASSES],
            roughness: Roughness::new(),
            excess: [[0; 2]; MAX_CLASSES],
        }
    }

    pub(crate) fn clear(&mut self, left: u32) {
        self.left = left;
        self.classes = [0; MAX_CLASSES];
        self.excess = [[0; 2]; MAX_CLASSES];
        self.roughness.clear();
    }

    /// Takes a sample, whose codes are of the channels from the `first` on, and its roughness where
    /// the model has it; whether it was the last of its block.
    #[inline]
    pub(crate) fn push<W: Words>(
        &mut self,
        model: &Model<W>,
        (codes, first): (&[i32], usize),
    ) -> bool {
        if model.has_roughness() {
            self.roughness.push(codes, true);
        }
        let model = model.parts();
        for table in model.sample_tables() {
            // No row of a checked model is missing; of another whisker's table there is no code.
            let _ = add(model, table, (codes, first), &mut self.classes);
        }
        if self.left > 1 {
            self.left -= 1;
            if self.left >= model.block() {
                // Its bits were flipped: nothing is known of the block.
                self.clear(model.block());
            }
            return false;
        }
        true
    }

    /// Compares the sums of a full block with their floors, and adds what its roughness
    /// says of the classes, which weighs as much as the mean of its samples.
    #[inline(never)]
    pub(crate) fn end_of_block(&mut self, model: Parts<'_>) {
        let block = model.block();
        let mut entries = [0; MAX_CLASSES];
        let (pairs, _) = entries.as_chunks_mut::<2>();
        for table in model.rough_tables() {
            let cell = table.cell(|channel| Some(self.roughness.code(channel)));
            if let Some(row) = cell.and_then(|cell| model.row(table, cell)) {
                add_words(pairs, row);
            }
        }
        self.roughness.clear();
        let classes = self.classes.iter_mut().zip(&entries);
        let floors = model.floors();
        for (((sum, entry), excess), floor) in classes.zip(&mut self.excess).zip(floors) {
            let [of_samples, of_roughness] = excess;
            let above = sum.wrapping_sub((floor & 0xffff) * block);
            *of_samples = of_samples.saturating_add(above.cast_signed());
            let above = entry.wrapping_sub(floor >> 16);
            *of_roughness = of_roughness.saturating_add(above.cast_signed());
        }
        for (sum, entry) in self.classes.iter_mut().zip(&entries).take(model.classes()) {
            *sum = sum.wrapping_add(entry.wrapping_mul(block));
        }
    }
}

#[inline]
fn add(
    model: Parts<'_>,
    table: TableRecord<'_>,
    (codes, first): (&[i32], usize),
    sums: &mut [u32; MAX_CLASSES],
) -> Option<()> {
    let cell = table.cell(|channel| codes.get(channel.wrapping_sub(first)).copied())?;
    let row = model.row(table, cell)?;
    let (pairs, _) = sums.as_chunks_mut::<2>();
    if let [first, second] = row {
        // Of three or four classes, without a loop.
        let [a, b, ..] = pairs else { return None };
        add_word(a, *first);
        add_word(b, *second);
    } else {
        add_words(pairs, row);
    }
    Some(())
}

// A function of its own: within the tick it would be unrolled for many classes.
#[inline(never)]
fn add_words(sums: &mut [[u32; 2]], row: &[u32]) {
    for (sums, word) in sums.iter_mut().zip(row) {
        add_word(sums, *word);
    }
}

/// No sum wraps: the check of the model sees to that.
#[inline]
fn add_word([even, odd]: &mut [u32; 2], word: u32) {
    *even = even.wrapping_add(word & 0xffff);
    *odd = odd.wrapping_add(word >> 16);
}
