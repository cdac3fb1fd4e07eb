//! A feed-forward network with one hidden layer: trained on a PC, run on
//! a module.
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
//! # Two forms of one network
//!
//! | form | numbers | for |
//! |---|---|---|
//! | `Network` (feature `train`) | f64 | training, experiments |
//! | [`Mlp`] | f32 | a board with an FPU |
//!
//! The embedded form takes the inputs one by one, as a bank of filters or a row
//! of vibrissae yields them: the weights of an input lie together, a
//! [`Mlp::push`] costs H multiplications, and nothing but the H sums is kept.
//! So a network need not be run in one tick.
//!
//! An output y of [`Mlp`] is within 2e-6 of the f64 form's for trained networks
//! of 120–20–4 and 33–33–8 units (the test
//! `the_single_precision_form_is_within_its_bound`).

#[cfg(feature = "train")]
mod gradient;
mod logistic;
#[cfg(feature = "train")]
mod network;
mod shape;
mod single;
#[cfg(feature = "train")]
pub mod train;

#[cfg(feature = "train")]
pub use network::Network;
pub use shape::Shape;
pub use single::{Mlp, MlpInput, MlpState};
