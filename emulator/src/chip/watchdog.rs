//! The independent watchdog (RM0390, chapter 20; RM0008, chapter 19; RM0444, chapter 28),
//! on an LSI of its nominal frequency. A window is not modelled: only that there is none.

use super::Ps;
use super::fields::{Field, field};

/// A setting takes so many periods of the LSI to cross into the watchdog's clock.
const CROSSING: Ps = 5;

const KR: u32 = 0x00;
const PR: u32 = 0x04;
const RLR: u32 = 0x08;
const SR: u32 = 0x0C;
const WINR: u32 = 0x10;
const KEY: u32 = 0xFFFF;
const PRESCALER: u32 = 7;
const RELOAD: u32 = 0xFFF;
const PVU: u32 = 1 << 0;
const RVU: u32 = 1 << 1;

pub(super) const FIELDS: [Field; 5] = [
    field("KR", KR, "KEY", KEY),
    field("PR", PR, "PR", PRESCALER),
    field("RLR", RLR, "RL", RELOAD),
    field("SR", SR, "PVU", PVU),
    field("SR", SR, "RVU", RVU),
];

/// The window after a reset: none.
const NO_WINDOW: u32 = 0xFFF;

#[derive(Debug, Clone, Default)]
pub(super) struct Watchdog {
    /// One period of the LSI.
    lsi: Ps,
    has_window: bool,
    running: bool,
    unlocked: bool,
    prescaler: u32,
    reload: u32,
    /// When the settings last written have crossed: PR, RLR.
    settled: [Ps; 2],
    fed: Ps,
}

impl Watchdog {
    pub(super) fn new(lsi: Ps, has_window: bool) -> Self {
        Self {
            lsi,
            has_window,
            reload: 0xFFF,
            ..Self::default()
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new(self.lsi, self.has_window);
    }

    pub(super) fn bites(&self) -> Option<Ps> {
        let count = self.lsi * (4 << self.prescaler.min(6));
        let bites = self.fed + count * (Ps::from(self.reload) + 1);
        self.running.then_some(bites)
    }

    pub(super) fn read(&self, offset: u32, now: Ps) -> Option<u32> {
        let busy = |setting: usize, bit| if now < self.settled[setting] { bit } else { 0 };
        Some(match offset {
            KR => 0,
            PR => self.prescaler,
            RLR => self.reload,
            SR => busy(0, PVU) | busy(1, RVU),
            WINR if self.has_window => NO_WINDOW,
            _ => return None,
        })
    }

    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps) -> bool {
        match (offset, value & KEY) {
            (KR, 0xCCCC) => {
                if !self.running {
                    self.fed = now;
                }
                self.running = true;
                self.unlocked = false;
            }
            (KR, 0xAAAA) => {
                self.fed = now;
                self.unlocked = false;
            }
            (KR, key) => self.unlocked = key == 0x5555,
            (PR, value) if self.unlocked => {
                self.prescaler = value & PRESCALER;
                self.settled[0] = now + CROSSING * self.lsi;
            }
            (RLR, value) if self.unlocked => {
                self.reload = value & RELOAD;
                self.settled[1] = now + CROSSING * self.lsi;
            }
            (PR | RLR, _) => {}
            (WINR, NO_WINDOW) if self.has_window => {}
            _ => return false,
        }
        true
    }
}
