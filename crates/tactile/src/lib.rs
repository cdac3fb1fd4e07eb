//! Deciding what a whisker touched: histogram likelihoods and streaming
//! naive Bayes in integers.
//!
//! # Glossary
//!
//! - **channel**: one stream of numbers, such as the x deflection of a whisker.
//! - **code**: a sample as an integer, in the units of the model's
//!   [`Quantiser`]; for a model trained on integer sensor codes, that code.
//! - **bin**: one of the equal cells that a channel's range is cut into.
//! - **class**: what is to be distinguished (a texture, a distance, a terrain).
//! - **likelihood**: the probability of a bin given a class, trained on a
//!   recording (LEP10; LEP12 eq. 3; BIOTACT section IV).
//! - **table**: the likelihoods of the cells of one channel or of two together.
//! - **roughness**: how much a channel trembles over a block (`roughness.rs`).
//! - **touch**: from the first sample with contact until contact has been absent for
//!   a while; its onset limits the evidence that came before.
//! - **unknown**: a decision whose leader is less likely than its class's *floors*.
//! - **block**: the run of samples whose mean log-likelihood is one step of
//!   evidence (LEP12: m = 20).
//! - **evidence**: the log-posterior but for a constant; all classes start equal.
//! - **deficit**: by how much a class's evidence lies behind the leader's.
//! - **posterior**: the probability of a class given the samples so far.
//! - **decision time**: the samples a decision used.
//!
//! # Two rules over one lookup
//!
//! | rule | decides | source |
//! |---|---|---|
//! | [`Sequential`] | after the block in which a posterior exceeds a threshold | LEP12 eq. 3–8 |
//! | [`Window`] | by the largest evidence over each run of N samples | LEP10 |
//!
//! A module has a [`StreamClassifier`]: a [`Model`], a rule chosen at run time and the evidence
//! of each whisker that is heard, in fixed arrays of some 800 bytes a whisker. Each decides
//! by its own evidence, or all by its sum ([`Deciding`]). How many channels and classes
//! there are it reads from the model, which lies in flash on a board and in memory of its
//! own on a PC. A [`NaiveBayes`] is the same for one whisker with its rule (any
//! [`DecisionRule`]) as a type. After training everything is an integer; there is no
//! logarithm at run time.
//!
//! The classifiers that the papers compare these with are in
//! `studies/src/classifiers`.
//!
//! # Error bounds
//!
//! - A table entry is log2 p rounded to 2⁻¹⁰ bit: at most 2⁻¹¹ bit off.
//! - Sums and evidence are exact integers: nothing drifts, however long. In
//!   the sequential rule a class is held once it is 2²⁹ units behind (26214 bit
//!   in blocks of 20 samples, 52 bit in blocks of 10000).
//! - 2⁻ˣ is within 4.1e-6 relative (`exp2.rs`); x itself is scaled by a
//!   reciprocal of the block within 1e-5 relative (2e-8 for blocks of 20).
//!
//! # Features
//!
//! `Cargo.toml` says what each is for. A [`StreamClassifier`] refuses what the program was built
//! without, and links no code for it.
#![cfg_attr(not(test), no_std)]

#[cfg(feature = "std")]
extern crate std;

#[cfg(target_endian = "big")]
compile_error!("models are little-endian and read in place: big-endian targets are not supported");

mod any_rule;
mod binner;
mod class_setting;
mod classifier;
mod constants;
mod decision;
mod divide;
mod elsewhere;
mod error;
mod evidence;
mod exp2;
mod format;
#[cfg(feature = "std")]
mod information;
mod layout;
mod model;
#[cfg(feature = "std")]
mod model_buf;
mod naive_bayes;
pub mod name;
mod opinion;
mod quantiser;
mod roughness;
mod rule;
#[cfg(feature = "std")]
pub mod score;
mod self_motion;
mod sequential;
mod stream;
mod sums;
mod totals;
mod touch;
#[cfg(feature = "std")]
pub mod train;
#[cfg(feature = "std")]
mod train_error;
mod window;
mod words;

pub use any_rule::{AnyRule, RuleSettings};
pub use binner::Binner;
pub use class_setting::{ClassList, ClassSetting, ClassSettings, MOST_THRESHOLD};
pub use classifier::{Deciding, StreamClassifier};
pub use constants::Constants;
pub use decision::{Decision, Posterior, Reason};
pub use elsewhere::Felt;
pub use error::{ModelError, QuantiserError, SetupError};
pub use format::{
    CRC_BYTES, ENTRIES_PER_BIT, ENTRY_MAX, ENTRY_OFFSET_BITS, LOG_FLOOR, MAX_BINS, MAX_BLOCK,
    MAX_CHANNELS, MAX_CLASSES, MAX_NAME_BYTES, MAX_SAMPLE_AXES, MAX_SAMPLES_TIMES_CHANNELS,
    MAX_STREAMS, MAX_TABLES, ROUGH_CHANNELS, VERSION, checksum,
};
#[cfg(feature = "std")]
pub use information::information;
pub use layout::TouchRule;
pub use model::{Aligned, Floors, Model};
#[cfg(feature = "std")]
pub use model_buf::{Axis, ModelBuf, ModelParts, TableParts, TableSource};
pub use naive_bayes::{NaiveBayes, Posteriors};
pub use opinion::{Estimate, Pose, Whisked};
pub use quantiser::Quantiser;
pub use rule::DecisionRule;
pub use self_motion::SelfMotion;
pub use sequential::{Sequential, SequentialRule, Threshold};
pub use stream::WrongChannels;
pub use touch::{TouchDetector, Touching};
pub use window::{Window, WindowRule};
pub use words::{JOINT, OPINION, PRIORS, Words};
