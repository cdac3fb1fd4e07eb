//! A timer, TIM1 to TIM8 (RM0390, chapters 16 to 19; RM0008, chapters 14 to 17; RM0444,
//! chapters 20 to 23): counting up, updates with
//! interrupt and DMA request, DMA requests by matches of channel 1, PWM mode 1 and encoder
//! mode 3.
//!
//! The count is worked out when somebody looks; only updates that interrupt, and what makes
//! a DMA request, are events. Compare values act at once: the buffering of
//! a PWM period, 50 µs, is not modelled.

use super::fields::{Field, field, whole};
use super::time::Ps;
use super::timers::Kind;
use super::wiring::ByteSignal;

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const SMCR: u32 = 0x08;
const DIER: u32 = 0x0C;
const SR: u32 = 0x10;
const EGR: u32 = 0x14;
const CCMR1: u32 = 0x18;
const CCMR2: u32 = 0x1C;
const CCER: u32 = 0x20;
const CNT: u32 = 0x24;
const PSC: u32 = 0x28;
const ARR: u32 = 0x2C;
const CCR1: u32 = 0x34;
const CCR4: u32 = 0x40;
const BDTR: u32 = 0x44;

const CEN: u32 = 1 << 0;
const UDIS: u32 = 1 << 1;
const URS: u32 = 1 << 2;
const ARPE: u32 = 1 << 7;
const SMS: u32 = 7;
const UIE: u32 = 1 << 0;
const UDE: u32 = 1 << 8;
const CC1DE: u32 = 1 << 9;
const UIF: u32 = 1 << 0;
const UG: u32 = 1 << 0;
/// Of channel 1; those of the others stand at equal distances.
const OC1M: u32 = 7 << 4;
const CC1E: u32 = 1 << 0;
const MOE: u32 = 1 << 15;

const FIELDS: [Field; 19] = [
    field("CR1", CR1, "CEN", CEN),
    field("CR1", CR1, "UDIS", UDIS),
    field("CR1", CR1, "URS", URS),
    field("CR1", CR1, "ARPE", ARPE),
    field("SMCR", SMCR, "SMS", SMS),
    field("DIER", DIER, "UIE", UIE),
    field("DIER", DIER, "UDE", UDE),
    field("DIER", DIER, "CC1DE", CC1DE),
    field("SR", SR, "UIF", UIF),
    field("EGR", EGR, "UG", UG),
    field("CCMR1", CCMR1, "OC1M", OC1M),
    field("CCMR1", CCMR1, "OC2M", OC1M << 8),
    field("CCMR2", CCMR2, "OC3M", OC1M),
    field("CCER", CCER, "CC1E", CC1E),
    field("CCER", CCER, "CC2E", CC1E << 4),
    whole("CNT", CNT),
    whole("PSC", PSC),
    whole("ARR", ARR),
    field("BDTR", BDTR, "MOE", MOE),
];

#[derive(Debug, Clone, Default)]
pub(super) struct Timer {
    kind: Kind,
    cr1: u32,
    cr2: u32,
    smcr: u32,
    dier: u32,
    sr: u32,
    ccmr: [u32; 2],
    ccer: u32,
    psc: u32,
    arr: u32,
    ccr: [u32; 4],
    bdtr: u32,
    /// The prescaler and period in effect.
    active: [u32; 2],
    /// The count at `since`, with the prescaler at zero.
    count: u32,
    since: Ps,
    /// When the last update was.
    pub(super) updated: Ps,
    /// Whether an update, and whether a match of channel 1, waits for the DMA.
    update_waits: bool,
    match_waits: bool,
    /// The encoder's position outside, counts.
    position: i32,
}

const fn has(kind: Kind, offset: u32) -> bool {
    match kind {
        Kind::Basic => !matches!(offset, SMCR | CCMR1..=CCER | CCR1..),
        Kind::General | Kind::Wide => offset != BDTR,
        Kind::Advanced => true,
    }
}

pub(super) fn fields(kind: Kind) -> Vec<Field> {
    let fields = FIELDS.into_iter();
    // The request of a channel that it has.
    let is_there = |field: &Field| field.bits != CC1DE || has(kind, CCR1);
    let fields = fields.filter(|field| has(kind, field.offset) && is_there(field));
    fields.collect()
}

impl Timer {
    pub(super) fn new(kind: Kind) -> Self {
        Self {
            kind,
            arr: kind.mask(),
            active: [0, kind.mask()],
            ..Self::default()
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self {
            position: self.position,
            ..Self::new(self.kind)
        };
    }

    const fn has(&self, offset: u32) -> bool {
        has(self.kind, offset)
    }

    const fn is_encoder(&self) -> bool {
        matches!(self.smcr & SMS, 1..=3)
    }

    const fn counts_time(&self) -> bool {
        self.cr1 & CEN != 0 && !self.is_encoder()
    }

    fn step(&self, clock: Ps) -> Ps {
        clock * (Ps::from(self.active[0]) + 1)
    }

    pub(super) fn sync(&mut self, now: Ps, clock: Ps) {
        if !self.counts_time() {
            self.since = now;
            return;
        }
        let step = self.step(clock);
        let period = Ps::from(self.active[1]) + 1;
        let steps = now.saturating_sub(self.since) / step;
        let total = Ps::from(self.count) + steps;
        let wraps = total / period;
        // Matches in the counts after the last look, up to now.
        if self.dier & CC1DE != 0 {
            let first = (Ps::from(self.ccr[0]) + period - Ps::from(self.count) % period) % period;
            let first = if first == 0 { period } else { first };
            self.match_waits |= Ps::from(self.ccr[0]) < period && first <= steps;
        }
        if wraps > 0 {
            let wrapped = wraps * period - Ps::from(self.count);
            self.updated = self.since + wrapped * step;
            self.update(false);
        }
        self.count = (total % period) as u32;
        self.since += steps * step;
    }

    fn update(&mut self, by_software: bool) {
        if self.cr1 & UDIS != 0 {
            return;
        }
        self.active = [self.psc, self.arr];
        if by_software && self.cr1 & URS != 0 {
            return;
        }
        self.sr |= UIF;
        self.update_waits |= self.dier & UDE != 0;
    }

    pub(super) fn next(&self, clock: Ps) -> Option<Ps> {
        let (period, count) = (Ps::from(self.active[1]) + 1, Ps::from(self.count));
        let update = (self.dier & (UIE | UDE) != 0).then(|| period.saturating_sub(count).max(1));
        let compare = Ps::from(self.ccr[0]);
        let compares = self.dier & CC1DE != 0 && compare < period;
        let compare = compares.then(|| match compare.checked_sub(count) {
            None | Some(0) => (period + compare).saturating_sub(count).max(1),
            Some(left) => left,
        });
        let left = update.into_iter().chain(compare).min();
        let left = left.filter(|_| self.counts_time());
        left.map(|left| self.since + left * self.step(clock))
    }

    pub(super) const fn requests(&self, signal: ByteSignal) -> bool {
        match signal {
            ByteSignal::Update => self.update_waits,
            ByteSignal::Compare => self.match_waits,
        }
    }

    pub(super) const fn serve(&mut self, signal: ByteSignal) {
        match signal {
            ByteSignal::Update => self.update_waits = false,
            ByteSignal::Compare => self.match_waits = false,
        }
    }

    pub(super) const fn interrupts(&self) -> bool {
        self.sr & self.dier & UIF != 0
    }

    pub(super) const fn set_position(&mut self, position: i32, connected: bool) {
        let moved = position.wrapping_sub(self.position);
        self.position = position;
        if connected && self.is_encoder() && self.cr1 & CEN != 0 {
            // From the reload value it goes on to zero, and the other way round.
            let range = self.arr as i64 + 1;
            self.count = (self.count as i64 + moved as i64).rem_euclid(range) as u32;
        }
    }

    /// Duty of channel 0 to 3, as a fraction: on and of how many counts.
    pub(super) fn duty(&self, channel: usize) -> (u32, u32) {
        let mode = self.ccmr[channel / 2] >> (8 * (channel % 2));
        let mode = (mode & OC1M) >> OC1M.trailing_zeros();
        let enabled = self.cr1 & CEN != 0
            && self.ccer & (CC1E << (4 * channel)) != 0
            && (self.bdtr & MOE != 0 || self.kind != Kind::Advanced);
        let period = self.arr.saturating_add(1);
        let on = if enabled && mode == 6 {
            self.ccr[channel].min(period)
        } else {
            0
        };
        (on, period)
    }

    pub(super) fn read(&mut self, offset: u32, now: Ps, clock: Ps) -> Option<u32> {
        self.sync(now, clock);
        if !self.has(offset) {
            return None;
        }
        Some(match offset {
            CR1 => self.cr1,
            CR2 => self.cr2,
            SMCR => self.smcr,
            DIER => self.dier,
            SR => self.sr,
            EGR => 0,
            CCMR1 => self.ccmr[0],
            CCMR2 => self.ccmr[1],
            CCER => self.ccer,
            CNT => self.count,
            PSC => self.psc,
            ARR => self.arr,
            CCR1..=CCR4 => self.ccr[((offset - CCR1) / 4) as usize],
            BDTR => self.bdtr,
            _ => return None,
        })
    }

    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps, clock: Ps) -> bool {
        self.sync(now, clock);
        if !self.has(offset) {
            return false;
        }
        match offset {
            // Up-counting, edge aligned, without one-pulse mode.
            CR1 if value & !(CEN | UDIS | URS | ARPE) != 0 => return false,
            CR1 => self.cr1 = value,
            CR2 => self.cr2 = value,
            // The other modes of synchronisation are not modelled.
            SMCR if !matches!(value, 0 | 3) => return false,
            SMCR => self.smcr = value,
            DIER if value & !(UIE | UDE | CC1DE) != 0 => return false,
            DIER if value & CC1DE != 0 && !self.has(CCR1) => return false,
            DIER => {
                self.dier = value;
                self.update_waits &= value & UDE != 0;
                self.match_waits &= value & CC1DE != 0;
            }
            SR => self.sr &= value,
            EGR => {
                if value & UG != 0 {
                    self.count = 0;
                    self.since = now;
                    self.update(true);
                }
            }
            // The modes above 16 bits are not modelled.
            CCMR1 | CCMR2 if value > 0xFFFF => return false,
            CCMR1 => self.ccmr[0] = value,
            CCMR2 => self.ccmr[1] = value,
            CCER => self.ccer = value,
            CNT => {
                self.count = value & self.kind.mask();
                self.since = now;
            }
            PSC => self.psc = value & 0xFFFF,
            ARR => {
                self.arr = value & self.kind.mask();
                if self.cr1 & ARPE == 0 {
                    self.active[1] = self.arr;
                }
            }
            CCR1..=CCR4 => self.ccr[((offset - CCR1) / 4) as usize] = value & self.kind.mask(),
            BDTR => self.bdtr = value & 0xFFFF,
            _ => return false,
        }
        true
    }
}
