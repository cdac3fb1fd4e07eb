//! Spectral templates: closed forms, and the board against the PC.

use std::f64::consts::TAU;

use classifiers::Error;
use classifiers::recogniser::{Recogniser, first_outcome, outcomes};
use classifiers::spectral_template::SpectralTemplate;
use classifiers::spectral_train::{SpectralTemplates, SpectralTrainer};
use classifiers::spectrum::{Bank, Bins, Measure};

/// 40 bins of 2.5 Hz at 2 kHz, as LEP12's.
const BLOCK: usize = 800;
const BINS: Bins = Bins {
    points: 800,
    first: 1,
    step: 1,
    count: 40,
};

/// Two channels: a sine of some amplitude in the one, one of 50 Hz in the other.
fn signal(amplitude: f64, hz: f64, phase: f64, samples: usize) -> Vec<f64> {
    (0..samples)
        .flat_map(|n| {
            let turns = n as f64 / 2000.0;
            let x = 7.0 + amplitude * (TAU * hz * turns + phase).sin();
            [x, (TAU * 50.0 * turns + phase).cos()]
        })
        .collect()
}

/// Classes of equal frequency and different amplitude, and one of another.
const CLASSES: [(f64, f64); 3] = [(1.0, 30.0), (2.0, 30.0), (1.0, 75.0)];

fn trained(measure: Measure) -> SpectralTemplates {
    let mut trainer = SpectralTrainer::new(2, BINS, BLOCK, measure).unwrap();
    for (class, (amplitude, hz)) in CLASSES.into_iter().enumerate() {
        for phase in [0.3, 1.9] {
            // Two blocks and a rest.
            trainer
                .add(class, &signal(amplitude, hz, phase, 1700))
                .unwrap();
        }
    }
    trainer.train().unwrap()
}

#[test]
fn means_and_errors_are_those_of_sines() {
    for (measure, power) in [(Measure::Magnitude, 1), (Measure::Power, 2)] {
        let mut templates = trained(measure);
        // A sine of amplitude A has A n / 2 in its bin, whatever its phase.
        let known = |amplitude: f64| (amplitude * 400.0).powi(power);
        for (class, (amplitude, hz)) in CLASSES.into_iter().enumerate() {
            let mean = templates.mean(class).unwrap();
            for (bin, &found) in mean.iter().enumerate() {
                let expected = if bin == (hz / 2.5) as usize - 1 {
                    known(amplitude)
                } else if bin == 40 + 19 {
                    known(1.0)
                } else {
                    0.0
                };
                assert!(
                    (found - expected).abs() < 1e-6 * known(1.0),
                    "{class} {bin} {found}"
                );
            }
        }
        let errors = templates.errors(&signal(1.2, 30.0, 0.9, BLOCK)).unwrap();
        let near = (known(1.2) - known(1.0)).powi(2);
        let louder = (known(1.2) - known(2.0)).powi(2);
        let other = known(1.2).powi(2) + known(1.0).powi(2);
        for (found, exact) in errors.iter().zip([near, louder, other]) {
            assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
        }
    }
}

#[test]
fn board_and_pc_choose_the_same() {
    for measure in [Measure::Magnitude, Measure::Power] {
        let templates = trained(measure);
        let table = templates.table::<2, 40, 3>().unwrap();
        let bank = Bank::<40>::new(&BINS, BLOCK as u32).unwrap();
        let board = SpectralTemplate::new(bank, measure, &table);
        let mut state = board.state();
        let mut pc = templates.recogniser();
        let (mut decided, mut wrong) = (0, 0);
        for (class, (amplitude, hz)) in CLASSES.into_iter().enumerate() {
            for n in 0..10 {
                let louder = amplitude * (0.8 + 0.04 * f64::from(n));
                let heard = signal(louder, hz, f64::from(n), 2 * BLOCK + 100);
                for sample in heard.chunks(2) {
                    let single = [sample[0] as f32, sample[1] as f32];
                    let (board, pc) = (board.push(&mut state, &single), pc.push(sample));
                    assert_eq!(
                        board.map(|c| (c.class(), c.samples())),
                        pc.map(|o| (o.class, o.samples)),
                        "{measure:?} {class} {n}"
                    );
                    if let Some(outcome) = pc {
                        decided += 1;
                        wrong += usize::from(outcome.class != class);
                    }
                }
                state = board.state();
                assert_eq!(pc.finish(), None);
            }
        }
        assert_eq!((decided, wrong), (60, 0), "{measure:?}");
    }
}

#[test]
fn only_whole_blocks_decide() {
    let templates = trained(Measure::Power);
    let mut recogniser = templates.recogniser();
    let short = signal(1.0, 30.0, 0.0, BLOCK - 1);
    assert_eq!(first_outcome(&mut recogniser, &short, 2), None);
    let found = outcomes(&mut recogniser, &signal(1.0, 30.0, 0.0, 2 * BLOCK), 2);
    assert!(found.len() == 2 && found.iter().all(|o| o.samples == BLOCK as u32));
    let mut broken = signal(1.0, 30.0, 0.0, BLOCK);
    broken[9] = f64::NAN;
    assert_eq!(first_outcome(&mut recogniser, &broken, 2), None);
    assert_eq!(recogniser.push(&[0.0]), None);
}

#[test]
fn what_is_wrong_is_named() {
    let new = |channels, bins, block| SpectralTrainer::new(channels, bins, block, Measure::Power);
    assert_eq!(new(0, BINS, BLOCK).err(), Some(Error::Channels));
    assert_eq!(new(2, BINS, 0).err(), Some(Error::Window(0)));
    let bins = Bins { count: 900, ..BINS };
    assert_eq!(new(2, bins, BLOCK).err(), Some(Error::Bins));
    let mut trainer = new(2, BINS, BLOCK).unwrap();
    assert_eq!(trainer.train().err(), Some(Error::NoSamples));
    let short = Error::Short {
        found: 1,
        needed: BLOCK,
    };
    assert_eq!(trainer.add(0, &[0.0; 2]), Err(short));
    assert!(trained(Measure::Power).table::<2, 39, 3>().is_none());
    assert!(
        trained(Measure::Power)
            .errors(&[0.0; 2 * BLOCK + 2])
            .is_err()
    );
}
