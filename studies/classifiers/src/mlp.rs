//! A feed-forward network with one hidden layer: training it on a PC, running
//! it on a module.
//!
//! # Glossary
//!
//! - **input**: one number of what is to be classified: the power in one band
//!   of a spectrum (LEP12 section 5.2: 120 of them), the IMP of one vibrissa
//!   (PSIK section 3.2.1: 33).
//! - **scaled input**: z = (x − offset) · gain, with mean nought and variance
//!   one over the training set.
//! - **drive**: what a unit sums up before its transfer function.
//! - **log-sigmoid**: σ(u) = 1 / (1 + exp(−u)), the transfer function of every
//!   hidden and output unit.
//! - **winner takes all**: the class is the output unit with the largest
//!   output; as σ only rises, that is the one with the largest drive.
//!
//! # Equations
//!
//! h_j = σ(b_j + Σ_i W_ij z_i) for the H hidden units, y_k = σ(c_k + Σ_j V_kj h_j)
//! for the O outputs, and the class is the k of the largest y_k, the first of
//! equals.
//!
//! # Three forms of one network
//!
//! | form | numbers | for |
//! |---|---|---|
//! | `Network` (feature `train`) | f64 | training, experiments |
//! | [`Mlp`] | f32 | parts with an FPU |
//! | [`FixedMlp`] | 16-bit weights, 32-bit sums | parts without |
//!
//! The embedded forms take the inputs one by one, as a bank of filters or a row
//! of vibrissae yields them: the weights of an input lie together, a
//! [`Mlp::push`] costs H multiplications, and nothing but the H sums is kept.
//! So a network need not be run in one tick.
//!
//! # Errors against f64
//!
//! | form | output y | held by |
//! |---|---|---|
//! | [`Mlp`] | 2e-6 | the test `the_single_precision_form_is_within_its_bound` |
//! | [`FixedMlp`] | 3e-3 | the test `the_fixed_form_is_within_its_bound` |
//!
//! Both for trained networks of 120–20–4 and 33–33–8 units.

mod error;
mod fixed;
mod format;
#[cfg(feature = "train")]
mod gradient;
mod limits;
mod logistic;
#[cfg(feature = "train")]
mod network;
#[cfg(feature = "train")]
mod recogniser;
mod single;
#[cfg(feature = "train")]
pub mod train;

pub use error::MlpError;
pub use fixed::{FixedInput, FixedMlp, FixedMlpState};
pub use limits::{MAX_HIDDEN, MAX_INPUTS, MAX_OUTPUTS, MAX_SCALED, MAX_WEIGHT, MLP_VERSION};
#[cfg(feature = "train")]
pub use network::{Network, Shape};
#[cfg(feature = "train")]
pub use recogniser::{SPECTRUM_BINS, SpectrumInputs, SpectrumRecogniser};
pub use single::{Mlp, MlpInput, MlpState};
