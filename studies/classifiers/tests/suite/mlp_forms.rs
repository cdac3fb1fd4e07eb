//! The embedded forms of a network against the f64 one, and its file.

use crate::rows::{self, Random};
use classifiers::mlp::train::{NetworkTrainer, Options};
use classifiers::mlp::{FixedInput, FixedMlp, Mlp, MlpError, MlpInput, Network, Shape};
use proptest::prelude::*;
use tactile::Aligned;

/// Trains to tell made-up rows, and yields as many new ones.
fn train(
    options: Options,
    classes: usize,
    make: impl Fn(usize, &mut Random) -> Vec<f64>,
) -> (Network, Vec<(usize, Vec<f64>)>) {
    let mut random = Random(options.seed);
    let rows = |random: &mut Random| -> Vec<(usize, Vec<f64>)> {
        (0..60 * classes)
            .map(|n| (n % classes, make(n % classes, random)))
            .collect()
    };
    let training = rows(&mut random);
    let mut trainer = NetworkTrainer::new(training[0].1.len(), options).unwrap();
    for (class, row) in &training {
        trainer.add(&format!("{class}"), row).unwrap();
    }
    (trainer.train().unwrap().network, rows(&mut random))
}

fn spectra() -> (Network, Vec<(usize, Vec<f64>)>) {
    train(Options::spectrum(1), 4, |class, random| {
        rows::spectrum(class, 120, random)
    })
}

fn imps() -> (Network, Vec<(usize, Vec<f64>)>) {
    train(Options::imp(1), 8, |class, random| {
        rows::imp(class, 33, random)
    })
}

/// What the forms of a network differ from it by.
struct Off {
    single: f64,
    fixed: f64,
    /// Classes that differ, single and fixed.
    classes: [usize; 2],
    /// Part of the rows that the f64 network hits.
    hits: f64,
}

fn off<const I: usize, const H: usize, const O: usize>(
    network: &Network,
    rows: &[(usize, Vec<f64>)],
) -> Off {
    let single: Mlp<I, H, O> = network.single().unwrap();
    let fixed: FixedMlp<I, H, O> = network.fixed().unwrap();
    let mut off = Off {
        single: 0.0,
        fixed: 0.0,
        classes: [0, 0],
        hits: 0.0,
    };
    for (class, row) in rows {
        let exact = network.outputs(row).unwrap();
        let x: [f32; I] = std::array::from_fn(|i| row[i] as f32);
        let whole: [i32; I] = std::array::from_fn(|i| row[i] as i32);
        let mut state = fixed.state();
        let pushed = whole.map(|x| fixed.push_for_outputs(&mut state, x));
        assert!(pushed[..I - 1].iter().all(Option::is_none));
        let y_fixed = pushed[I - 1].unwrap();
        assert_eq!(state, fixed.state());
        let y_single = single.outputs(&x);
        for k in 0..O {
            off.single = off.single.max((f64::from(y_single[k]) - exact[k]).abs());
            let y = f64::from(y_fixed[k]) / 32768.0;
            off.fixed = off.fixed.max((y - exact[k]).abs());
        }
        let best = network.classify(row).unwrap();
        off.classes[0] += usize::from(single.classify(&x) != best);
        off.classes[1] += usize::from(fixed.classify(&whole) != best);
        off.hits += f64::from(best == *class) / rows.len() as f64;
    }
    off
}

#[test]
fn the_single_precision_form_is_within_its_bound() {
    let (network, rows) = spectra();
    let spectrum = off::<120, 20, 4>(&network, &rows);
    let (network, rows) = imps();
    let imp = off::<33, 33, 8>(&network, &rows);
    for (off, name) in [(&spectrum, "spectrum"), (&imp, "imp")] {
        // Trained in earnest: a network that knows nothing would be easy.
        assert!(off.hits > 0.8, "{name}: {}", off.hits);
        assert!(
            (5e-8..2e-6).contains(&off.single),
            "{name}: {:e}",
            off.single
        );
        assert_eq!(off.classes[0], 0, "{name}");
    }
}

#[test]
fn the_fixed_form_is_within_its_bound() {
    let (network, rows) = spectra();
    let spectrum = off::<120, 20, 4>(&network, &rows);
    let (network, rows) = imps();
    let imp = off::<33, 33, 8>(&network, &rows);
    for (off, name, count) in [(&spectrum, "spectrum", 240), (&imp, "imp", 480)] {
        assert!((1e-4..3e-3).contains(&off.fixed), "{name}: {:e}", off.fixed);
        // At most one row in two hundred lies so near an edge.
        assert!(off.classes[1] * 200 <= count, "{name}: {:?}", off.classes);
    }
}

fn small(weight: f32) -> Result<Mlp<2, 2, 2>, MlpError> {
    let input = |offset| MlpInput {
        offset,
        gain: 2.0,
        weights: [weight, -1.0],
    };
    Mlp::new(
        [input(0.5), input(-0.5)],
        [0.1, 0.2],
        [[1.0, 2.0], [3.0, 4.0]],
        [0.3, 0.4],
    )
}

#[test]
fn a_network_written_down_is_that_of_its_file() {
    let weights = [1.5, -1.0, 1.5, -1.0, 0.1, 0.2, 1.0, 2.0, 3.0, 4.0, 0.3, 0.4];
    let shape = Shape {
        inputs: 2,
        hidden: 2,
        outputs: 2,
    };
    let network = Network::new(shape, &[0.5, -0.5], &[2.0, 2.0], &weights).unwrap();
    assert_eq!(network.single(), small(1.5));
    // y_1 by hand: z = (1, 3), h = σ(0.1 + 6), σ(0.2 − 4).
    let sigma = |u: f64| 1.0 / (1.0 + (-u).exp());
    let exact = sigma(0.3 + sigma(6.1) + 2.0 * sigma(-3.8));
    assert!((network.outputs(&[1.0, 1.0]).unwrap()[0] - exact).abs() < 1e-15);
    assert_eq!(network.classify(&[1.0, 1.0]), Ok(1));
}

#[test]
fn a_damaged_file_is_refused_by_name() {
    let shape = Shape {
        inputs: 2,
        hidden: 2,
        outputs: 2,
    };
    let network = Network::new(shape, &[0.0; 2], &[1.0; 2], &[0.5; 12]).unwrap();
    let bytes = network.to_bytes();
    // Header 12, numbers 4 · 16, checksum 4.
    assert_eq!(bytes.len(), 80);
    let mut aligned = Aligned([0_u8; 84]);
    aligned.0[..80].copy_from_slice(&bytes);
    assert_eq!(
        Mlp::<2, 2, 2>::parse(&aligned.0[..80]),
        Ok(&network.single().unwrap())
    );
    aligned.0.copy_within(0..80, 1);
    assert_eq!(
        Mlp::<2, 2, 2>::parse(&aligned.0[1..81]),
        Err(MlpError::Misaligned)
    );
    assert!(Mlp::<2, 2, 2>::copied(&aligned.0[1..81]).is_ok());

    let shape = MlpError::Shape {
        inputs: 2,
        hidden: 2,
        outputs: 2,
    };
    assert_eq!(Mlp::<2, 2, 3>::copied(&bytes), Err(shape));
    let damaged = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at] ^= 1;
        Mlp::<2, 2, 2>::copied(&bytes).unwrap_err()
    };
    assert_eq!(damaged(0), MlpError::BadMagic);
    assert_eq!(damaged(4), MlpError::UnknownVersion(0));
    for at in 12..80 {
        assert_eq!(damaged(at), MlpError::Checksum);
    }
    for length in 0..80 {
        assert!(Mlp::<2, 2, 2>::copied(&bytes[..length]).is_err());
    }
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    assert!(small(1e6).is_ok());
    for weight in [1.1e6, f32::NAN, f32::NEG_INFINITY] {
        assert_eq!(small(weight), Err(MlpError::Weight));
    }
    let input = MlpInput {
        offset: 0.0,
        gain: f32::NAN,
        weights: [0.0],
    };
    let made = Mlp::<1, 1, 2>::new([input], [0.0], [[0.0]; 2], [0.0; 2]);
    assert_eq!(made, Err(MlpError::Scale { input: 0 }));
    let made = Mlp::<0, 1, 2>::new([], [0.0], [[0.0]; 2], [0.0; 2]);
    assert_eq!(made, Err(MlpError::Inputs(0)));

    let fixed = |gain, shift, weight, bits| {
        let input = FixedInput {
            offset: 0,
            gain,
            shift,
            weights: [weight],
        };
        FixedMlp::<3, 1, 2>::new([input; 3], [0], [[1]; 2], [0; 2], [bits, 14]).map(|_| ())
    };
    assert_eq!(fixed(1 << 16, 35, 21_845, 14), Ok(()));
    // 3 · 21846 · 2¹⁵ is above 2³¹ − 1.
    assert_eq!(fixed(1 << 16, 35, 21_846, 14), Err(MlpError::Weight));
    assert_eq!(fixed(1, 0, 1, 1), Err(MlpError::Weight));
    assert_eq!(fixed(1, 36, 1, 14), Err(MlpError::FixedScale { input: 0 }));
    let wrong = fixed((1 << 16) + 1, 0, 1, 14);
    assert_eq!(wrong, Err(MlpError::FixedScale { input: 0 }));
}

proptest! {
    /// Whatever comes in, a class comes out, and the next row is not harmed.
    #[test]
    fn no_input_upsets_a_network(bits in prop::array::uniform3(any::<u32>())) {
        let input = MlpInput { offset: -3e38, gain: 3e38, weights: [1e6, -1e6] };
        let mlp = Mlp::<3, 2, 3>::new(
            [input; 3], [1e6; 2], [[1e6, -1e6], [0.5, 0.5], [-1e6, 1e6]], [0.0; 3],
        ).unwrap();
        let fresh = mlp.outputs(&[0.0; 3]);
        let mut state = mlp.state();
        let y = bits.map(|b| mlp.push_for_outputs(&mut state, f32::from_bits(b)));
        let y = y[2].unwrap();
        prop_assert!(y.iter().all(|y| (0.0..=1.0).contains(y)));
        prop_assert_eq!(&state, &mlp.state());
        prop_assert_eq!(mlp.outputs(&[0.0; 3]), fresh);

        let input = FixedInput { offset: i32::MIN, gain: 1 << 16, shift: 0, weights: [21_000, -21_000] };
        let fixed = FixedMlp::<3, 2, 3>::new(
            [input; 3], [0; 2], [[32_000, -32_000], [9, 9], [-32_000, 32_000]], [0; 3], [2, 2],
        ).unwrap();
        let x = bits.map(|b| b as i32);
        prop_assert!(fixed.classify(&x) < 3);
    }
}

/// What a network takes of flash and memory, by the formulas of its types.
#[test]
fn a_network_is_as_large_as_it_says() {
    assert_eq!(size_of::<Mlp<120, 20, 4>>(), 4 * (120 * 22 + 20 + 4 * 21));
    assert_eq!(size_of::<Mlp<33, 33, 8>>(), 4 * (33 * 35 + 33 + 8 * 34));
    let fixed = 120 * (12 + 40) + 4 * 20 + 4 * (40 + 4) + 8;
    assert_eq!(size_of::<FixedMlp<120, 20, 4>>(), fixed);
    let odd = 33 * (12 + 66 + 2) + 4 * 33 + 8 * (66 + 4) + 8;
    assert_eq!(size_of::<FixedMlp<33, 33, 8>>(), odd);
    assert_eq!(size_of::<classifiers::imp::ImpState<33>>(), 32 * 33 + 8);
}
