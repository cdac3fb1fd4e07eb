//! The tables of samples as the streaming step walks them.

use crate::binner::Binner;
use crate::format::{MAX_SAMPLE_AXES, TableRecord};

/// An axis of a table of samples.
#[derive(Debug, Clone, Copy, Default)]
struct Axis {
    binner: Binner,
    last_bin: u16,
    channel: u8,
    /// Whether it is the last of its table.
    ends: bool,
    /// Words from a bin's row to that of the next.
    stride: u32,
    /// The first word of the table's rows, on its first axis; else 0.
    first: u32,
}

/// The axes of all tables of samples, table by table.
#[derive(Debug, Clone)]
pub(crate) struct Lookup {
    axes: [Axis; MAX_SAMPLE_AXES],
    count: usize,
}

impl Lookup {
    /// Of tables whose rows are of so many words. The check of the model has seen to
    /// it that there is room for their axes.
    pub(crate) fn new<'t>(tables: impl Iterator<Item = &'t TableRecord>, row_words: usize) -> Self {
        let mut axes = [Axis::default(); MAX_SAMPLE_AXES];
        let mut count = 0;
        let mut places = axes.iter_mut();
        for table in tables {
            let [_, second] = &table.axis;
            // Of a table of one axis the second has one bin.
            let strides = [
                (u32::from(second.last_bin) + 1) * row_words as u32,
                row_words as u32,
            ];
            let used = usize::from(table.axes);
            let axes = table.axis.iter().zip(strides).take(used).enumerate();
            for ((n, (axis, stride)), place) in axes.zip(places.by_ref()) {
                *place = Axis {
                    binner: axis.binner,
                    last_bin: axis.last_bin,
                    channel: axis.channel,
                    ends: n + 1 == used,
                    stride,
                    first: if n == 0 { table.first } else { 0 },
                };
                count += 1;
            }
        }
        Self { axes, count }
    }

    /// The word at which the row begins that each table has for a sample.
    #[inline]
    pub(crate) fn rows(&self, codes: &[i32]) -> impl Iterator<Item = usize> {
        let mut axes = self.axes.get(..self.count).unwrap_or_default().iter();
        core::iter::from_fn(move || {
            let mut row = 0;
            for axis in axes.by_ref() {
                let code = codes.get(usize::from(axis.channel)).copied().unwrap_or(0);
                let bin = axis.binner.bin(code, usize::from(axis.last_bin));
                row += axis.first as usize + bin * axis.stride as usize;
                if axis.ends {
                    return Some(row);
                }
            }
            None
        })
    }
}
