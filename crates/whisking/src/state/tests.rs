//! State that cannot rot: whatever bits a word of the pattern generator's state has, the
//! whiskers whisk as before within a few whisks.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use crate::gate::Gate;
use crate::muscle::History;
use crate::oscillator::PSI_LIMIT;
use crate::{
    Fix, GateSettings, Integrator, Number, Real, Settings, Side, State, WhiskerState, filter,
    muscle, noise, oscillator,
};

const TICK_HZ: f64 = 500.0;
const HZ: f64 = 4.0;
const WHISK: usize = 125;
/// Whisks that are looked at before and after.
const BEFORE: usize = 12;
const AFTER: usize = 30;
/// How far the ends of a whisk may be from those of whisks that nothing disturbed, θ.
const BACK: f64 = 0.01;

trait Bits: Copy {
    const WIDTH: u32;
    fn bits(self) -> u64;
    fn of(bits: u64) -> Self;
}

impl Bits for f32 {
    const WIDTH: u32 = 32;
    fn bits(self) -> u64 {
        self.to_bits().into()
    }
    fn of(bits: u64) -> Self {
        Self::from_bits(bits as u32)
    }
}

impl Bits for Fix {
    const WIDTH: u32 = 32;
    fn bits(self) -> u64 {
        self.0.cast_unsigned().into()
    }
    fn of(bits: u64) -> Self {
        Self(bits as i32)
    }
}

impl Bits for i64 {
    const WIDTH: u32 = 64;
    fn bits(self) -> u64 {
        self.cast_unsigned()
    }
    fn of(bits: u64) -> Self {
        bits.cast_signed()
    }
}

/// What becomes of a word: each bit turned over, and what is no number, or no sensible one.
fn spoilt<T: Bits>(word: T) -> impl Iterator<Item = T> {
    const WORDS: [u64; 10] = [
        0,
        !0,
        0x8000_0000_8000_0000,
        0x7FFF_FFFF_7FFF_FFFF,
        0x7F80_0000_7F80_0000,
        0xFF80_0000_FF80_0000,
        0x7F7F_FFFF_7F7F_FFFF,
        0x4180_0000_4180_0000,
        0xC180_0000_C180_0000,
        1,
    ];
    let flipped = (0..T::WIDTH).map(move |bit| word.bits() ^ (1 << bit));
    flipped.chain(WORDS).map(T::of)
}

enum Word<'a, R: Real> {
    Number(&'a mut R),
    Carry(&'a mut R::Carry),
}

/// Every word of a state, with the name of its part. States are taken apart without `..`, so
/// that no new word is forgotten.
struct Words<'a, R: Real>(Vec<(&'static str, Word<'a, R>)>);

impl<'a, R: Real> Words<'a, R> {
    fn of(state: &'a mut State<R>) -> Self {
        let State {
            oscillators: oscillator::State { kept, carry },
            sides,
            whiskers,
            noise: noise::State { random: _, filters },
        } = state;
        let mut all = Self(Vec::new());
        all.numbers("oscillators", kept.iter_mut().flatten());
        all.carries("oscillators", carry.iter_mut().flatten());
        for Side { z, drive } in sides {
            all.numbers("drive", [drive]);
            all.gate("z", z);
        }
        for whisker in whiskers {
            // Whose whisker it is belongs to the shape of the state.
            let WhiskerState {
                side: _,
                muscle,
                lift,
                nominal,
            } = whisker;
            let muscle::State {
                theta,
                kept,
                carry,
                history: History { force },
            } = muscle;
            all.numbers("muscle", [theta]);
            all.numbers("muscle", kept);
            all.carries("muscle", [carry]);
            all.numbers("history of the force", force);
            all.gate("g", lift);
            all.numbers("nominal g", nominal.copies_mut());
        }
        for filter::State { first, second } in filters.iter_mut().flatten() {
            all.numbers("filter", [first]);
            all.numbers("filter", second);
        }
        all
    }

    fn numbers(&mut self, part: &'static str, words: impl IntoIterator<Item = &'a mut R>) {
        let words = words.into_iter().map(|word| (part, Word::Number(word)));
        self.0.extend(words);
    }

    fn carries(&mut self, part: &'static str, words: impl IntoIterator<Item = &'a mut R::Carry>) {
        let words = words.into_iter().map(|word| (part, Word::Carry(word)));
        self.0.extend(words);
    }

    fn gate(&mut self, part: &'static str, gate: &'a mut Gate<R>) {
        let Gate { value, mean, carry } = gate;
        self.numbers(part, [value, mean]);
        self.carries(part, [carry]);
    }
}

/// A module of one whisker a side at 4 Hz, with every part that a state can have, or without
/// gates and noise; and how whisks that nothing disturbs end.
struct Bench<R: Real, const S: usize> {
    config: crate::Config<R>,
    start: State<R>,
    ends: [[f64; 2]; S],
}

impl<R: Number<Carry: Bits> + Bits, const S: usize> Bench<R, S> {
    fn new(integrator: Integrator, full: bool) -> Self {
        let gate = |gain| full.then_some(GateSettings { gain, tau_s: 0.125 });
        let settings = Settings {
            tick_hz: TICK_HZ,
            frequency_hz: HZ,
            integrator,
            coupling: true,
            noise: if full { 1e-4 } else { 0.0 },
            rcp: gate(0.7),
            cia: gate(0.5),
        };
        let psi = [[1.0, 0.0]; S];
        let start = settings.start::<R>(&psi, &[&[1.0][..]; S]).unwrap();
        let mut bench = Self {
            config: settings.build().unwrap(),
            start: State::new(&start, 1),
            ends: [[0.0; 2]; S],
        };
        let mut state = bench.start.clone();
        for _ in 0..BEFORE {
            bench.ends = bench.whisk(&mut state);
        }
        bench.start = state;
        bench
    }

    fn tick(&self, state: &mut State<R>) {
        self.config.step(state, &[R::ZERO; S]);
        for psi in self.config.oscillators.psi(&state.oscillators) {
            assert!(psi.iter().all(|x| x.to_f64().abs() <= PSI_LIMIT), "{psi:?}");
        }
        for theta in state.theta() {
            assert!(theta.to_f64().abs() <= 2.5, "{theta:?}");
        }
        // Gates that no part of the module moves are not looked at.
        for side in state.sides.iter().filter(|_| self.config.rcp.is_some()) {
            assert!((0.0..=1.0).contains(&side.z.value.to_f64()), "{side:?}");
        }
        let whiskers = state.whiskers.iter();
        for whisker in whiskers.filter(|_| self.config.cia.is_some()) {
            assert!((0.0..=2.0).contains(&whisker.gain()), "{whisker:?}");
        }
    }

    /// The lowest and the highest θ of each whisker in a whisk.
    fn whisk(&self, state: &mut State<R>) -> [[f64; 2]; S] {
        let mut ends = [[f64::MAX, f64::MIN]; S];
        for _ in 0..WHISK {
            self.tick(state);
            for ([low, high], theta) in ends.iter_mut().zip(state.theta()) {
                *low = low.min(theta.to_f64());
                *high = high.max(theta.to_f64());
            }
        }
        ends
    }

    /// How many whisks pass until they are again as they were, three in succession.
    fn whisks_until_back(&self, mut state: State<R>) -> usize {
        let is_back = |ends: [[f64; 2]; S]| {
            let mut pairs = ends.iter().flatten().zip(self.ends.iter().flatten());
            pairs.all(|(found, undisturbed)| (found - undisturbed).abs() <= BACK)
        };
        let (mut whisks, mut back) = (0, 0);
        while back < 3 && whisks < AFTER {
            whisks += 1;
            let is_back = is_back(self.whisk(&mut state));
            back = if is_back { back + 1 } else { 0 };
        }
        whisks - back
    }

    /// The most whisks of each part, over all words, what becomes of them, and some times.
    fn spoil(&self) -> Vec<(&'static str, usize)> {
        let mut most: Vec<(&'static str, usize)> = Vec::new();
        let mut state = self.start.clone();
        for _ in 0..2 {
            for _ in 0..WHISK * 4 / 10 {
                self.tick(&mut state);
            }
            for n in 0..Words::of(&mut state).0.len() {
                let spoil = |k: usize| -> Option<(&'static str, State<R>)> {
                    let mut copy = state.clone();
                    let (part, word) = Words::of(&mut copy).0.swap_remove(n);
                    match word {
                        Word::Number(word) => *word = spoilt(*word).nth(k)?,
                        Word::Carry(word) => *word = spoilt(*word).nth(k)?,
                    }
                    Some((part, copy))
                };
                for k in 0.. {
                    let Some((part, copy)) = spoil(k) else { break };
                    let whisks = self.whisks_until_back(copy);
                    match most.iter_mut().find(|(of, _)| *of == part) {
                        Some((_, most)) => *most = whisks.max(*most),
                        None => most.push((part, whisks)),
                    }
                }
            }
        }
        most
    }
}

/// Within how many whisks each part is back, at most, by the exact integrator and by forward
/// Euler. Sides that come out of step take longest: only their coupling brings them together.
const STATED: [(&str, [usize; 2]); 8] = [
    ("oscillators", [7, 7]),
    ("drive", [0, 1]),
    ("z", [2, 2]),
    ("muscle", [1, 2]),
    ("history of the force", [1, 0]),
    ("g", [2, 2]),
    ("nominal g", [0, 0]),
    ("filter", [0, 0]),
];

fn check<R: Number<Carry: Bits> + Bits, const S: usize>() {
    for (n, integrator) in [(0, Integrator::Exact), (1, Integrator::Euler)] {
        for full in [true, false] {
            for (part, whisks) in Bench::<R, S>::new(integrator, full).spoil() {
                let stated = STATED.iter().find(|(of, _)| *of == part);
                let is_stated = stated.is_some_and(|(_, most)| whisks <= most[n]);
                assert!(is_stated, "{integrator:?}, {full}: {part}, {whisks}");
            }
        }
    }
}

#[test]
fn whatever_bits_a_word_has_whisks_come_back_in_single_precision() {
    check::<f32, 2>();
    check::<f32, 1>();
}

#[test]
fn whatever_bits_a_word_has_whisks_come_back_in_fixed_point() {
    check::<Fix, 2>();
    check::<Fix, 1>();
}

/// The largest sum of the sides' ψ by which they count as opposed.
const OPPOSED: f64 = 0.2;

/// Not a word but all of it, at random: within its bounds after a tick, and back.
#[test]
fn whatever_bits_all_words_have_whisks_come_back() {
    fn run<R: Number<Carry: Bits> + Bits>() {
        for (integrator, most) in [(Integrator::Exact, 10), (Integrator::Euler, 15)] {
            let bench = Bench::<R, 2>::new(integrator, true);
            let mut random = Xoshiro128PlusPlus::seed_from_u64(7);
            for n in 0..400 {
                let mut state = bench.start.clone();
                for (_, word) in Words::of(&mut state).0 {
                    let bits = random.next_u64();
                    match word {
                        Word::Number(word) => *word = R::of(bits),
                        Word::Carry(word) => *word = <R::Carry as Bits>::of(bits),
                    }
                }
                bench.tick(&mut state);
                let psi = bench.config.oscillators.psi(&state.oscillators);
                let [left, right] = psi.into_array().unwrap();
                let sum = |k: usize| left[k].to_f64() + right[k].to_f64();
                let whisks = bench.whisks_until_back(state);
                // Sides that are quite opposed stay so by the equations, until noise parts them.
                let are_opposed = sum(0).hypot(sum(1)) < OPPOSED;
                let is_back = are_opposed || whisks <= most;
                assert!(is_back, "{integrator:?}, {n}: {whisks}");
            }
        }
    }
    run::<f32>();
    run::<Fix>();
}

/// Whichever side a whisker is said to be of, it stays within its bounds; without a side it
/// rests, and back at its side it whisks as before.
#[test]
fn a_whisker_of_no_side_rests() {
    fn run<R: Number<Carry: Bits> + Bits>() {
        let bench = Bench::<R, 2>::new(Integrator::Exact, true);
        for side in 0..=u8::MAX {
            let mut state = bench.start.clone();
            state.whiskers[1].side = side;
            let mut ends = [[0.0; 2]; 2];
            for _ in 0..5 {
                ends = bench.whisk(&mut state);
            }
            let [low, high] = ends[1];
            let rests = low.abs() < BACK && high.abs() < BACK;
            assert_eq!(rests, side > 1, "{side}: {ends:?}");
            state.whiskers[1].side = 1;
            assert!(bench.whisks_until_back(state) <= 2, "{side}");
        }
    }
    run::<f32>();
    run::<Fix>();
}
