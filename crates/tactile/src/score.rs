//! How good a classifier is: the same figures for every experiment.
//!
//! # Glossary
//!
//! - **confusion matrix**: how often each true class (row) was taken for each
//!   class (column).
//! - **hit rate**: the share of trials in which the right class was named.
//! - **κ**: Cohen's kappa (POSE eq. 8), the hit rate beyond chance,
//!   (P_O − P_E)/(1 − P_E); 1 is perfect, 0 chance, below 0 worse than chance.
//! - **missed**: a trial in which no class was named; it counts as no hit, and
//!   κ, which is about classes named, leaves it out.
//! - **stated**: the posterior with which a decision was made; **found**: the share
//!   of such decisions that was right.
//! - **error** of ordered classes (angle, speed): value named minus true value.

mod calibration;
mod confusion;
mod interval;
mod statistics;

pub use calibration::{Calibration, CalibrationBin};
pub use confusion::{Confusion, ScoreError};
pub use interval::Interval;
pub use statistics::Statistics;
