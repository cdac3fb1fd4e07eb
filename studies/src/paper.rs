//! The numbers of the five papers, as printed, to set ours beside.
//!
//! Percentages are hit rates or shares of a true class. Where a paper shows a
//! figure without its numbers, only what the text says of it is here.

pub mod biotact;
pub mod lep10;
pub mod lep12;
pub mod pose;
pub mod psik;

#[cfg(test)]
mod tests;
