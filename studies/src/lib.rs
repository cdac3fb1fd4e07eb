//! The laboratory: experiments of the papers on simulated rigs with their
//! classifiers, the report of how accurate the numerics are, and the page of what
//! decisions are worth. Nothing that a board or a simulated scene runs depends on it.

pub mod accuracy;
mod chart;
pub mod commands;
mod cores;
pub mod decisions;
pub mod experiment;
mod moments;
mod page;
pub mod paper;
mod refused;
pub mod rigs;
