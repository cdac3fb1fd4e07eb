//! The detector recovers: whatever bits a word of it has, it soon finds touches again.

use super::quick::Quick;
use super::{TouchDetector, Touching};

/// Samples from a touch to the next, before it, and of it: at 2 kHz four touches a second.
const PERIOD: usize = 500;
const AIR: usize = 200;
const TOUCH: usize = 100;
/// Touches in a row that must be found, and how many the test waits for at most.
const IN_A_ROW: usize = 10;
const MOST: usize = 120;
/// After so many touches, of 0.25 s each, all are found again: the rest recovers slowest.
const STATED: usize = 72;

/// Codes of a whisker that swings slowly, with noise; each touch begins with a shock.
struct Codes {
    noise: u32,
    n: usize,
}

impl Codes {
    fn next(&mut self) -> [u16; 2] {
        let mut noise = || {
            self.noise = self
                .noise
                .wrapping_mul(1_664_525)
                .wrapping_add(1_013_904_223);
            f64::from(self.noise >> 24) / 16.0 - 8.0
        };
        let phase = self.n % PERIOD;
        let swing = 300.0 * (core::f64::consts::TAU * phase as f64 / PERIOD as f64).sin();
        let since = phase as f64 - AIR as f64;
        let is_touched = (0.0..TOUCH as f64).contains(&since);
        let bend = if is_touched {
            2_000.0 - 800.0 * (-since / 20.0).exp() * (since * 1.9).cos()
        } else {
            0.0
        };
        self.n += 1;
        [swing + bend, 0.3 * bend].map(|x| (8_192.0 + x + noise()) as u16)
    }
}

enum Word<'a> {
    U8(&'a mut u8),
    U16(&'a mut u16),
    U32(&'a mut u32),
    I32(&'a mut i32),
    Flag(&'a mut bool),
}

impl Word<'_> {
    /// Another content, the `k`th; whether there is one.
    fn spoil(self, k: u32) -> bool {
        const WORDS: [u32; 4] = [0, u32::MAX, 1 << 31, i32::MAX as u32];
        let width = match self {
            Self::U8(_) => 8,
            Self::U16(_) => 16,
            Self::U32(_) | Self::I32(_) => 32,
            Self::Flag(word) => {
                *word = !*word;
                return k == 0;
            }
        };
        let mask = match k.checked_sub(width) {
            None => None,
            Some(n) => match WORDS.get(n as usize) {
                Some(word) => Some(*word),
                None => return false,
            },
        };
        let other = |word: u32| mask.unwrap_or(word ^ (1 << (k % width)));
        match self {
            Self::U8(word) => *word = other((*word).into()) as u8,
            Self::U16(word) => *word = other((*word).into()) as u16,
            Self::U32(word) => *word = other(*word),
            Self::I32(word) => *word = other(word.cast_unsigned()).cast_signed(),
            Self::Flag(_) => {}
        }
        true
    }
}

/// Every word of a detector, taken apart without `..`, so that no new one is forgotten.
fn words(detector: &mut TouchDetector) -> Vec<Word<'_>> {
    let TouchDetector {
        kept,
        mean,
        rest,
        weights,
        quick,
        deflection,
        far,
        peak,
        // One of two, of which the board's code tells one.
        course: _,
        start,
        seen,
        of_block,
        quiet,
        apart,
        in_contact,
        in_touch,
        is_sure,
        touching: Touching { number, is_onset },
        last,
    } = detector;
    let mut all: Vec<Word<'_>> = kept.iter_mut().flatten().map(Word::U16).collect();
    let signed = mean.iter_mut().chain(rest).chain(weights);
    all.extend(signed.map(Word::I32));
    for quick in quick {
        let Quick {
            level,
            least,
            threshold,
            block,
            last,
            recent,
            began,
            at_onset,
            peak,
        } = quick;
        let words = [level, least, threshold, block, last, recent, at_onset, peak];
        all.extend(words.map(Word::U32));
        all.push(Word::Flag(began));
    }
    all.extend([deflection, far, peak].map(Word::U32));
    all.extend([start, seen, number, last].map(Word::U16));
    all.extend([of_block, quiet, apart].map(Word::U8));
    all.extend([in_contact, in_touch, is_sure, is_onset].map(Word::Flag));
    all
}

/// Whether the next touch is found within 10 ms of its beginning.
fn found(detector: &mut TouchDetector, codes: &mut Codes) -> bool {
    let mut found = false;
    for n in codes.n % PERIOD..PERIOD {
        let is_onset = detector.step(codes.next()).is_onset;
        found |= is_onset && (AIR..AIR + 20).contains(&n);
    }
    found
}

fn touches_until_back(detector: &mut TouchDetector, codes: &mut Codes) -> usize {
    let (mut touches, mut in_a_row) = (0, 0);
    while in_a_row < IN_A_ROW && touches < MOST {
        touches += 1;
        in_a_row = if found(detector, codes) {
            in_a_row + 1
        } else {
            0
        };
    }
    touches - in_a_row
}

#[test]
fn whatever_bits_a_word_has_touches_are_found_again() {
    let (mut detector, mut codes) = (TouchDetector::new(), Codes { noise: 1, n: 0 });
    assert!(touches_until_back(&mut detector, &mut codes) < 10);
    // In the air and in a touch.
    for at in [10, 210] {
        for _ in 0..at {
            detector.step(codes.next());
        }
        let (noise, n) = (codes.noise, codes.n);
        for word in 0..words(&mut detector).len() {
            for k in 0.. {
                let (mut spoilt, mut codes) = (detector.clone(), Codes { noise, n });
                if !words(&mut spoilt).swap_remove(word).spoil(k) {
                    break;
                }
                // The touch in which it happens may be lost.
                found(&mut spoilt, &mut codes);
                let back = touches_until_back(&mut spoilt, &mut codes);
                assert!(back <= STATED, "word {word}, {k}: {back}");
            }
        }
    }
}
