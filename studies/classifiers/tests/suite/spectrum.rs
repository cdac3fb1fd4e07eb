//! The spectrum against closed forms and NumPy, and the board's against the PC's.

use classifiers::Error;
use classifiers::spectrum::{Bank, Bins, Measure, Spectrum};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// The sum of the definition.
fn dft(x: &[f64], points: u32, k: u32) -> f64 {
    let (re, im) = x.iter().enumerate().fold((0.0, 0.0), |(re, im), (j, x)| {
        // In integers, so that the angle keeps its precision.
        let turn = (j as u64 * u64::from(k)) % u64::from(points);
        let angle = TAU * turn as f64 / f64::from(points);
        (re + x * angle.cos(), im - x * angle.sin())
    });
    f64::hypot(re, im)
}

/// Magnitudes of a bank over the samples, one block.
fn banked<const B: usize>(bins: &Bins, x: &[f64]) -> [f32; B] {
    let bank = Bank::<B>::new(bins, x.len() as u32).unwrap();
    let mut state = bank.state();
    for (n, &x) in x.iter().enumerate() {
        assert_eq!(
            bank.push(&mut state, x as f32),
            n + 1 == bank.block() as usize
        );
    }
    bank.read(&state, Measure::Magnitude)
}

/// The largest difference of bank and FFT, beside Σ|x|.
fn worst<const B: usize>(bins: Bins, x: &[f64]) -> f64 {
    let fft = Spectrum::new(bins, x.len())
        .unwrap()
        .of(x.iter().copied(), Measure::Magnitude)
        .unwrap();
    let bank = banked::<B>(&bins, x);
    let all: f64 = x.iter().map(|x| x.abs()).sum();
    let difference = |(a, b): (&f64, f32)| (a - f64::from(b)).abs() / all;
    fft.iter().zip(bank).map(difference).fold(0.0, f64::max)
}

#[test]
fn a_sine_is_one_bin_of_half_its_samples() {
    // 35 Hz at 2 kHz is bin 14 of 800; amplitude 3 gives 3 · 800 / 2.
    let x: Vec<f64> = (0..800)
        .map(|n| 3.0 * (TAU * 35.0 * f64::from(n) / 2000.0 + 0.4).sin() + 2.0)
        .collect();
    let bins = Bins::between(800, 2000.0, 2.5, 120.0).unwrap();
    assert_eq!((bins.first, bins.count), (1, 48));
    let fft = Spectrum::new(bins, 800)
        .unwrap()
        .of(x.iter().copied(), Measure::Magnitude)
        .unwrap();
    let bank = banked::<48>(&bins, &x);
    for (n, (fft, bank)) in fft.iter().zip(bank).enumerate() {
        let known = if n == 13 { 1200.0 } else { 0.0 };
        assert!((fft - known).abs() < 1e-9, "{n}: {fft}");
        assert!((f64::from(bank) - known).abs() < 0.02, "{n}: {bank}");
    }
    assert!((bins.frequency(13, 2000.0) - 35.0).abs() < 1e-12);
    let power = Spectrum::new(bins, 800)
        .unwrap()
        .of(x.iter().copied(), Measure::Power)
        .unwrap();
    assert!((power[13] / 1_440_000.0 - 1.0).abs() < 1e-12);
}

#[test]
fn numpy_gives_the_same() {
    // abs(numpy.fft.rfft(x, 12))[:7] of x = [1, -2, 3.5, 0, 4, -1, 0.25, 7]:
    // see fit/spectrum.py.
    let x = [1.0, -2.0, 3.5, 0.0, 4.0, -1.0, 0.25, 7.0];
    let known: Vec<f64> = include_str!("../reference/spectrum.csv")
        .lines()
        .map(|line| line.parse().unwrap())
        .collect();
    let bins = Bins::all(12);
    let fft = Spectrum::new(bins, 8)
        .unwrap()
        .of(x.iter().copied(), Measure::Magnitude)
        .unwrap();
    assert_eq!(fft.len(), known.len());
    let bank = banked::<7>(&bins, &x);
    for ((fft, known), bank) in fft.iter().zip(known).zip(bank) {
        assert!((fft - known).abs() < 1e-13, "{fft} {known}");
        assert!((f64::from(bank) - known).abs() < 3e-6, "{bank} {known}");
    }
}

/// Noise with a mean, as a whisker that is dragged.
fn noise(seed: u64, length: usize, mean: f64) -> Vec<f64> {
    let mut state = 2 * seed + 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut smooth = 0.0;
    (0..length)
        .map(|_| {
            smooth += 0.1 * (next() - smooth);
            mean + smooth
        })
        .collect()
}

#[test]
fn board_and_pc_agree_at_the_papers_sizes() {
    for seed in 1..=5 {
        for mean in [0.0, 0.3, 5.0] {
            // LEP12: 400 ms at 2 kHz, to 120 Hz; as it is, and filled to 1 Hz.
            let x = noise(seed, 800, mean);
            let own = worst::<48>(Bins::between(800, 2000.0, 2.5, 120.0).unwrap(), &x);
            let filled = worst::<120>(Bins::between(2000, 2000.0, 1.0, 120.0).unwrap(), &x);
            // POSE: 3 s at 4 kHz, 6 Hz to 1 kHz.
            let x = noise(seed, 12_000, mean);
            let wide = Bins {
                points: 12_000,
                first: 18,
                step: 3,
                count: 995,
            };
            let pose = worst::<995>(wide, &x);
            println!("{seed} {mean}: {own:e} {filled:e} {pose:e}");
            assert!(own.max(filled).max(pose) < 3e-6);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any block, any points at least as many, all bins up to half the rate.
    #[test]
    fn both_are_the_sum_of_the_definition(
        x in prop::collection::vec(-100.0_f64..100.0, 1..200),
        filled in 62_u32..64,
        first in 0_u32..3,
        step in 1_u32..4,
    ) {
        let points = x.len() as u32 + filled;
        let bins = Bins { points, first, step, count: 8 };
        let fft = Spectrum::new(bins, x.len()).unwrap().of(x.iter().copied(), Measure::Magnitude).unwrap();
        let bank = banked::<8>(&bins, &x);
        let all: f64 = x.iter().map(|x| x.abs()).sum();
        for ((k, fft), bank) in bins.indices().zip(fft).zip(bank) {
            let known = dft(&x, points, k);
            prop_assert!((fft - known).abs() <= 1e-13 * all + 1e-13, "{k}: {fft} {known}");
            prop_assert!((f64::from(bank) - known).abs() <= 3e-6 * all, "{k}: {bank} {known}");
        }
        let high = Bins { points, first: points / 2 - 7, step: 1, count: 8 };
        for (k, bank) in high.indices().zip(banked::<8>(&high, &x)) {
            let known = dft(&x, points, k);
            prop_assert!((f64::from(bank) - known).abs() <= 3e-6 * all, "{k}: {bank} {known}");
        }
    }
}

#[test]
fn a_new_block_begins_by_itself_and_a_constant_bank_is_the_same() {
    let bins = Bins {
        points: 10,
        first: 1,
        step: 1,
        count: 3,
    };
    let bank = Bank::<3>::new(&bins, 10).unwrap();
    let (factors, low, block) = bank.parts();
    let copy = Bank::from_parts(*factors, low, block);
    assert_eq!(bank, copy);
    let mut state = bank.state();
    let mut spectra = Vec::new();
    for x in (0..20_u8).map(|n| f32::from(n % 10)) {
        if copy.push(&mut state, x) {
            spectra.push(copy.read(&state, Measure::Power));
        }
    }
    assert_eq!(spectra.len(), 2);
    assert_eq!(spectra[0], spectra[1]);
    // No part can make it panic.
    let odd = Bank::<3>::from_parts([f32::NAN; 3], 99, 0);
    let mut state = odd.state();
    assert!(odd.push(&mut state, f32::INFINITY));
}

#[test]
fn what_is_wrong_is_named() {
    let all = Bins::all(8);
    assert_eq!(Bins { points: 0, ..all }.check(), Err(Error::Points(0)));
    for bins in [
        Bins { count: 6, ..all },
        Bins { count: 0, ..all },
        Bins { step: 0, ..all },
        Bins { first: 1, ..all },
        Bins {
            count: usize::MAX,
            step: u32::MAX,
            ..all
        },
    ] {
        assert_eq!(bins.check(), Err(Error::Bins), "{bins:?}");
    }
    assert!(Bins::between(800, 2000.0, 10.0, 5.0).is_err());
    assert!(Bins::between(800, 2000.0, 10.0, 1003.0).is_err());
    assert!(Bins::between(800, f64::NAN, 10.0, 100.0).is_err());
    assert!(Bins::between(800, 2000.0, -10.0, 100.0).is_err());
    let block = |block| Error::Block { block, points: 8 };
    assert_eq!(Spectrum::new(all, 9).err(), Some(block(9)));
    assert_eq!(Spectrum::new(all, 0).err(), Some(block(0)));
    let mut spectrum = Spectrum::new(all, 8).unwrap();
    assert_eq!(spectrum.of([0.0; 7], Measure::Power), Err(block(7)));
    assert_eq!(spectrum.of([0.0; 9], Measure::Power), Err(block(9)));
    let length = Error::Length {
        expected: 4,
        found: 5,
    };
    assert_eq!(Bank::<4>::new(&all, 8).err(), Some(length));
}
