//! What nothing writes after the start, the settings, the model and what the classifier has
//! made of it: checked by a sum while the core is idle. A mismatch is a fault of the board,
//! and a reset makes anew what is in RAM.
//!
//! Some words of each are looked at in every tick: settings of 150 words once in ten ticks, a
//! model of 12 KiB once in 200.

use firmware::faults::number;

use super::faults;
use super::scene::{self, Perception, Settings};

/// Words of each that are looked at between two sleeps.
const WORDS: usize = 16;

/// Words that stay where and as they are.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    address: usize,
    words: usize,
}

impl Span {
    /// Those of something which stays where it is and which nobody writes from now on. A part
    /// of a word at its end is left out; there is none.
    pub(crate) fn of<T: ?Sized>(constant: &T) -> Self {
        Self {
            address: core::ptr::from_ref(constant).addr(),
            words: size_of_val(constant) / size_of::<u32>(),
        }
    }
}

/// Words that stay as they are, and a walk over them.
struct Region {
    span: Span,
    sum: u32,
    /// The fault that another sum is.
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

    /// Looks at some words more. Does not come back from a fault.
    fn step(&mut self) {
        let end = self.span.words.min(self.next.saturating_add(WORDS));
        self.so_far = self.add(self.so_far, self.next..end);
        self.next = end;
        if end < self.span.words {
            return;
        }
        if self.so_far != self.sum {
            faults::die(self.fault, || {});
        }
        self.next = 0;
        self.so_far = 0;
    }
}

/// The word that memory has at an address.
#[allow(
    unsafe_code,
    reason = "what is padding to the compiler is looked at too"
)]
fn word(address: usize) -> u32 {
    let word;
    // SAFETY: reads a word of a region, which lives for ever and which nobody writes.
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

/// The walk over all.
pub(crate) struct Integrity([Region; 4]);

impl Integrity {
    /// Their sums as they are now; both stay where they are.
    pub(crate) fn new(settings: &Settings, perception: &Perception) -> Self {
        let [model, classifier, factors] = scene::constants(perception);
        Self([
            Region::new(Span::of(settings), number::SETTINGS),
            Region::new(model, number::MODEL),
            Region::new(classifier, number::MODEL),
            Region::new(factors, number::MODEL),
        ])
    }

    /// Looks at some words more of each. Does not come back from a fault.
    pub(crate) fn step(&mut self) {
        for region in &mut self.0 {
            region.step();
        }
    }
}
