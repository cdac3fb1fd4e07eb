//! What tells one chip's flash interface from another's.

use std::ops::Range;

use super::super::fields::{Field, field, whole};
use crate::chip::Ps;

pub(super) const ACR: u32 = 0x00;

/// PSIZE, and its value for words.
pub(super) const WIDTH: u32 = 3 << 8;
pub(super) const WORDS: u32 = 2 << 8;

const MS: Ps = 1_000_000_000;
const US: Ps = 1_000_000;

#[derive(Debug)]
pub(in crate::chip) struct Layout {
    /// ACR after a reset.
    pub(super) acr: u32,
    pub(super) keyr: u32,
    pub(super) sr: u32,
    pub(super) cr: u32,
    pub(super) ar: Option<u32>,
    pub(super) bsy: u32,
    /// The error of a store that is refused, and all that are known by name.
    pub(super) refused: u32,
    errors: &'static [(&'static str, u32)],
    /// What erases, and where the number of a unit stands in CR.
    erase: &'static str,
    pub(super) number: u32,
    number_name: &'static str,
    pub(super) strt: u32,
    pub(super) lock: u32,
    /// Whether CR has PSIZE.
    pub(super) has_width: bool,
    /// Bytes that are erased at once, of units that are unequal the KiB of each, and bytes that a
    /// store has.
    pub(super) unit: u32,
    sectors: &'static [u32],
    pub(super) bytes: usize,
    /// Whether two stores are one write.
    pub(super) in_pairs: bool,
    pub(super) erases: Ps,
    pub(super) writes: Ps,
}

/// Pages of 1 KiB, selected by their address; 16 bits at a time. Times: STM32F103x8/B datasheet,
/// flash memory characteristics.
pub(in crate::chip) static F1: Layout = Layout {
    acr: 0x30,
    keyr: 0x04,
    sr: 0x0C,
    cr: 0x10,
    ar: Some(0x14),
    bsy: 1 << 0,
    refused: 1 << 2,
    errors: &[("PGERR", 1 << 2), ("WRPRTERR", 1 << 4)],
    erase: "PER",
    number: 0,
    number_name: "",
    strt: 1 << 6,
    lock: 1 << 7,
    has_width: false,
    unit: 1024,
    sectors: &[],
    bytes: 2,
    in_pairs: false,
    erases: 20 * MS,
    writes: 52 * US,
};

/// Sectors (RM0390, flash module organization), of which those of 128 KiB are erased; 32 bits at a
/// time. Times: STM32F446xC/E datasheet, flash memory programming.
pub(in crate::chip) static F4: Layout = Layout {
    acr: 0,
    keyr: 0x04,
    sr: 0x0C,
    cr: 0x10,
    ar: None,
    bsy: 1 << 16,
    refused: 1 << 7,
    errors: &[
        ("OPERR", 1 << 1),
        ("WRPERR", 1 << 4),
        ("PGAERR", 1 << 5),
        ("PGPERR", 1 << 6),
        ("PGSERR", 1 << 7),
    ],
    erase: "SER",
    number: 0x1F << 3,
    number_name: "SNB",
    strt: 1 << 16,
    lock: 1 << 31,
    has_width: true,
    unit: 128 * 1024,
    sectors: &[16, 16, 16, 16, 64, 128, 128, 128],
    bytes: 4,
    in_pairs: false,
    erases: 1_000 * MS,
    writes: 16 * US,
};

/// Pages of 2 KiB, selected by their number; 64 bits at a time. Times: STM32G071x8/xB datasheet,
/// flash memory characteristics.
pub(in crate::chip) static G0: Layout = Layout {
    acr: 0x0004_0600,
    keyr: 0x08,
    sr: 0x10,
    cr: 0x14,
    ar: None,
    bsy: 1 << 16,
    refused: 1 << 7,
    errors: &[
        ("OPERR", 1 << 1),
        ("PROGERR", 1 << 3),
        ("WRPERR", 1 << 4),
        ("PGAERR", 1 << 5),
        ("SIZERR", 1 << 6),
        ("PGSERR", 1 << 7),
        ("MISERR", 1 << 8),
        ("FASTERR", 1 << 9),
        ("CFGBSY", 1 << 18),
    ],
    erase: "PER",
    number: 0x7F << 3,
    number_name: "PNB",
    strt: 1 << 16,
    lock: 1 << 31,
    has_width: false,
    unit: 2048,
    sectors: &[],
    bytes: 4,
    in_pairs: true,
    erases: 22 * MS,
    writes: 85 * US,
};

impl Layout {
    /// The offsets of a unit, if it is one that can be erased.
    pub(super) fn place(&self, number: u32) -> Option<Range<u32>> {
        let first = if self.sectors.is_empty() {
            number * self.unit
        } else {
            let (before, from) = self.sectors.split_at_checked(number as usize)?;
            from.first().filter(|kib| **kib * 1024 == self.unit)?;
            1024 * before.iter().sum::<u32>()
        };
        Some(first..first + self.unit)
    }

    pub(in crate::chip) fn fields(&self) -> Vec<Field> {
        let mut fields = vec![whole("ACR", ACR), whole("KEYR", self.keyr)];
        let status = self.errors.iter().copied().chain([("BSY", self.bsy)]);
        fields.extend(status.map(|(name, bits)| field("SR", self.sr, name, bits)));
        let number = (self.number != 0).then_some((self.number_name, self.number));
        let width = self.has_width.then_some(("PSIZE", WIDTH));
        let control = [("PG", 1 << 0), (self.erase, 1 << 1)];
        let others = [("STRT", self.strt), ("LOCK", self.lock)];
        let control = control.into_iter().chain(number).chain(width).chain(others);
        fields.extend(control.map(|(name, bits)| field("CR", self.cr, name, bits)));
        fields.extend(self.ar.map(|ar| field("AR", ar, "FAR", u32::MAX)));
        fields
    }
}
