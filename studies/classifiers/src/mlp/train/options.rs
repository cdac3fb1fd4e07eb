//! How to train a network, and the papers' ways.

use crate::error::Error;

/// How to train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Hidden units, 1 to 1024.
    pub hidden: usize,
    /// Most iterations of a start, each one or two passes through the samples.
    pub iterations: u64,
    /// λ of the penalty λ/2 Σ w² on all weights but biases; 0 is none.
    pub decay: f64,
    /// Part of each class's samples that is held out of the training, 0 (none)
    /// to 0.5, to stop it in time: the network is the one with the lowest error
    /// on them.
    pub held_out: f64,
    /// Iterations without a lower error on the samples held out after which a
    /// start ends.
    pub patience: u32,
    /// Starts, at least 1, until one is reliable.
    pub attempts: u32,
    /// A network is reliable if every class's hit rate on the training set is
    /// above this; with 0 any is.
    pub reliable: f64,
    /// Of the random numbers: first weights, and which samples are held out.
    pub seed: u64,
}

impl Options {
    /// LEP12 section 5.2: 20 hidden units, ten starts, reliable above 25 %.
    /// The paper does not say when its training stopped. Here 15 % are held
    /// out and six failures end it, which were the defaults of the toolboxes
    /// with scaled conjugate gradients of the time: 2500 weights on 960 rows
    /// would else fit the noise.
    pub fn spectrum(seed: u64) -> Self {
        Self {
            hidden: 20,
            iterations: 1000,
            decay: 0.0,
            held_out: 0.15,
            patience: 6,
            attempts: 10,
            reliable: 0.25,
            seed,
        }
    }

    /// PSIK section 3.2.1: 33 hidden units. The paper names neither a stopping
    /// rule nor a penalty; nothing is held out, and a weak penalty keeps
    /// weights finite where classes can be told apart without error.
    pub fn imp(seed: u64) -> Self {
        Self {
            hidden: 33,
            iterations: 200,
            decay: 1e-5,
            held_out: 0.0,
            patience: 1,
            attempts: 10,
            reliable: 0.25,
            seed,
        }
    }

    /// Refuses what is out of range.
    pub(super) fn check(self) -> Result<(), Error> {
        if !(0.0..=1.0).contains(&self.decay) {
            return Err(Error::Decay(self.decay));
        }
        if !(0.0..=0.5).contains(&self.held_out) {
            return Err(Error::HeldOut(self.held_out));
        }
        if !(0.0..1.0).contains(&self.reliable) {
            return Err(Error::Reliable(self.reliable));
        }
        if self.attempts == 0 {
            return Err(Error::NoAttempts);
        }
        Ok(())
    }
}
