//! What tells one chip's flash interface from another's.

use std::ops::Range;

use super::super::fields::{Field, field, whole};
use super::super::time::Ps;

pub(super) const ACR: u32 = 0x00;

/// PSIZE, and its value for words.
pub(super) const WIDTH: u32 = 3 << 8;
pub(super) const WORDS: u32 = 2 << 8;

const MS: Ps = 1_000_000_000;
const US: Ps = 1_000_000;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Version {
    /// Pages of 1 KiB, selected by their address; 16 bits at a time.
    F1,
    /// Sectors, of which those of 128 KiB are erased; 32 bits at a time.
    F4,
    /// Pages of 2 KiB, selected by their number; 64 bits at a time.
    G0,
}

#[derive(Debug)]
pub(super) struct Layout {
    version: Version,
    pub(super) keyr: u32,
    pub(super) sr: u32,
    pub(super) cr: u32,
    pub(super) ar: Option<u32>,
    pub(super) bsy: u32,
    /// The error of a store that is refused.
    pub(super) refused: u32,
    /// Where the number of a unit stands in CR.
    pub(super) number: u32,
    pub(super) strt: u32,
    pub(super) lock: u32,
    /// Whether CR has PSIZE.
    pub(super) has_width: bool,
    /// Bytes that are erased at once, and that a store has.
    pub(super) unit: u32,
    pub(super) bytes: usize,
    /// Whether two stores are one write.
    pub(super) in_pairs: bool,
    pub(super) erases: Ps,
    pub(super) writes: Ps,
}

/// Times: STM32F103x8/B datasheet, flash memory characteristics.
static F1: Layout = Layout {
    version: Version::F1,
    keyr: 0x04,
    sr: 0x0C,
    cr: 0x10,
    ar: Some(0x14),
    bsy: 1 << 0,
    refused: 1 << 2,
    number: 0,
    strt: 1 << 6,
    lock: 1 << 7,
    has_width: false,
    unit: 1024,
    bytes: 2,
    in_pairs: false,
    erases: 20 * MS,
    writes: 52 * US,
};

/// Times: STM32F446xC/E datasheet, flash memory programming, 32 bits at a time.
static F4: Layout = Layout {
    version: Version::F4,
    keyr: 0x04,
    sr: 0x0C,
    cr: 0x10,
    ar: None,
    bsy: 1 << 16,
    refused: 1 << 7,
    number: 0x1F << 3,
    strt: 1 << 16,
    lock: 1 << 31,
    has_width: true,
    unit: 128 * 1024,
    bytes: 4,
    in_pairs: false,
    erases: 1_000 * MS,
    writes: 16 * US,
};

/// Times: STM32G071x8/xB datasheet, flash memory characteristics.
static G0: Layout = Layout {
    version: Version::G0,
    keyr: 0x08,
    sr: 0x10,
    cr: 0x14,
    ar: None,
    bsy: 1 << 16,
    refused: 1 << 7,
    number: 0x7F << 3,
    strt: 1 << 16,
    lock: 1 << 31,
    has_width: false,
    unit: 2048,
    bytes: 4,
    in_pairs: true,
    erases: 22 * MS,
    writes: 85 * US,
};

/// KiB of the STM32F446's sectors (RM0390, flash module organization).
const SECTORS: [u32; 8] = [16, 16, 16, 16, 64, 128, 128, 128];

impl Version {
    pub(super) const fn layout(self) -> &'static Layout {
        match self {
            Self::F1 => &F1,
            Self::F4 => &F4,
            Self::G0 => &G0,
        }
    }
}

impl Layout {
    /// The offsets of a unit, if it is one that can be erased.
    pub(super) fn place(&self, number: u32) -> Option<Range<u32>> {
        let first = match self.version {
            Version::F1 | Version::G0 => number * self.unit,
            Version::F4 => {
                let sectors = SECTORS.map(|kib| kib * 1024);
                let size = sectors.get(number as usize)?;
                if *size != self.unit {
                    return None;
                }
                sectors.iter().take(number as usize).sum()
            }
        };
        Some(first..first + self.unit)
    }

    pub(super) fn fields(&self) -> Vec<Field> {
        let mut fields = vec![whole("ACR", ACR), whole("KEYR", self.keyr)];
        let errors: &[(&str, u32)] = match self.version {
            Version::F1 => &[("PGERR", 1 << 2), ("WRPRTERR", 1 << 4)],
            Version::F4 => &[
                ("OPERR", 1 << 1),
                ("WRPERR", 1 << 4),
                ("PGAERR", 1 << 5),
                ("PGPERR", 1 << 6),
                ("PGSERR", 1 << 7),
            ],
            Version::G0 => &[
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
        };
        let status = errors.iter().copied().chain([("BSY", self.bsy)]);
        fields.extend(status.map(|(name, bits)| field("SR", self.sr, name, bits)));
        let (erases, number) = match self.version {
            Version::F1 => ("PER", None),
            Version::F4 => ("SER", Some("SNB")),
            Version::G0 => ("PER", Some("PNB")),
        };
        let control = [("PG", 1 << 0), (erases, 1 << 1)];
        let others = [("STRT", self.strt), ("LOCK", self.lock)];
        let number = number.map(|name| (name, self.number));
        let width = self.has_width.then_some(("PSIZE", WIDTH));
        let control = control.into_iter().chain(number).chain(width).chain(others);
        fields.extend(control.map(|(name, bits)| field("CR", self.cr, name, bits)));
        fields.extend(self.ar.map(|ar| field("AR", ar, "FAR", u32::MAX)));
        fields
    }
}
