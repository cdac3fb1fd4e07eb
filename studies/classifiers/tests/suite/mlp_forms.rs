//! The embedded form of a network against the f64 one.

use crate::rows::{self, Random};
use classifiers::Error;
use classifiers::mlp::train::{NetworkTrainer, Options};
use classifiers::mlp::{Mlp, MlpInput, Network, Shape};
use proptest::prelude::*;

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

/// The f64 network against its single-precision form.
struct Off {
    /// Largest difference of an output.
    output: f64,
    /// Rows named differently.
    classes: usize,
    /// Part of the rows that the f64 network hits.
    hits: f64,
}

/// The outputs y for a whole row of inputs.
fn outputs<const I: usize, const H: usize, const O: usize>(
    mlp: &Mlp<I, H, O>,
    inputs: &[f32; I],
) -> [f32; O] {
    let mut state = mlp.state();
    let pushed = inputs.map(|x| mlp.push_for_outputs(&mut state, x));
    assert!(pushed[..I - 1].iter().all(Option::is_none));
    assert_eq!(state, mlp.state());
    pushed[I - 1].unwrap()
}

fn off<const I: usize, const H: usize, const O: usize>(
    network: &Network,
    rows: &[(usize, Vec<f64>)],
) -> Off {
    let single: Mlp<I, H, O> = network.single().unwrap();
    let mut off = Off {
        output: 0.0,
        classes: 0,
        hits: 0.0,
    };
    for (class, row) in rows {
        let exact = network.outputs(row).unwrap();
        let x: [f32; I] = std::array::from_fn(|i| row[i] as f32);
        for (y, exact) in outputs(&single, &x).into_iter().zip(exact) {
            off.output = off.output.max((f64::from(y) - exact).abs());
        }
        let best = network.classify(row).unwrap();
        let mut state = single.state();
        let named = x.map(|x| single.push(&mut state, x))[I - 1];
        off.classes += usize::from(named != Some(best));
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
            (5e-8..2e-6).contains(&off.output),
            "{name}: {:e}",
            off.output
        );
        assert_eq!(off.classes, 0, "{name}");
    }
}

fn small(weight: f32) -> Result<Mlp<2, 2, 2>, Error> {
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
fn a_network_written_down_is_that_made_from_f64() {
    let weights = [1.5, -1.0, 1.5, -1.0, 0.1, 0.2, 1.0, 2.0, 3.0, 4.0, 0.3, 0.4];
    let shape = Shape {
        inputs: 2,
        hidden: 2,
        outputs: 2,
    };
    let network = Network::new(shape, &[0.5, -0.5], &[2.0, 2.0], &weights).unwrap();
    assert_eq!(network.single(), small(1.5));
    let other = Error::Length {
        expected: 3,
        found: 2,
    };
    assert_eq!(network.single::<2, 2, 3>(), Err(other));
    // y_1 by hand: z = (1, 3), h = σ(0.1 + 6), σ(0.2 − 4).
    let sigma = |u: f64| 1.0 / (1.0 + (-u).exp());
    let exact = sigma(0.3 + sigma(6.1) + 2.0 * sigma(-3.8));
    assert!((network.outputs(&[1.0, 1.0]).unwrap()[0] - exact).abs() < 1e-15);
    assert_eq!(network.classify(&[1.0, 1.0]), Ok(1));
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    assert!(small(1e6).is_ok());
    for weight in [1.1e6, f32::NAN, f32::NEG_INFINITY] {
        assert_eq!(small(weight), Err(Error::Weight));
    }
    let input = MlpInput {
        offset: 0.0,
        gain: f32::NAN,
        weights: [0.0],
    };
    let made = Mlp::<1, 1, 2>::new([input], [0.0], [[0.0]; 2], [0.0; 2]);
    assert_eq!(made, Err(Error::Scale { input: 0 }));
    let made = Mlp::<0, 1, 2>::new([], [0.0], [[0.0]; 2], [0.0; 2]);
    assert_eq!(made, Err(Error::Inputs(0)));
}

proptest! {
    /// Whatever comes in, a class comes out, and the next row is not harmed.
    #[test]
    fn no_input_upsets_a_network(bits in prop::array::uniform3(any::<u32>())) {
        let input = MlpInput { offset: -3e38, gain: 3e38, weights: [1e6, -1e6] };
        let mlp = Mlp::<3, 2, 3>::new(
            [input; 3], [1e6; 2], [[1e6, -1e6], [0.5, 0.5], [-1e6, 1e6]], [0.0; 3],
        ).unwrap();
        let fresh = outputs(&mlp, &[0.0; 3]);
        let y = outputs(&mlp, &bits.map(f32::from_bits));
        prop_assert!(y.iter().all(|y| (0.0..=1.0).contains(y)));
        prop_assert_eq!(outputs(&mlp, &[0.0; 3]), fresh);
    }
}

/// What a network takes of flash and memory, by the formulas of its types.
#[test]
fn a_network_is_as_large_as_it_says() {
    assert_eq!(size_of::<Mlp<120, 20, 4>>(), 4 * (120 * 22 + 20 + 4 * 21));
    assert_eq!(size_of::<Mlp<33, 33, 8>>(), 4 * (33 * 35 + 33 + 8 * 34));
    assert_eq!(size_of::<classifiers::imp::ImpState<33>>(), 32 * 33 + 8);
}
