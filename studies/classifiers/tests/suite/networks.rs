//! Networks as recognisers: on spectra of blocks, on the IMP of sweeps and of
//! corridors.

use std::f64::consts::TAU;

use crate::rows::Random;
use classifiers::imp::{Band, ImpError, ImpFeatures, ImpSweepRecogniser, ImpVoteRecogniser};
use classifiers::mlp::train::{NetworkTrainer, Options};
use classifiers::mlp::{MlpError, Network, Shape, SpectrumInputs, SpectrumRecogniser};
use classifiers::recogniser::{Recogniser, first_outcome, outcomes};

const RATE_HZ: f64 = 2000.0;

/// x and y of a whisker on one of four floors: a resonance at 30 Hz and more,
/// in noise.
fn block(floor: usize, random: &mut Random) -> Vec<f64> {
    let hz = 30.0 + 8.0 * floor as f64;
    let phase = random.unit();
    (0..800)
        .flat_map(|n| {
            let turn = TAU * (hz * f64::from(n) / RATE_HZ + phase);
            [
                turn.sin() + random.normal(),
                0.3 * turn.cos() + random.normal(),
            ]
        })
        .collect()
}

fn floors(inputs: &mut SpectrumInputs) -> Network {
    let mut random = Random(1);
    let mut trainer = NetworkTrainer::new(inputs.inputs(), Options::spectrum(4)).unwrap();
    for n in 0..160 {
        let row = inputs.row(&block(n % 4, &mut random)).unwrap();
        trainer.add(&format!("floor {}", n % 4), &row).unwrap();
    }
    trainer.train().unwrap().network
}

#[test]
fn floors_are_told_by_their_spectra() {
    let mut inputs = SpectrumInputs::lep12().unwrap();
    assert_eq!((inputs.inputs(), inputs.block()), (120, 800));
    let network = floors(&mut inputs);
    let mut recogniser = SpectrumRecogniser::new(inputs, &network).unwrap();
    let mut random = Random(2);
    let mut hits = 0;
    for n in 0..100 {
        // The open block at the end gives nothing.
        let segment = [block(n % 4, &mut random), vec![0.0; 1000]].concat();
        let found = outcomes(&mut recogniser, &segment, 2);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].samples, 800);
        hits += u32::from(found[0].class == n % 4);
    }
    assert!(hits >= 95, "{hits}");
}

/// A tone of a known place and amplitude stands in its channel's bins alone.
#[test]
fn a_row_is_the_spectrum_of_one_channel_after_the_other() {
    let mut inputs = SpectrumInputs::lep12().unwrap();
    let row = inputs
        .row(
            &(0..800)
                .flat_map(|n| [0.0, 3.0 * (TAU * 40.0 * f64::from(n) / RATE_HZ).cos()])
                .collect::<Vec<_>>(),
        )
        .unwrap();
    assert!(row[..60].iter().all(|&p| p == 0.0));
    // 40 Hz is bin 20.48 of 1024 points; |X| of 800 samples is up to 1200.
    let best = (60..120)
        .max_by(|&a, &b| row[a].total_cmp(&row[b]))
        .unwrap();
    assert_eq!(best, 80);
    let sinc = |bins: f64| {
        let half = 0.5 * TAU * bins * 800.0 / 1024.0;
        half.sin() / half
    };
    let exact = 1200.0 * sinc(0.48);
    // The tone's image at −40 Hz leaks up to 1.5 / sin(π · 40.48 / 1024) = 12 in.
    assert!(
        (row[80].sqrt() - exact).abs() < 12.1,
        "{} {exact}",
        row[80].sqrt()
    );
    assert!(inputs.row(&[0.0; 10]).is_err());
}

/// Six vibrissae on one of three papers: vibrations whose amplitude depends on
/// vibrissa and paper.
fn sweep(paper: usize, samples: u32, random: &mut Random) -> Vec<f64> {
    let phase = random.unit();
    (0..samples)
        .flat_map(|n| {
            let values: Vec<f64> = (0..6)
                .flat_map(|i| {
                    let amplitude = 0.3 + 0.1 * (f64::from(i) + 2.0 * paper as f64).sin();
                    let turn = TAU * (f64::from(n) * (0.02 + 0.003 * f64::from(i)) + phase);
                    let noise = 0.05 * random.normal();
                    [amplitude * turn.sin() + noise, 0.1]
                })
                .collect();
            values
        })
        .collect()
}

fn features() -> ImpFeatures {
    ImpFeatures::new(6, 127.0, 200, Band::new(10)).unwrap()
}

#[test]
fn papers_are_told_by_the_imp_of_a_sweep() {
    let mut random = Random(5);
    let mut features = features();
    let mut trainer = NetworkTrainer::new(6, Options::imp(2)).unwrap();
    for n in 0..90 {
        let row = features.sweep(&sweep(n % 3, 1000, &mut random));
        trainer.add(&format!("P{}", n % 3), &row).unwrap();
    }
    let network = trainer.train().unwrap().network;
    let mut recogniser = ImpSweepRecogniser::new(features.clone(), &network).unwrap();
    let mut hits = 0;
    for n in 0..60 {
        let segment = sweep(n % 3, 1000, &mut random);
        let found = first_outcome(&mut recogniser, &segment, 12).unwrap();
        assert_eq!(found.samples, 1000);
        let row = features.sweep(&segment);
        assert_eq!(Ok(found.class), network.classify(&row));
        hits += u32::from(found.class == n % 3);
    }
    assert!(hits >= 57, "{hits}");
    assert_eq!(recogniser.finish(), None, "no sample, no class");
}

/// Trained on single windows, used by votes.
#[test]
fn corridors_are_told_by_votes() {
    let mut random = Random(6);
    let mut features = features();
    let mut trainer = NetworkTrainer::new(6, Options::imp(3)).unwrap();
    for n in 0..90 {
        for sample in sweep(n % 3, 400, &mut random).chunks(12) {
            if let Some(row) = features.push(sample) {
                trainer.add(&format!("P{}", n % 3), &row).unwrap();
            }
        }
        features.reset();
    }
    assert_eq!(trainer.rows(), 180);
    let network = trainer.train().unwrap().network;
    let mut recogniser = ImpVoteRecogniser::new(features, &network, 1.5).unwrap();
    for paper in 0..3 {
        // A fifth of the way is another paper, and does not matter.
        let way = [
            sweep((paper + 1) % 3, 400, &mut random),
            sweep(paper, 1600, &mut random),
        ]
        .concat();
        let found = first_outcome(&mut recogniser, &way, 12).unwrap();
        assert_eq!((found.class, found.samples), (paper, 2000));
    }
    // Too short for a window: the open one votes.
    let short = sweep(0, 150, &mut random);
    assert!(first_outcome(&mut recogniser, &short, 12).is_some());
    assert_eq!(first_outcome(&mut recogniser, &[], 12), None);
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let shape = Shape {
        inputs: 5,
        hidden: 2,
        outputs: 2,
    };
    let network = Network::new(shape, &[0.0; 5], &[1.0; 5], &vec![0.0; shape.weights()]).unwrap();
    let other = |expected| Some(MlpError::Length { expected, found: 5 });
    assert_eq!(
        ImpSweepRecogniser::new(features(), &network).err(),
        other(6)
    );
    assert_eq!(
        ImpVoteRecogniser::new(features(), &network, 0.0).err(),
        other(6)
    );
    let inputs = SpectrumInputs::lep12().unwrap();
    assert_eq!(SpectrumRecogniser::new(inputs, &network).err(), other(120));
    let none = ImpFeatures::new(0, 1.0, 1, Band::default());
    assert_eq!(none.err(), Some(ImpError::Vibrissae));
    let none = ImpFeatures::new(1, 1.0, 0, Band::default());
    assert_eq!(none.err(), Some(ImpError::Window));

    // A sample of other channels is not taken.
    let mut features = ImpFeatures::new(2, 1.0, 1, Band::default()).unwrap();
    assert_eq!(features.push(&[1.0; 3]), None);
    assert_eq!(features.push(&[f64::NAN; 4]), Some(vec![0.0; 2]));
}
