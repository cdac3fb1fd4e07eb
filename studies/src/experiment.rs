//! Experiments of the five papers on simulated rigs, their tables and figures
//! beside the papers', and whether what must come out does.
//!
//! # Glossary
//!
//! - **data set**: recordings of one rig under all its conditions.
//! - **job**: what one recording comes of: a trial, a visit, a contact, a sweep.
//! - **claim**: something that must come out of the mechanism, beyond noise.
//! - **arm**: an experiment by the papers' protocol, or with what they keep drawn again; as it is,
//!   or as a placebo.
//! - **placebo**: the same with one texture under all labels.
//!
//! A run records the data sets that the chosen experiments need, a job at a time on all cores, and
//! then evaluates them. Recordings depend on the seed, the data set and the job alone, so neither
//! the number of cores nor what else is recorded changes a byte.

mod asked;
mod biotact;
mod changes;
mod data;
mod floors;
mod lep10;
mod lep12;
mod pose;
mod product;
mod psik;
mod ranges;
pub(crate) mod recording;
pub(crate) mod request;
mod runs;
mod shades;
mod verdicts;

pub(crate) use asked::Asked;
use asked::Part;
use floors::{Floors, Stream, Tally, hit_curves, train};
pub(crate) use recording::{Dataset, Recording};
use recording::{Job, Recordings, of_set};
use request::{Arm, Name};
pub(crate) use request::{Extent, Request};
pub(crate) use runs::run;
use verdicts::{Bodies, Both, Judged, VERDICTS, all_judged, digits, margins};

#[cfg(test)]
mod tests;
