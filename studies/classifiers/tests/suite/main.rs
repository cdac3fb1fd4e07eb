//! The papers' classifiers, by topic.

#[cfg(feature = "train")]
#[allow(dead_code, reason = "the product's own tests use the rest")]
#[path = "../../../../crates/tactile/tests/suite/common.rs"]
mod common;
#[cfg(feature = "train")]
mod features;
mod imp;
#[cfg(feature = "train")]
mod mlp;
#[cfg(feature = "train")]
mod mlp_forms;
#[cfg(feature = "train")]
mod recogniser;
#[cfg(feature = "train")]
mod rows;
mod sizes;
#[cfg(feature = "train")]
mod spectral_template;
#[cfg(feature = "train")]
mod spectrum;
#[cfg(feature = "train")]
mod sprt;
#[cfg(feature = "train")]
mod stationary;
#[cfg(feature = "train")]
mod template;
