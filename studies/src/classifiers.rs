//! The classifiers that the papers compare with the product's (`tactile`), and that no scene names.
//!
//! | module | decides | source |
//! |---|---|---|
//! | [`recogniser`] | by naive Bayes under the product's rules, or over a whole whisk and all whiskers | LEP10, LEP12, BIOTACT eq. 15–16 |
//! | | between two classes by their probability ratio | LEP12 eq. 1–2 |
//! | [`template`] | by the nearest mean signal over an aligned window | BIOTACT eq. 17, POSE eq. 1 |
//! | [`template`] on a [`spectrum`] | by the nearest mean spectrum of a block | POSE eq. 2, LEP12 section 5.1 |
//! | [`features`] | by a [`regression`] on peak, slope and spectrum | POSE eq. 3–7 |
//! | [`network`] | by a network with one hidden layer | LEP12 section 5.2, PSIK section 3.2.1 |
//! | [`imp`] | by the vibrations of a whisker pad, as inputs of a network | PSIK section 3.1 |
//!
//! What they cost on a microcontroller was counted once: record 39 of `docs/decisions.md`.

pub(crate) mod features;
pub(crate) mod imp;
pub(crate) mod network;
pub(crate) mod recogniser;
pub(crate) mod regression;
pub(crate) mod spectrum;
pub(crate) mod template;

pub(crate) use features::{CENTROID, CENTROID_MAGNITUDE, Extractor, PEAK, SLOPE, TOTAL_MAGNITUDE};
pub(crate) use recogniser::{Bayes, Recogniser};
pub(crate) use regression::Regression;
pub(crate) use spectrum::{Bins, MAGNITUDE, POWER, Spectrum};
pub(crate) use template::Templates;
