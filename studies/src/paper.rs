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

/// What a file that is built in has under `key`.
pub(crate) fn printed<T: DeserializeOwned>(file: &str, key: &str) -> T {
    let all: Result<BTreeMap<String, toml::Value>, _> = toml::from_str(file);
    let mut all = all.expect("a paper's file is TOML");
    let table = all.remove(key).expect("a paper's file has its tables");
    T::deserialize(table).expect("a paper's table has its shape")
}

/// What the printed tables must agree with among themselves.
#[cfg(test)]
mod tests {
    use super::{lep10, lep12, psik};

    /// Printed percentages are rounded to the half or the whole.
    const ROUNDING: f64 = 1.01;

    #[test]
    fn the_true_classes_of_lep10_sum_to_a_hundred_and_diagonals_to_the_means() {
        for table in lep10::TABLES.iter() {
            for class in 0..4 {
                let sum: f64 = table.percent.iter().map(|row| row[class]).sum();
                assert!((sum - 100.0).abs() < ROUNDING, "{table:?} {class}");
            }
            let mean = (0..4).map(|k| table.percent[k][k]).sum::<f64>() / 4.0;
            assert!((mean - table.mean).abs() < 0.6, "{}: {mean}", table.number);
        }
    }

    #[test]
    fn the_means_of_lep12_are_those_of_their_floors_but_for_one_misprint() {
        let mut off = Vec::new();
        for table in lep12::TABLES.iter() {
            for (motion, (row, mean)) in table.percent.iter().zip(table.mean).enumerate() {
                if (row.iter().sum::<f64>() / 4.0 - mean).abs() > 0.76 {
                    off.push((table.number, motion));
                }
            }
        }
        assert_eq!(off, [(3, 2)]);
    }

    #[test]
    fn confusions_of_psik_sum_to_a_hundred_and_the_arcs_to_the_vibrissae() {
        let of_2 = psik::TABLE_2.iter().map(<[f64; 8]>::as_slice);
        for row in of_2.chain(psik::TABLE_3.iter().map(<[f64; 4]>::as_slice)) {
            assert_eq!(row.iter().sum::<f64>(), 100.0);
        }
        let count: usize = psik::ARCS.iter().map(|arc| arc.0).sum();
        assert_eq!(count, psik::VIBRISSAE);
        assert!(psik::ARCS.is_sorted_by(|a, b| a.1 > b.1));
    }
}
