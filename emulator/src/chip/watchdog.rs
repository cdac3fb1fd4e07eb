//! The independent watchdog (RM0390, chapter 20), on an LSI of its nominal 32 kHz.

use super::time::Ps;

/// One period of the LSI.
const LSI: Ps = 1_000_000_000_000 / 32_000;
/// A setting takes five of its periods to cross into the watchdog's clock.
const CROSSING: Ps = 5 * LSI;

const KR: u32 = 0x00;
const PR: u32 = 0x04;
const RLR: u32 = 0x08;
const SR: u32 = 0x0C;

#[derive(Debug, Clone, Default)]
pub(super) struct Watchdog {
    running: bool,
    unlocked: bool,
    prescaler: u32,
    reload: u32,
    /// When the settings last written have crossed: PR, RLR.
    settled: [Ps; 2],
    fed: Ps,
}

impl Watchdog {
    pub(super) fn new() -> Self {
        Self {
            reload: 0xFFF,
            ..Self::default()
        }
    }

    /// When it will bite if it is not fed.
    pub(super) fn bites(&self) -> Option<Ps> {
        let count = LSI * (4 << self.prescaler.min(6));
        self.running
            .then(|| self.fed + count * (Ps::from(self.reload) + 1))
    }

    pub(super) fn read(&self, offset: u32, now: Ps) -> Option<u32> {
        let busy = |setting: usize| u32::from(now < self.settled[setting]) << setting;
        Some(match offset {
            KR => 0,
            PR => self.prescaler,
            RLR => self.reload,
            SR => busy(0) | busy(1),
            _ => return None,
        })
    }

    /// Whether the register is modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps) -> bool {
        match (offset, value & 0xFFFF) {
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
                self.prescaler = value & 7;
                self.settled[0] = now + CROSSING;
            }
            (RLR, value) if self.unlocked => {
                self.reload = value & 0xFFF;
                self.settled[1] = now + CROSSING;
            }
            (PR | RLR, _) => {}
            _ => return false,
        }
        true
    }
}
