//! The classifiers that the papers compare with the product's (`tactile`), and
//! that no scene names. Like the product's they stream: a sample changes a
//! small state, and nothing is kept that grows with the block.
//!
//! | module | decides | source |
//! |---|---|---|
//! | [`Stationary`] | by the largest evidence of naive Bayes over a whole whisk and all whiskers | BIOTACT eq. 15–16 |
//! | [`template`] | by the nearest mean signal over an aligned window | BIOTACT eq. 17, POSE eq. 1 |
//! | [`spectral_template`] | by the nearest mean spectrum of a block | POSE eq. 2, LEP12 section 5.1 |
//! | [`features`] | by a [`polynomial`] of peak, slope and spectrum | POSE eq. 3–7 |
//! | [`mlp`] | by a network with one hidden layer, an input at a time | LEP12 section 5.2, PSIK section 3.2.1 |
//! | [`sprt`] | between two classes by their probability ratio | LEP12 eq. 1–2 |
//! | [`imp`] | by the vibrations of a whisker pad | PSIK section 3.1 |
//!
//! Templates and vibrations are integers, spectra and networks single precision.
//!
//! # Features
//!
//! - `train`: training them (`template_train`, `spectral_train`,
//!   `feature_train`, `regression`, `mlp::train`), and one way to ask a stream
//!   classifier (`recogniser`, `sprt`). It brings std, FFT, linear algebra and an
//!   optimiser.
//!
//! Without it the crate is `no_std`: what a board would run, and what is counted.
#![cfg_attr(not(test), no_std)]

#[cfg(feature = "train")]
extern crate std;

mod choice;
mod error;
#[cfg(feature = "train")]
pub mod feature_train;
pub mod features;
pub mod imp;
mod limits;
#[cfg(feature = "train")]
mod means;
pub mod mlp;
pub mod polynomial;
#[cfg(feature = "train")]
pub mod recogniser;
#[cfg(feature = "train")]
pub mod regression;
pub mod spectral_template;
#[cfg(feature = "train")]
pub mod spectral_train;
pub mod spectrum;
#[cfg(feature = "train")]
pub mod sprt;
mod stationary;
pub mod template;
#[cfg(feature = "train")]
pub mod template_train;

pub use choice::Choice;
pub use error::Error;
pub use limits::{MAX_HIDDEN, MAX_INPUTS, MAX_OUTPUTS, MAX_POINTS, MAX_SCALED, MAX_WEIGHT};
pub use stationary::{Stationary, StationaryRule};
