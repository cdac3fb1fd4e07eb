//! What nothing writes after the start, the settings, the model, what the classifier has made of
//! it and where the motors' PWMs are: checked by a sum while the core is idle. A mismatch is a
//! fault of the board, and a reset reconstructs what is in RAM.
//!
//! Other settings may take the place of these, and change the rule of the classifier with them.
//! Then the tick that takes them over holds both against their sums just before, and gives them
//! new ones just after ([`Changed`]): nothing else renews a sum.
//!
//! Some words of each are looked at in every tick: settings of 180 words once in twelve ticks, a
//! model of 12 KiB once in 200.

use core::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use firmware::faults::number;

use super::types::{Inner, Settings};
use super::{faults, motors, pace, perception};

/// Words of each that are looked at between two sleeps.
const WORDS: usize = 16;

/// Words that stay where and as they are.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub(crate) address: usize,
    pub(crate) words: usize,
}

impl Span {
    pub(crate) const NONE: Self = Self {
        address: 0,
        words: 0,
    };

    /// Those of something which stays where it is and which nothing writes from now on. A part
    /// of a word at its end is left out; there is none.
    pub(crate) fn of<T: ?Sized>(constant: &T) -> Self {
        Self {
            address: core::ptr::from_ref(constant).addr(),
            words: size_of_val(constant) / size_of::<u32>(),
        }
    }
}

struct Region {
    span: Span,
    sum: u32,
    fault: u8,
    /// The word that is next, and the sum of those before it.
    next: usize,
    so_far: u32,
}

impl Region {
    fn new(span: Span, fault: u8) -> Self {
        let mut region = Self {
            span,
            sum: 0,
            fault,
            next: 0,
            so_far: 0,
        };
        region.sum = region.add(0, 0..span.words);
        region
    }

    /// Any change of one word changes the sum, and so does a change of their order.
    fn add(&self, sum: u32, words: core::ops::Range<usize>) -> u32 {
        words.fold(sum, |sum, n| {
            sum.rotate_left(1)
                .wrapping_add(word(self.span.address + n * size_of::<u32>()))
        })
    }

    /// After so many [`CHANGES`]. Does not come back from a fault.
    fn step(&mut self, changes: u32) {
        let end = self.span.words.min(self.next.saturating_add(WORDS));
        self.so_far = self.add(self.so_far, self.next..end);
        self.next = end;
        if end < self.span.words {
            return;
        }
        let is_whole = self.so_far == self.sum;
        self.next = 0;
        self.so_far = 0;
        // A tick that has changed it meanwhile has done so before it counted.
        if !is_whole && CHANGES.load(Ordering::Relaxed) == changes {
            faults::die(self.fault, || {});
        }
    }

    fn holds(&self) -> bool {
        self.add(0, 0..self.span.words) == self.sum
    }

    const fn renew(&mut self, sum: u32) {
        self.sum = sum;
        self.next = 0;
        self.so_far = 0;
    }
}

/// How often the tick has changed what is to stay; where settings lie since, and sums. Idle reads
/// them.
static CHANGES: AtomicU32 = AtomicU32::new(0);
static SETTINGS_AT: AtomicUsize = AtomicUsize::new(0);
static SUMS: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];

pub(crate) fn changes() -> u32 {
    CHANGES.load(Ordering::Relaxed)
}

/// Settings and classifier around a change by the tick.
pub(crate) struct Changed([Region; 2]);

impl Changed {
    pub(crate) fn new(settings: &Settings, inner: &Inner) -> Self {
        let [_, classifier, _] = perception::constants(inner);
        Self([
            Region::new(Span::of(settings), number::SETTINGS),
            Region::new(classifier, number::MODEL),
        ])
    }

    /// Before a change. Where one is not what it was, nothing must change: idle's walk will find
    /// the fault.
    pub(crate) fn holds(&self) -> bool {
        self.0.iter().all(Region::holds)
    }

    /// After it: these settings take the place of those before, and sums are renewed.
    pub(crate) fn after(&mut self, settings: &Settings) {
        let [of_settings, _] = &mut self.0;
        of_settings.span = Span::of(settings);
        SETTINGS_AT.store(of_settings.span.address, Ordering::Relaxed);
        for (region, sum) in self.0.iter_mut().zip(&SUMS) {
            region.renew(region.add(0, 0..region.span.words));
            sum.store(region.sum, Ordering::Relaxed);
        }
        let changes = CHANGES.load(Ordering::Relaxed);
        CHANGES.store(changes.wrapping_add(1), Ordering::Release);
    }
}

#[allow(
    unsafe_code,
    reason = "what is padding to the compiler is looked at too"
)]
fn word(address: usize) -> u32 {
    let word;
    // SAFETY: reads an aligned word that lives for ever; before or after a change it is a word.
    unsafe {
        core::arch::asm!(
            "ldr {word}, [{address}]",
            word = out(reg) word,
            address = in(reg) address,
            options(nostack, readonly, preserves_flags)
        );
    }
    word
}

/// The walk over all, the settings and the classifier first.
pub(crate) struct Integrity {
    regions: [Region; 7],
    /// Of [`CHANGES`], those whose sums it has.
    changes: u32,
}

impl Integrity {
    /// Their sums as they are now; both stay where they are.
    pub(crate) fn new(settings: &Settings, inner: &Inner) -> Self {
        let [model, classifier, factors] = perception::constants(inner);
        let mut motors = inner
            .whiskers()
            .iter()
            .filter_map(|whisker| whisker.servo());
        let mut pwms = || {
            let servo = motors.next();
            servo.map_or(Span::NONE, |servo| servo.motor().constants())
        };
        let spans = [
            (Span::of(settings), number::SETTINGS),
            (classifier, number::MODEL),
            (model, number::MODEL),
            (factors, number::MODEL),
            (Span::of(pace::constants()), number::SETTINGS),
            (pwms(), number::SETTINGS),
            (pwms(), number::SETTINGS),
        ];
        // Called in a row it would be by a pointer, which no check of the stack can follow.
        let regions = spans.map(|(span, fault)| Region::new(span, fault));
        Self {
            regions,
            changes: 0,
        }
    }

    /// Does not come back from a fault.
    pub(crate) fn step(&mut self) {
        let changes = CHANGES.load(Ordering::Acquire);
        if changes != self.changes {
            self.changes = changes;
            let [of_settings, ..] = &mut self.regions;
            of_settings.span.address = SETTINGS_AT.load(Ordering::Relaxed);
            for (region, sum) in self.regions.iter_mut().zip(&SUMS) {
                region.renew(sum.load(Ordering::Relaxed));
            }
        }
        for region in &mut self.regions {
            region.step(changes);
        }
        if motors::is_lost() {
            faults::die(number::SETTINGS, || {});
        }
    }
}
