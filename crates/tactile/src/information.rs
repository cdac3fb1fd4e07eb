//! How fast the evidence of a model's tables grows, where they are true.

use std::vec;
use std::vec::Vec;

use crate::format::{ENTRIES_PER_BIT, ENTRY_OFFSET_BITS, MAX_CLASSES, TableRecord};
use crate::model::Model;
use crate::words::Words;

/// For each class the mean rise of its log odds in a block, nats, against the rival that is most
/// like it: Σ over tables of w · KL(P_k ‖ P_j) (Kullback and Leibler 1951; LEP12 eq. 3 adds the mean
/// of a block). Entries are w (log₂ p + 20), so a table's weight w follows from its probabilities,
/// which sum up to one.
///
/// Right to the rounding of entries, 2⁻¹¹ bit, where samples come as the tables have them.
pub fn information<W: Words>(model: &Model<W>) -> Vec<f64> {
    let classes = model.classes();
    let mut rises = vec![vec![0.0; classes]; classes];
    let parts = model.parts();
    for table in parts.sample_tables().chain(parts.rough_tables()) {
        let cells: Vec<Vec<f64>> = (0..cells(table))
            .filter_map(|cell| parts.row(table, cell))
            .map(|row| bits(row).take(classes).collect())
            .collect();
        add(&mut rises, &cells);
    }
    let least = |(class, rises): (usize, &Vec<f64>)| {
        let rivals = rises
            .iter()
            .enumerate()
            .filter(|(rival, _)| *rival != class);
        rivals.map(|(_, rise)| *rise).fold(f64::INFINITY, f64::min)
    };
    rises.iter().enumerate().map(least).collect()
}

fn cells(table: TableRecord<'_>) -> usize {
    let bins = table.axis().map(|axis| usize::from(axis.last_bin) + 1);
    bins.iter().product()
}

fn bits(row: &[u32]) -> impl Iterator<Item = f64> {
    let halves = row.iter().flat_map(|word| [word & 0xffff, word >> 16]);
    halves.map(|entry| f64::from(entry) / f64::from(ENTRIES_PER_BIT))
}

fn add(rises: &mut [Vec<f64>], cells: &[Vec<f64>]) {
    let weight = weight(cells);
    let offset = f64::from(ENTRY_OFFSET_BITS);
    for cell in cells {
        for (rises, own) in rises.iter_mut().zip(cell) {
            let p = (own / weight - offset).exp2();
            for (rise, rival) in rises.iter_mut().zip(cell) {
                *rise += p * (own - rival) * std::f64::consts::LN_2;
            }
        }
    }
}

/// The weight with which the probabilities of all classes sum up to their number; infinite, so
/// that no cell counts, of a table without any.
fn weight(cells: &[Vec<f64>]) -> f64 {
    let offset = f64::from(ENTRY_OFFSET_BITS);
    let classes = cells.first().map_or(0, Vec::len).min(MAX_CLASSES) as f64;
    let excess = |weight: f64| {
        let all = cells.iter().flatten();
        all.map(|bits| (bits / weight - offset).exp2()).sum::<f64>() - classes
    };
    // The sum falls with the weight.
    let (mut low, mut high) = (0.0, 64.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernoulli with 0.6 and 0.4: 0.2 · ln 1.5, at any weight w times that.
    #[test]
    fn coins_have_the_divergence_of_the_closed_form() {
        for w in [1.0, 0.3, 2.0] {
            let bits = |p: f64| w * (p.log2() + 20.0);
            let cells = [[0.4, 0.6], [0.6, 0.4]].map(|cell| cell.map(bits).to_vec());
            assert!((weight(&cells) - w).abs() < 1e-9);
            let mut rises = vec![vec![0.0; 2]; 2];
            add(&mut rises, &cells);
            let exact = w * 0.2 * 1.5_f64.ln();
            assert!((rises[0][1] - exact).abs() < 1e-9 && (rises[1][0] - exact).abs() < 1e-9);
        }
    }
}
