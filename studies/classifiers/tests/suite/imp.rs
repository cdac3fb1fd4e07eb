//! The IMP against closed forms of simple signals, and against a double
//! precision version of its definition.

use std::f64::consts::TAU;

use classifiers::Error;
use classifiers::imp::{Band, Imp, ImpSweep, Peaks, deflection};
use proptest::prelude::*;

/// Codes a sample of one vibrissa's x and y, no window but the whole.
fn imp_of(signal: impl Iterator<Item = [f64; 2]>, band: u16) -> (f64, u32) {
    let mut peaks = Peaks::default();
    for [x, y] in signal {
        peaks.push(Band::new(band), x.round() as i16, y.round() as i16);
    }
    let count = peaks.count();
    (f64::from(peaks.take()) / 65536.0, count)
}

fn sine(offset: f64, amplitude: f64, period: f64) -> impl Iterator<Item = f64> {
    (0..4000).map(move |n| offset + amplitude * (TAU * f64::from(n) / period).sin())
}

/// The period divides by four, so that peaks fall on samples, and amplitude
/// and offset are whole: the forms hold to the bound of the integers.
#[test]
fn a_sine_has_twice_its_amplitude_times_frequency() {
    for (amplitude, period) in [(8000.0, 40.0), (100.0, 100.0), (30000.0, 8.0)] {
        let exact = 2.0 * amplitude / period;
        for turn in 0..2 {
            let pair = |r| if turn == 0 { [r, 0.0] } else { [0.0, r] };
            let (imp, count) = imp_of(sine(0.0, amplitude, period).map(pair), 0);
            let bound = exact / 32768.0 + 2.0 / 65536.0;
            assert!((exact - bound..=exact).contains(&imp), "{imp} {exact}");
            // Two a turn; the first has no period.
            assert_eq!(f64::from(count), 8000.0 / period - 1.0);
        }
    }
}

#[test]
fn an_offset_counts_as_amplitude_and_halves_the_peaks() {
    let (imp, count) = imp_of(sine(1200.0, 400.0, 80.0).map(|r| [r, 0.0]), 0);
    assert!((imp - 1600.0 / 80.0).abs() < 1e-3, "{imp}");
    assert_eq!(count, 49);
}

/// Which way a vibrissa bends does not matter, but for rounding to codes.
#[test]
fn it_is_the_same_in_every_direction() {
    let along = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        imp_of(sine(9000.0, 6000.0, 60.0).map(|r| [r * cos, r * sin]), 8).0
    };
    for degrees in [30.0, 45.0, 135.0, 260.0] {
        assert!(
            (along(degrees) / along(0.0) - 1.0).abs() < 2e-4,
            "{degrees}"
        );
    }
}

/// A whisker going round in a circle has no peaks, though x and y have.
#[test]
fn a_circle_has_none() {
    let round = (0..1000).map(|n| {
        let (sin, cos) = (TAU * f64::from(n) / 90.0).sin_cos();
        [8000.0 * cos, 8000.0 * sin]
    });
    // Rounding to codes moves the deflection by less than a code.
    assert_eq!(imp_of(round, 2), (0.0, 0));
}

/// Of r = |A sin φ|, peaks are where φ is an odd multiple of a quarter turn; those times are found by solving φ.
#[test]
fn a_chirp_has_the_mean_over_its_peaks() {
    let (amplitude, from, rise) = (20_000.0, 0.005, 0.000_015);
    let samples = 4000;
    // φ = τ (from n + rise n² / 2).
    let phase = |n: f64| TAU * (from * n + 0.5 * rise * n * n);
    let (imp, count) = imp_of(
        (0..samples).map(|n| [amplitude * phase(f64::from(n)).sin(), 0.0]),
        0,
    );
    let turns = |quarter: u32| 0.25 * f64::from(2 * quarter + 1);
    // from n + rise n² / 2 = turns.
    let time = |turns: f64| ((from * from + 2.0 * rise * turns).sqrt() - from) / rise;
    // From 5 to 65 turns in a thousand samples: 140 turns in all.
    let times: Vec<f64> = (0..300)
        .map(|quarter| time(turns(quarter)))
        .take_while(|&n| n < f64::from(samples - 1))
        .collect();
    assert!(times.len() < 300);
    assert_eq!(count as usize, times.len() - 1);
    let exact = times
        .windows(2)
        .map(|t| amplitude / (t[1] - t[0]))
        .sum::<f64>()
        / f64::from(count);
    // Peaks lie up to half a sample beside; at the end a period has eight.
    assert!((imp / exact - 1.0).abs() < 0.01, "{imp} {exact}");
}

#[test]
fn without_peaks_it_is_nought() {
    for signal in [
        (|n| n * 30.0) as fn(f64) -> f64,
        |n| 9000.0 - 9.0 * n,
        |_| 500.0,
    ] {
        let signal = (0..1000).map(|n| [signal(f64::from(n)), 0.0]);
        assert_eq!(imp_of(signal, 0), (0.0, 0));
    }
}

/// On a slow sine of noise ±6 codes, band nought finds the noise, a band of 20
/// the sine.
#[test]
fn a_band_keeps_noise_out() {
    let noisy = || {
        sine(3000.0, 1000.0, 200.0).enumerate().map(|(n, r)| {
            let noise = (n as u32).wrapping_mul(0x9E37_79B9) >> 16;
            [r + f64::from(noise % 13) - 6.0, 0.0]
        })
    };
    let exact = 4000.0 / 200.0;
    let (without, _) = imp_of(noisy(), 0);
    let (with, count) = imp_of(noisy(), 20);
    assert!(without > 20.0 * exact, "{without}");
    assert_eq!(count, 19);
    assert!((with / exact - 1.0).abs() < 0.01, "{with}");
}

#[test]
fn windows_share_peaks_out_and_lose_none() {
    // Peaks every 20 samples, of 10, 20, 30, … codes.
    let codes = |n: i32| {
        let top = 10 * (n / 20 + 1);
        (top - (n % 20 - 10).abs() * top / 10) as i16
    };
    let imp = Imp::<2>::new(100, Band::default()).unwrap();
    let mut state = imp.state();
    let mut sweep = ImpSweep::default();
    let mut windows = Vec::new();
    for n in 0..260 {
        if let Some(window) = imp.push(&mut state, &[[codes(n), 0], [0, 2 * codes(n)]]) {
            sweep.add(&window);
            windows.push(window.map(|w| f64::from(w) / 65536.0));
        }
    }
    // The peaks at 10, 30, …, 90 of 10 to 50: the first has no period.
    let first = (20.0 + 30.0 + 40.0 + 50.0) / 4.0 / 20.0;
    let second = (60.0 + 70.0 + 80.0 + 90.0 + 100.0) / 5.0 / 20.0;
    for (window, exact) in windows.iter().zip([first, second]) {
        assert!((window[0] - exact).abs() < 2e-4, "{window:?}");
        assert!((window[1] - 2.0 * exact).abs() < 4e-4, "{window:?}");
    }
    assert_eq!(windows.len(), 2);
    let last = imp.finish(&mut state).unwrap();
    sweep.add(&last);
    let third = (110.0 + 120.0 + 130.0) / 3.0 / 20.0;
    let sum = f64::from(sweep.sums()[0]) / 65536.0;
    assert!((sum - first - second - third).abs() < 6e-4, "{sum}");
    assert_eq!(state, imp.state());
    assert_eq!(imp.finish(&mut state), None);
    for _ in 0..3 {
        sweep.add(&[u32::MAX, 0]);
    }
    assert_eq!(sweep.sums()[0], i32::MAX);
}

#[test]
fn nothing_to_measure_is_refused() {
    let none = Imp::<0>::new(10, Band::default());
    assert_eq!(none, Err(Error::Channels));
    let none = Imp::<33>::new(0, Band::default());
    assert_eq!(none, Err(Error::Window(0)));
}

/// The definition, in double precision and with all deflections in hand: runs
/// between turning points by more than `band`.
fn defined(codes: &[[i16; 2]], band: f64) -> (f64, u32) {
    let r: Vec<f64> = codes
        .iter()
        .map(|[x, y]| f64::from(*x).hypot(f64::from(*y)))
        .collect();
    let mut tops: Vec<usize> = Vec::new();
    let (mut high, mut low, mut rising) = (0, 0, false);
    for n in 1..r.len() {
        if rising {
            if r[n] > r[high] {
                high = n;
            } else if r[high] > r[n] + band {
                tops.push(high);
                (rising, low) = (false, n);
            }
        } else if r[n] <= r[low] {
            low = n;
        } else if r[n] > r[low] + band {
            (rising, high) = (true, n);
        }
    }
    let rates = tops.windows(2).map(|t| r[t[1]] / (t[1] - t[0]) as f64);
    let count = tops.len().saturating_sub(1) as u32;
    (rates.sum::<f64>() / f64::from(count.max(1)), count)
}

proptest! {
    /// A walk with momentum, in any direction.
    #[test]
    fn integers_are_within_their_bound_of_the_definition(
        steps in prop::collection::vec((-90_i16..90, -90_i16..90), 3..400),
        band in 0_u16..120,
    ) {
        let mut at = [0_i16; 2];
        let codes: Vec<[i16; 2]> = steps.iter().map(|(x, y)| {
            at = [at[0] / 2 + x, at[1] / 3 + y];
            at
        }).collect();
        let mut peaks = Peaks::default();
        for [x, y] in &codes {
            peaks.push(Band::new(band), *x, *y);
        }
        let (exact, count) = defined(&codes, f64::from(band));
        prop_assert_eq!(peaks.count(), count);
        let found = f64::from(peaks.take()) / 65536.0;
        prop_assert!(found <= exact && found >= exact * (1.0 - 1.0 / 32768.0) - 2.0 / 65536.0,
            "{} {}", found, exact);
    }

    #[test]
    fn no_codes_upset_it(codes in prop::collection::vec(any::<[i16; 2]>(), 1..200), band: u16) {
        let imp = Imp::<1>::new(7, Band::new(band)).unwrap();
        let mut state = imp.state();
        for code in codes {
            prop_assert!(deflection(code[0], code[1]) <= 46341 << 16);
            if let Some([window]) = imp.push(&mut state, &[code]) {
                // The largest deflection, in the shortest period.
                prop_assert!(window <= (46341 << 16) / 2);
            }
        }
    }
}
