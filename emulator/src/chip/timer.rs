//! A timer, TIM1 to TIM8 (RM0390, chapters 16 to 19; RM0008, chapters 14 to 17; RM0444, chapters 20
//! to 23): counting up, updates with interrupt and DMA request, DMA requests by matches of channel
//! 1, PWM mode 1 and encoder mode 3.
//!
//! The count is worked out when somebody looks; only updates that interrupt, and what makes
//! a DMA request, are events. Compare values act at once: the buffering of
//! a PWM period, 50 µs, is not modelled.

use super::Ps;
use super::fields::{Field, field, whole};
use super::wiring::ByteSignal;

const CR1: u32 = 0x00;
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
/// The repetition counter, which is not modelled.
const RCR: u32 = 0x30;
const CCR1: u32 = 0x34;
const CCR4: u32 = 0x40;
const BDTR: u32 = 0x44;

const CEN: Field = field("CR1", CR1, "CEN", 1 << 0);
const UDIS: Field = field("CR1", CR1, "UDIS", 1 << 1);
const URS: Field = field("CR1", CR1, "URS", 1 << 2);
const ARPE: Field = field("CR1", CR1, "ARPE", 1 << 7);
const SMS: Field = field("SMCR", SMCR, "SMS", 7);
const UIE: Field = field("DIER", DIER, "UIE", 1 << 0);
const UDE: Field = field("DIER", DIER, "UDE", 1 << 8);
const CC1DE: Field = field("DIER", DIER, "CC1DE", 1 << 9);
const UIF: Field = field("SR", SR, "UIF", 1 << 0);
const UG: Field = field("EGR", EGR, "UG", 1 << 0);
/// Those of the other channels stand at equal distances.
const OC1M: Field = field("CCMR1", CCMR1, "OC1M", 7 << 4);
const OC2M: Field = field("CCMR1", CCMR1, "OC2M", OC1M.bits << 8);
const OC3M: Field = field("CCMR2", CCMR2, "OC3M", OC1M.bits);
const CC1E: Field = field("CCER", CCER, "CC1E", 1 << 0);
const CC2E: Field = field("CCER", CCER, "CC2E", CC1E.bits << 4);
const MOE: Field = field("BDTR", BDTR, "MOE", 1 << 15);

/// The places of what can ask for a byte.
const UPDATE: usize = ByteSignal::Update as usize;
const MATCH: usize = ByteSignal::Compare as usize;

/// What a timer can do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Kind {
    /// It counts 16 bits of time.
    #[default]
    Basic,
    /// It has channels, too.
    General,
    /// It counts 32 bits, and has channels.
    Wide,
    /// It has channels, and its outputs need BDTR.MOE.
    Advanced,
}

impl Kind {
    pub(super) const fn mask(self) -> u32 {
        match self {
            Self::Wide => u32::MAX,
            Self::Basic | Self::General | Self::Advanced => 0xFFFF,
        }
    }
}

#[derive(Debug, Clone, Default)]
pub(super) struct Timer {
    kind: Kind,
    /// What was written, by offset; the count apart.
    registers: [u32; 18],
    /// The prescaler and period in effect.
    active: [u32; 2],
    /// The count at `since`, with the prescaler at zero.
    count: u32,
    since: Ps,
    /// When the last update was.
    pub(super) updated: Ps,
    /// Which signals wait for the DMA.
    waits: [bool; 2],
    /// The encoder's position outside, counts.
    position: i32,
}

const fn has(kind: Kind, offset: u32) -> bool {
    let is_there = match kind {
        Kind::Basic => !matches!(offset, SMCR | CCMR1..=CCER | CCR1..),
        Kind::General | Kind::Wide => offset != BDTR,
        Kind::Advanced => true,
    };
    is_there && offset != RCR && offset <= BDTR
}

pub(super) fn fields(kind: Kind) -> Vec<Field> {
    let fields = [
        CEN, UDIS, URS, ARPE, SMS, UIE, UDE, CC1DE, UIF, UG, OC1M, OC2M, OC3M, CC1E, CC2E,
    ];
    let counts = [whole("CNT", CNT), whole("PSC", PSC), whole("ARR", ARR)];
    let fields = fields.into_iter().chain(counts).chain([MOE]);
    // The request of a channel that it has.
    let is_there = |field: &Field| *field != CC1DE || has(kind, CCR1);
    let fields = fields.filter(|field| has(kind, field.offset) && is_there(field));
    fields.collect()
}

impl Timer {
    pub(super) fn new(kind: Kind) -> Self {
        let mut timer = Self {
            kind,
            active: [0, kind.mask()],
            ..Self::default()
        };
        timer.registers[ARR as usize / 4] = kind.mask();
        timer
    }

    pub(super) fn reset(&mut self) {
        *self = Self {
            position: self.position,
            ..Self::new(self.kind)
        };
    }

    const fn at(&self, offset: u32) -> u32 {
        self.registers[offset as usize / 4]
    }

    const fn is_on(&self, field: Field) -> bool {
        field.is_in(self.at(field.offset))
    }

    const fn is_encoder(&self) -> bool {
        matches!(SMS.number_in(self.at(SMCR)), 1..=3)
    }

    const fn counts_time(&self) -> bool {
        self.is_on(CEN) && !self.is_encoder()
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
        if self.is_on(CC1DE) {
            let compare = Ps::from(self.at(CCR1));
            let first = (compare + period - Ps::from(self.count) % period) % period;
            let first = if first == 0 { period } else { first };
            self.waits[MATCH] |= compare < period && first <= steps;
        }
        if wraps > 0 {
            let wrapped = wraps * period - Ps::from(self.count);
            self.updated = self.since + wrapped * step;
            self.update(false);
        }
        self.count = (total % period) as u32;
        self.since += steps * step;
    }

    const fn update(&mut self, by_software: bool) {
        if self.is_on(UDIS) {
            return;
        }
        self.active = [self.at(PSC), self.at(ARR)];
        if by_software && self.is_on(URS) {
            return;
        }
        self.registers[SR as usize / 4] |= UIF.bits;
        self.waits[UPDATE] |= self.is_on(UDE);
    }

    pub(super) fn next(&self, clock: Ps) -> Option<Ps> {
        let (period, count) = (Ps::from(self.active[1]) + 1, Ps::from(self.count));
        let updates = self.is_on(UIE) || self.is_on(UDE);
        let update = updates.then(|| period.saturating_sub(count).max(1));
        let compare = Ps::from(self.at(CCR1));
        let compares = self.is_on(CC1DE) && compare < period;
        let compare = compares.then(|| match compare.checked_sub(count) {
            None | Some(0) => (period + compare).saturating_sub(count).max(1),
            Some(left) => left,
        });
        let left = update.into_iter().chain(compare).min();
        let left = left.filter(|_| self.counts_time());
        left.map(|left| self.since + left * self.step(clock))
    }

    pub(super) const fn requests(&self, signal: ByteSignal) -> bool {
        self.waits[signal as usize]
    }

    pub(super) const fn serve(&mut self, signal: ByteSignal) {
        self.waits[signal as usize] = false;
    }

    pub(super) const fn interrupts(&self) -> bool {
        UIF.is_in(self.at(SR) & self.at(DIER))
    }

    pub(super) const fn set_position(&mut self, position: i32, connected: bool) {
        let moved = position.wrapping_sub(self.position);
        self.position = position;
        if connected && self.is_encoder() && self.is_on(CEN) {
            // From the reload value it goes on to zero, and the other way round.
            let range = self.at(ARR) as i64 + 1;
            self.count = (self.count as i64 + moved as i64).rem_euclid(range) as u32;
        }
    }

    /// Duty of channel 0 to 3, as a fraction: on and of how many counts.
    pub(super) fn duty(&self, channel: u32) -> (u32, u32) {
        let mode = self.at(CCMR1 + 4 * (channel / 2)) >> (8 * (channel % 2));
        let enabled = self.is_on(CEN)
            && CC1E.is_in(self.at(CCER) >> (4 * channel))
            && (self.is_on(MOE) || self.kind != Kind::Advanced);
        let period = self.at(ARR).saturating_add(1);
        let on = if enabled && OC1M.number_in(mode) == 6 {
            self.at(CCR1 + 4 * channel).min(period)
        } else {
            0
        };
        (on, period)
    }

    pub(super) fn read(&mut self, offset: u32, now: Ps, clock: Ps) -> Option<u32> {
        self.sync(now, clock);
        let value = match offset {
            EGR => 0,
            CNT => self.count,
            _ if has(self.kind, offset) => self.at(offset),
            _ => return None,
        };
        Some(value)
    }

    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps, clock: Ps) -> bool {
        self.sync(now, clock);
        let is_modelled = match offset {
            // Up-counting, edge aligned, without one-pulse mode.
            CR1 => value & !(CEN.bits | UDIS.bits | URS.bits | ARPE.bits) == 0,
            // The other modes of synchronisation are not modelled.
            SMCR => matches!(value, 0 | 3),
            DIER => {
                let is_there = !CC1DE.is_in(value) || has(self.kind, CCR1);
                is_there && value & !(UIE.bits | UDE.bits | CC1DE.bits) == 0
            }
            // The modes above 16 bits are not modelled.
            CCMR1 | CCMR2 => value <= 0xFFFF,
            _ => true,
        };
        if !is_modelled || !has(self.kind, offset) {
            return false;
        }
        self.registers[offset as usize / 4] = match offset {
            SR => self.at(SR) & value,
            PSC | BDTR => value & 0xFFFF,
            CNT | ARR | CCR1..=CCR4 => value & self.kind.mask(),
            _ => value,
        };
        match offset {
            DIER => {
                self.waits[UPDATE] &= UDE.is_in(value);
                self.waits[MATCH] &= CC1DE.is_in(value);
            }
            EGR if UG.is_in(value) => {
                (self.count, self.since) = (0, now);
                self.update(true);
            }
            CNT => (self.count, self.since) = (self.at(CNT), now),
            ARR if !self.is_on(ARPE) => self.active[1] = self.at(ARR),
            _ => {}
        }
        true
    }
}
