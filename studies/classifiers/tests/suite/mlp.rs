//! Networks against numpy, and training against what is known beforehand.

use crate::rows::{self, Random};
use classifiers::Error;
use classifiers::mlp::train::{NetworkTrainer, Options, Trained};
use classifiers::mlp::{Network, Shape};

fn options(hidden: usize) -> Options {
    Options {
        hidden,
        iterations: 400,
        decay: 0.0,
        ..Options::imp(1)
    }
}

fn train(options: Options, rows: &[(&str, Vec<f64>)]) -> Result<Trained, Error> {
    let mut trainer = NetworkTrainer::new(rows[0].1.len(), options)?;
    for (label, row) in rows {
        trainer.add(label, row)?;
    }
    trainer.train()
}

/// So many rows, of classes a, b and so on in turn.
fn rows_of(
    count: usize,
    classes: usize,
    mut row: impl FnMut(usize) -> Vec<f64>,
) -> Vec<(&'static str, Vec<f64>)> {
    (0..count)
        .map(|n| (["a", "b", "c"][n % classes], row(n)))
        .collect()
}

/// The networks of tests/reference/mlp.py, which printed the outputs.
#[test]
fn outputs_are_those_of_numpy() {
    let cases: [([usize; 3], &[f64]); 2] = [
        ([3, 4, 2], &[0.445_601_673_135_956_6, 0.512_941_465_174_771]),
        (
            [7, 5, 3],
            &[
                0.319_570_670_528_236_5,
                0.090_202_885_384_679_35,
                0.445_314_661_141_623_2,
            ],
        ),
    ];
    for ([inputs, hidden, outputs], exact) in cases {
        let shape = Shape {
            inputs,
            hidden,
            outputs,
        };
        let sines = |count: usize, f: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..count).map(|i| f(i as f64)).collect()
        };
        let network = Network::new(
            shape,
            &sines(inputs, &|i| (0.3 * i).sin()),
            &sines(inputs, &|i| 1.0 + 0.5 * (0.7 * i).sin()),
            &sines(shape.weights(), &|i| 1.5 * (1.0 + i).sin()),
        )
        .unwrap();
        let x = sines(inputs, &|i| 2.0 * (0.9 * i + 0.2).sin());
        let found = network.outputs(&x).unwrap();
        assert_eq!(found.len(), exact.len());
        for (y, exact) in found.iter().zip(exact) {
            assert!((y - exact).abs() < 1e-14, "{y} {exact}");
        }
    }
}

/// No network without a hidden layer can.
#[test]
fn exclusive_or_is_trained() {
    let rows: Vec<(&str, Vec<f64>)> = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)]
        .map(|(a, b)| (if a == b { "equal" } else { "different" }, vec![a, b]))
        .into();
    let trained = train(
        Options {
            reliable: 0.9,
            ..options(3)
        },
        &rows,
    )
    .unwrap();
    assert_eq!(trained.names, ["equal", "different"]);
    assert_eq!(trained.hit_rates, [1.0, 1.0]);
    assert!(trained.error < 0.01, "{}", trained.error);
    for (label, row) in &rows {
        let y = trained.network.outputs(row).unwrap();
        assert!((y[0] - f64::from(*label == "equal")).abs() < 0.02, "{y:?}");
    }
}

/// Two normal classes a distance of two standard deviations apart: no rule can
/// hit more than Φ(1) = 84.13 %.
#[test]
fn two_normal_classes_are_told_as_well_as_can_be() {
    let mut random = Random(7);
    let draw = |class: usize, random: &mut Random| -> Vec<f64> {
        let shift = 2.0 * class as f64 / 10.0_f64.sqrt();
        // Scales that the trainer has to find out.
        let scaled = |i: usize, x: f64| 1e3 + 10.0_f64.powi(i as i32 - 5) * x;
        (0..10)
            .map(|i| scaled(i, shift + random.normal()))
            .collect()
    };
    let rows = rows_of(4000, 2, |n| draw(n % 2, &mut random));
    let trained = train(
        Options {
            held_out: 0.15,
            patience: 6,
            ..options(4)
        },
        &rows,
    )
    .unwrap();
    let trials = 20_000;
    let hits = (0..trials)
        .filter(|n| trained.network.classify(&draw(n % 2, &mut random)).unwrap() == n % 2)
        .count();
    let rate = hits as f64 / f64::from(trials as u32);
    // Standard error 0.26 %; training on 4000 rows costs some tenths.
    assert!((0.828..0.850).contains(&rate), "{rate}");
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_another() {
    let mut random = Random(3);
    let rows = rows_of(60, 3, |n| rows::imp(n % 3, 6, &mut random));
    let once = train(options(4), &rows).unwrap();
    assert_eq!(once, train(options(4), &rows).unwrap());
    let other = Options {
        seed: 2,
        ..options(4)
    };
    assert_ne!(once.network, train(other, &rows).unwrap().network);
}

#[test]
fn a_penalty_shrinks_weights() {
    let mut random = Random(5);
    let rows = rows_of(60, 2, |n| rows::imp(n % 2, 6, &mut random));
    let size = |decay| {
        let with = Options {
            decay,
            ..options(4)
        };
        let weights = train(with, &rows).unwrap().network.weights().to_vec();
        weights.iter().map(|w| w * w).sum::<f64>()
    };
    let (free, held) = (size(0.0), size(1e-3));
    assert!(held < 0.25 * free, "{free} {held}");
}

/// Labels that say nothing: with samples held out, training ends soon, and the
/// training set is not memorised; without, it is.
#[test]
fn holding_out_stops_memorising() {
    let mut random = Random(11);
    let rows = rows_of(120, 2, |_| (0..30).map(|_| random.normal()).collect());
    let mean = |options| {
        let rates = train(options, &rows).unwrap().hit_rates;
        rates.iter().sum::<f64>() / rates.len() as f64
    };
    let stopped = Options {
        held_out: 0.3,
        patience: 3,
        ..options(10)
    };
    let (free, stopped) = (mean(options(10)), mean(stopped));
    // Some rows stay wrong where the outputs are flat.
    assert!(free > 0.94 && stopped < 0.9, "{free} {stopped}");
}

#[test]
fn an_input_that_is_constant_in_training_is_left_out() {
    let rows = rows_of(40, 2, |n| vec![(n % 2) as f64 + 0.01 * n as f64, 0.1]);
    let trained = train(options(3), &rows).unwrap();
    assert_eq!(trained.network.gain()[1], 0.0);
    let y = |constant| trained.network.outputs(&[0.5, constant]).unwrap();
    assert_eq!(y(0.1), y(1e6));
}

#[test]
fn what_cannot_be_trained_is_refused_by_name() {
    let made = |options| NetworkTrainer::new(2, options).map(|_| ());
    let base = options(3);
    let refused = |change: fn(&mut Options)| {
        let mut options = base;
        change(&mut options);
        made(options).unwrap_err()
    };
    assert_eq!(made(base), Ok(()));
    assert_eq!(refused(|o| o.decay = -0.1), Error::Decay(-0.1));
    assert!(matches!(
        refused(|o| o.held_out = f64::NAN),
        Error::HeldOut(_)
    ));
    assert_eq!(refused(|o| o.held_out = 0.6), Error::HeldOut(0.6));
    assert_eq!(refused(|o| o.reliable = 1.0), Error::Reliable(1.0));
    assert_eq!(refused(|o| o.attempts = 0), Error::NoAttempts);
    assert_eq!(refused(|o| o.hidden = 0), Error::Hidden(0));
    assert_eq!(
        NetworkTrainer::new(0, base).map(|_| ()),
        Err(Error::Inputs(0))
    );

    let mut trainer = NetworkTrainer::new(2, base).unwrap();
    assert_eq!(trainer.train(), Err(Error::NoSamples));
    assert_eq!(
        trainer.add("a", &[1.0]),
        Err(Error::Length {
            expected: 2,
            found: 1
        })
    );
    for x in [f64::NAN, f64::INFINITY, 1e39] {
        assert_eq!(
            trainer.add("a", &[1.0, x]),
            Err(Error::NotFinite {
                sample: 0,
                channel: 1
            })
        );
    }
    assert_eq!(trainer.add("", &[1.0, 1.0]), Err(Error::NameEmpty));
    assert_eq!(trainer.rows(), 0);
    trainer.add("a", &[1.0, 1.0]).unwrap();
    assert_eq!(trainer.train(), Err(Error::OneClass));
    // Both rows alike: no start can hit both classes.
    trainer.add("b", &[1.0, 1.0]).unwrap();
    assert_eq!(trainer.train(), Err(Error::NotReliable { attempts: 10 }));
    // Without a bar any start will do.
    let mut any = NetworkTrainer::new(
        2,
        Options {
            reliable: 0.0,
            ..base
        },
    )
    .unwrap();
    any.add("a", &[1.0, 1.0]).unwrap();
    any.add("b", &[1.0, 1.0]).unwrap();
    let rates = any.train().unwrap().hit_rates;
    assert_eq!(rates.iter().sum::<f64>(), 1.0, "all are named alike");
    // Deviation 1e-40: one over it is no f32.
    trainer.add("b", &[1.0, 1.0]).unwrap();
    let mut narrow = NetworkTrainer::new(1, base).unwrap();
    narrow.add("a", &[0.0]).unwrap();
    narrow.add("b", &[2e-40]).unwrap();
    assert_eq!(narrow.train(), Err(Error::Scale { input: 0 }));
}
