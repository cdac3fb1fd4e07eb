//! The numbers of the five papers, as printed, to set ours beside.
//!
//! Percentages are hit rates or shares of a true class. Where a paper shows a
//! figure without its numbers, only what the text says of it is here.

pub(crate) mod biotact;
pub(crate) mod lep10;
pub(crate) mod lep12;
pub(crate) mod pose;
pub(crate) mod psik;

use anyhow::Result;
use std::collections::BTreeMap;

use serde::de::DeserializeOwned;

/// The tables that a paper's file has under `key`. The files are built in, and a
/// test reads every table of them.
pub(crate) fn printed<T: DeserializeOwned>(file: &str, key: &str) -> T {
    let all: Result<BTreeMap<String, toml::Value>, _> = toml::from_str(file);
    let mut all = all.expect("a paper's file is TOML");
    let table = all.remove(key).expect("a paper's file has its tables");
    T::deserialize(table).expect("a paper's table has its shape")
}

#[cfg(test)]
mod tests;
