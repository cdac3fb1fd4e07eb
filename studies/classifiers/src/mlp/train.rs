//! Training a network from labelled rows of inputs, in double precision.
//!
//! Back-propagation of the mean squared error of the outputs, minimised over
//! the whole training set at once (batch training) by L-BFGS with the line
//! search of Moré and Thuente. LEP12 section 5.2 minimises the same error by
//! scaled conjugate gradients, PSIK section 3.2.1 by iRPROP; all three are
//! batch methods that find a minimum near their random start.
//!
//! Inputs are scaled to mean nought and variance one over the training set; one
//! that is constant there is left out (gain nought).
//!
//! A start can end in a poor minimum. So LEP12 used a network only if it told
//! every class better than chance (all hit rates above 25 %) and averaged ten;
//! a [`NetworkTrainer`] likewise starts anew, up to [`Options::attempts`] times, and
//! averaging is left to the caller, who has the seed.
//!
//! The same samples, options and seed give the same network, to the last bit,
//! on every machine.

mod options;
mod session;

use std::borrow::ToOwned;
use std::string::String;
use std::vec;
use std::vec::Vec;

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use super::gradient::Samples;
use super::network::{Network, scaled};
use super::shape::Shape;
use crate::error::Error;
use crate::limits::MAX_OUTPUTS;
pub use options::Options;
use session::session;

/// A network and how it was come by.
#[derive(Debug, Clone, PartialEq)]
pub struct Trained {
    /// The network.
    pub network: Network,
    /// Names of the classes, in the order of its outputs.
    pub names: Vec<String>,
    /// Hit rate of each class over all samples given.
    pub hit_rates: Vec<f64>,
    /// Root of the mean over samples of Σ_k (y_k − t_k)², over what was not held out.
    pub error: f64,
}

/// Collects rows of inputs and their classes.
#[derive(Debug, Clone)]
pub struct NetworkTrainer {
    options: Options,
    inputs: usize,
    names: Vec<String>,
    classes: Vec<u16>,
    values: Vec<f64>,
}

impl NetworkTrainer {
    /// A trainer for rows of so many inputs.
    ///
    /// # Errors
    ///
    /// An option or the number of inputs is out of range.
    pub fn new(inputs: usize, options: Options) -> Result<Self, Error> {
        options.check()?;
        let (hidden, outputs) = (options.hidden, 2);
        Shape {
            inputs,
            hidden,
            outputs,
        }
        .check()?;
        Ok(Self {
            options,
            inputs,
            names: Vec::new(),
            classes: Vec::new(),
            values: Vec::new(),
        })
    }

    /// Adds a row of a class. Classes are numbered as they first appear.
    ///
    /// # Errors
    ///
    /// The row or the name is unusable; it is then not added.
    pub fn add(&mut self, label: &str, row: &[f64]) -> Result<(), Error> {
        if row.len() != self.inputs {
            return Err(Error::Length {
                expected: self.inputs,
                found: row.len(),
            });
        }
        // As f32, which a module's network reads.
        if let Some(channel) = row.iter().position(|x| !(*x as f32).is_finite()) {
            return Err(Error::NotFinite {
                sample: self.rows(),
                channel,
            });
        }
        if label.is_empty() {
            return Err(Error::NameEmpty);
        }
        let class = if let Some(class) = self.names.iter().position(|n| n == label) {
            class
        } else {
            if self.names.len() == MAX_OUTPUTS {
                return Err(Error::Outputs(MAX_OUTPUTS + 1));
            }
            self.names.push(label.to_owned());
            self.names.len() - 1
        };
        // At most 255.
        self.classes.push(class as u16);
        self.values.extend_from_slice(row);
        Ok(())
    }

    /// Rows so far.
    pub fn rows(&self) -> usize {
        self.classes.len()
    }

    /// Trains a network.
    ///
    /// # Errors
    ///
    /// Fewer than two classes, an input that spans more than an f32 can scale,
    /// or no start that was reliable.
    pub fn train(&self) -> Result<Trained, Error> {
        match self.names.len() {
            0 => return Err(Error::NoSamples),
            1 => return Err(Error::OneClass),
            _ => {}
        }
        let shape = Shape {
            inputs: self.inputs,
            hidden: self.options.hidden,
            outputs: self.names.len(),
        };
        let (offset, gain) = self.scale()?;
        let mut random = Xoshiro256PlusPlus::seed_from_u64(self.options.seed);
        for _ in 0..self.options.attempts {
            let [training, held_out] = self.split(&offset, &gain, &mut random);
            let start = start(shape, &mut random);
            let Some(found) = session(shape, &self.options, start, &training, &held_out) else {
                continue;
            };
            let Ok(network) = Network::new(shape, &offset, &gain, &found.weights) else {
                continue;
            };
            let hit_rates = self.hit_rates(&network)?;
            let bar = self.options.reliable;
            if bar <= 0.0 || hit_rates.iter().all(|&rate| rate > bar) {
                return Ok(Trained {
                    network,
                    names: self.names.clone(),
                    hit_rates,
                    error: found.mean_square.sqrt(),
                });
            }
        }
        Err(Error::NotReliable {
            attempts: self.options.attempts,
        })
    }

    /// Mean and one over the standard deviation of each input.
    fn scale(&self) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let rows = self.rows() as f64;
        let mut offset = vec![0.0; self.inputs];
        let mut gain = vec![0.0; self.inputs];
        for input in 0..self.inputs {
            let values = || self.values.iter().skip(input).step_by(self.inputs);
            let mean = values().sum::<f64>() / rows;
            let variance = values().map(|x| (x - mean) * (x - mean)).sum::<f64>() / rows;
            let deviation = variance.sqrt();
            // A constant's mean may be a rounding off it; that is no spread.
            let spread = deviation > mean.abs() * 1e-12 && deviation > 0.0;
            (offset[input], gain[input]) = (mean, if spread { 1.0 / deviation } else { 0.0 });
            if !(gain[input] as f32).is_finite() {
                return Err(Error::Scale { input });
            }
        }
        Ok((offset, gain))
    }

    /// Samples to train on and samples held out, scaled, of each class the
    /// same part.
    fn split(&self, offset: &[f64], gain: &[f64], random: &mut Xoshiro256PlusPlus) -> [Samples; 2] {
        let mut parts = [Samples::default(), Samples::default()];
        for class in 0..self.names.len() {
            let mut rows: Vec<usize> = (0..self.rows())
                .filter(|&row| usize::from(self.classes[row]) == class)
                .collect();
            shuffle(&mut rows, random);
            let held_out = (rows.len() as f64 * self.options.held_out) as usize;
            for (at, row) in rows.into_iter().enumerate() {
                let part = &mut parts[usize::from(at < held_out)];
                let values = &self.values[row * self.inputs..(row + 1) * self.inputs];
                let scales = offset.iter().zip(gain);
                part.inputs.extend(
                    values
                        .iter()
                        .zip(scales)
                        .map(|(&x, (&offset, &gain))| scaled(x, offset, gain)),
                );
                part.classes.push(class as u16);
            }
        }
        parts
    }

    fn hit_rates(&self, network: &Network) -> Result<Vec<f64>, Error> {
        let mut hits = vec![0_u32; self.names.len()];
        let mut trials = vec![0_u32; self.names.len()];
        for (row, &class) in self.values.chunks_exact(self.inputs).zip(&self.classes) {
            let class = usize::from(class);
            trials[class] += 1;
            hits[class] += u32::from(network.classify(row)? == class);
        }
        let rate = |(&hits, &trials)| f64::from(hits) / f64::from(u32::max(trials, 1));
        Ok(hits.iter().zip(&trials).map(rate).collect())
    }
}

/// First weights, even between ±√(6 / (from + to)) for a layer from so many to
/// so many units, which keeps drives of order one; biases nought.
fn start(shape: Shape, random: &mut Xoshiro256PlusPlus) -> Vec<f64> {
    let mut layer = |from: usize, to: usize| -> Vec<f64> {
        let reach = (6.0 / (from + to) as f64).sqrt();
        (0..from * to)
            .map(|_| reach * (2.0 * unit(random) - 1.0))
            .collect()
    };
    let mut weights = layer(shape.inputs, shape.hidden);
    let output = layer(shape.hidden, shape.outputs);
    weights.resize(weights.len() + shape.hidden, 0.0);
    weights.extend(output);
    weights.resize(shape.weights(), 0.0);
    weights
}

/// Even in [0, 1): the upper 53 bits.
fn unit(random: &mut Xoshiro256PlusPlus) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Fisher and Yates.
fn shuffle(rows: &mut [usize], random: &mut Xoshiro256PlusPlus) {
    for last in (1..rows.len()).rev() {
        // Below last + 1, as a unit number is below one.
        let with = (unit(random) * (last + 1) as f64) as usize;
        rows.swap(last, with.min(last));
    }
}
