//! IMP and a network as recognisers for experiments: a sweep at a time (PSIK
//! section 3.2.1), or by votes along a corridor (section 3.3.2).

use std::vec;
use std::vec::Vec;

use super::pad::ImpError;
use super::peaks::{Band, Peaks};
use crate::mlp::{MlpError, Network};
use crate::recogniser::{Outcome, Recogniser};

/// The IMP of any number of vibrissae, by the integers of a board: real
/// samples become codes first.
#[derive(Debug, Clone)]
pub struct ImpFeatures {
    codes_per_unit: f64,
    window: u32,
    band: Band,
    left: u32,
    vibrissae: Vec<Peaks>,
}

impl ImpFeatures {
    /// For samples of `vibrissae` pairs of x and y, each times `codes_per_unit`
    /// rounded to a code (127 for readings of ±1 and the paper's 8 bits).
    ///
    /// # Errors
    ///
    /// No vibrissae, or a window of no samples.
    pub fn new(
        vibrissae: usize,
        codes_per_unit: f64,
        window: u32,
        band: Band,
    ) -> Result<Self, ImpError> {
        if window == 0 {
            return Err(ImpError::Window);
        }
        if vibrissae == 0 {
            return Err(ImpError::Vibrissae);
        }
        Ok(Self {
            codes_per_unit,
            window,
            band,
            left: window,
            vibrissae: vec![Peaks::default(); vibrissae],
        })
    }

    /// Vibrissae of a sample.
    pub fn vibrissae(&self) -> usize {
        self.vibrissae.len()
    }

    /// Takes a sample, x and y of each vibrissa; with the last of a window, the
    /// IMP of each in codes a sample. A sample of another length is not taken.
    pub fn push(&mut self, sample: &[f64]) -> Option<Vec<f64>> {
        if sample.len() != 2 * self.vibrissae.len() {
            return None;
        }
        // Saturates, and NaN is nought.
        let code = |x: f64| (x * self.codes_per_unit).round() as i16;
        for (peaks, at) in self.vibrissae.iter_mut().zip(sample.chunks_exact(2)) {
            peaks.push(self.band, code(at[0]), code(at[1]));
        }
        self.left -= 1;
        (self.left == 0).then(|| self.end())
    }

    fn end(&mut self) -> Vec<f64> {
        self.left = self.window;
        let mean = |peaks: &mut Peaks| f64::from(peaks.take()) / 65536.0;
        self.vibrissae.iter_mut().map(mean).collect()
    }

    /// The end of a sweep: the window left open, if it holds a sample. Then as
    /// new.
    pub fn finish(&mut self) -> Option<Vec<f64>> {
        let found = (self.left < self.window).then(|| self.end());
        self.reset();
        found
    }

    /// Forgets all samples.
    pub fn reset(&mut self) {
        self.left = self.window;
        self.vibrissae.fill(Peaks::default());
    }

    /// The IMP of each vibrissa summed over the windows of a whole sweep, its
    /// samples one after the other: a row to train on.
    pub fn sweep(&mut self, segment: &[f64]) -> Vec<f64> {
        self.reset();
        let mut sums = vec![0.0; self.vibrissae.len()];
        for sample in segment.chunks_exact(2 * self.vibrissae.len()) {
            if let Some(window) = self.push(sample) {
                add(&mut sums, &window);
            }
        }
        if let Some(window) = self.finish() {
            add(&mut sums, &window);
        }
        sums
    }
}

fn add(sums: &mut [f64], window: &[f64]) {
    for (sum, imp) in sums.iter_mut().zip(window) {
        *sum += imp;
    }
}

/// Refuses a network that has not an input for each vibrissa.
fn check(features: &ImpFeatures, network: &Network) -> Result<(), MlpError> {
    let (expected, found) = (features.vibrissae(), network.shape().inputs);
    if expected == found {
        Ok(())
    } else {
        Err(MlpError::Length { expected, found })
    }
}

/// Names the class of a whole sweep, at its end.
#[derive(Debug, Clone)]
pub struct ImpSweepRecogniser<'n> {
    features: ImpFeatures,
    network: &'n Network,
    sums: Vec<f64>,
    samples: u32,
}

impl<'n> ImpSweepRecogniser<'n> {
    /// Of the features that the network was trained on
    /// ([`ImpFeatures::sweep`]).
    ///
    /// # Errors
    ///
    /// The network has not an input for each vibrissa.
    pub fn new(mut features: ImpFeatures, network: &'n Network) -> Result<Self, MlpError> {
        check(&features, network)?;
        features.reset();
        Ok(Self {
            sums: vec![0.0; features.vibrissae()],
            features,
            network,
            samples: 0,
        })
    }
}

impl Recogniser for ImpSweepRecogniser<'_> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != 2 * self.features.vibrissae() {
            return None;
        }
        self.samples = self.samples.saturating_add(1);
        if let Some(window) = self.features.push(sample) {
            add(&mut self.sums, &window);
        }
        None
    }

    fn finish(&mut self) -> Option<Outcome> {
        if let Some(window) = self.features.finish() {
            add(&mut self.sums, &window);
        }
        let class = self.network.classify(&self.sums).ok();
        let outcome = class.filter(|_| self.samples > 0).map(|class| Outcome {
            class,
            samples: self.samples,
            value: None,
        });
        self.reset();
        outcome
    }

    fn reset(&mut self) {
        self.features.reset();
        self.sums.fill(0.0);
        self.samples = 0;
    }
}

/// Names a class by the votes of all windows: each window's IMP, low-passed, is
/// classified, and at the end the class named most often wins, the first of
/// equals (PSIK section 3.3.2: by accumulating the winner through the whole
/// corridor).
#[derive(Debug, Clone)]
pub struct ImpVoteRecogniser<'n> {
    features: ImpFeatures,
    network: &'n Network,
    /// Part of the way to the newest window that the low-pass goes.
    step: f64,
    smooth: Option<Vec<f64>>,
    votes: Vec<u32>,
    samples: u32,
}

impl<'n> ImpVoteRecogniser<'n> {
    /// Of the features that the network was trained on ([`ImpFeatures::push`]).
    /// `smoothing` is the low-pass's time constant, windows; nought is none.
    ///
    /// # Errors
    ///
    /// The network has not an input for each vibrissa.
    pub fn new(
        mut features: ImpFeatures,
        network: &'n Network,
        smoothing: f64,
    ) -> Result<Self, MlpError> {
        check(&features, network)?;
        features.reset();
        let step = if smoothing > 0.0 {
            1.0 - libm::exp(-1.0 / smoothing)
        } else {
            1.0
        };
        Ok(Self {
            features,
            network,
            step,
            smooth: None,
            votes: vec![0; network.shape().outputs],
            samples: 0,
        })
    }

    /// The low-passed IMP after a window.
    fn smoothed(&mut self, window: Vec<f64>) -> &[f64] {
        let step = self.step;
        match &mut self.smooth {
            Some(smooth) => {
                for (y, x) in smooth.iter_mut().zip(&window) {
                    *y += step * (x - *y);
                }
                smooth
            }
            empty => empty.insert(window),
        }
    }

    fn vote(&mut self, window: Vec<f64>) {
        let network = self.network;
        let class = network.classify(self.smoothed(window));
        if let Some(votes) = class.ok().and_then(|class| self.votes.get_mut(class)) {
            *votes = votes.saturating_add(1);
        }
    }
}

impl Recogniser for ImpVoteRecogniser<'_> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != 2 * self.features.vibrissae() {
            return None;
        }
        self.samples = self.samples.saturating_add(1);
        if let Some(window) = self.features.push(sample) {
            self.vote(window);
        }
        None
    }

    fn finish(&mut self) -> Option<Outcome> {
        if let Some(window) = self.features.finish() {
            self.vote(window);
        }
        let most = self.votes.iter().copied().max().filter(|&n| n > 0);
        let class = most.and_then(|n| self.votes.iter().position(|&votes| votes == n));
        let outcome = class.map(|class| Outcome {
            class,
            samples: self.samples,
            value: None,
        });
        self.reset();
        outcome
    }

    fn reset(&mut self) {
        self.features.reset();
        self.smooth = None;
        self.votes.fill(0);
        self.samples = 0;
    }
}
