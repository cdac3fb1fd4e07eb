//! What training gives, and the model file that comes of it.

use std::string::String;
use std::vec::Vec;

use super::floors::Floor;
use super::report::Report;
use super::run::LIMIT_BITS;
use super::tables::LogTable;
use super::trial::{CHANNELS, Options};
use crate::error::ModelError;
use crate::format::{ENTRIES_PER_BIT, ENTRY_OFFSET_BITS};
use crate::layout::TouchRule;
use crate::model::Floors;
use crate::model_buf::{ModelBuf, ModelParts, TableParts};
use crate::quantiser::Quantiser;
use crate::train::opinion::Opinion;

/// Where the largest entries of a table are smaller, it has no floor.
const LEAST_ENTRY: u16 = 32;

/// What training gives.
#[derive(Debug, Clone, PartialEq)]
pub struct JointModel {
    /// Class names, as they first appear.
    pub names: Vec<String>,
    /// How it was trained.
    pub options: Options,
    /// The scale of the codes of each channel.
    pub scales: [Quantiser; CHANNELS],
    /// Tables of log-likelihoods, not yet weighted: of samples, and of roughness.
    pub tables: Vec<LogTable>,
    /// Weight of each table, 0 to [`MAX_WEIGHT`](super::MAX_WEIGHT).
    pub weights: Vec<f64>,
    /// A floor a class.
    pub floors: Vec<Floor>,
    /// In how many poses it was trained, of some classes or of all.
    pub poses: usize,
    /// A second opinion; none where nothing is expected to differ, or too little was touched.
    pub opinion: Option<Opinion>,
    /// What held-out trials say of all this.
    pub report: Report,
}

impl JointModel {
    /// The model for the module: weights go into the entries, which are
    /// round(w (log₂ p + 20) · 1024).
    ///
    /// # Errors
    /// A setting that no model file can hold.
    pub fn model(&self) -> Result<ModelBuf, ModelError> {
        let unit = f64::from(ENTRIES_PER_BIT);
        // An opinion that names needs no tables.
        let names = self.opinion.as_ref().is_some_and(|opinion| opinion.names);
        // `as` saturates; weights are limited so that it need not.
        let entry = |bits: f64| (bits * unit).round() as u16;
        let tables = if names { &[] } else { self.tables.as_slice() };
        let entries: Vec<Vec<u16>> = tables
            .iter()
            .zip(&self.weights)
            .map(|(table, weight)| {
                let offset = f64::from(ENTRY_OFFSET_BITS);
                let log2_p = table.log2_p.iter();
                log2_p
                    .map(|log2_p| entry(weight * (log2_p + offset)))
                    .collect()
            })
            .collect();
        let tables: Vec<TableParts<'_>> = tables
            .iter()
            .zip(&entries)
            .map(|(table, entries)| TableParts {
                source: table.source,
                axes: &table.axes,
                entries,
            })
            .collect();
        let floors = (!names).then(|| {
            // Of entries of some units rounding would decide.
            let is_felt =
                |weight: &f64| entry(weight * f64::from(ENTRY_OFFSET_BITS)) >= LEAST_ENTRY;
            let [samples, roughness] = [0, 1].map(|n| self.weights.get(n).is_some_and(is_felt));
            let floor = |is_felt: bool, bits: f64| if is_felt { entry(bits) } else { 0 };
            let floors = self.floors.iter().map(|floors| Floors {
                samples: floor(samples, floors.samples),
                roughness: floor(roughness, floors.roughness),
            });
            floors.collect::<Vec<_>>()
        });
        ModelBuf::new(&ModelParts {
            names: &self.names,
            block: self.options.block,
            channels: &self.scales,
            tables: &tables,
            floors: floors.as_deref(),
            touch: Some(TouchRule {
                limit: (LIMIT_BITS * unit).round() as u32,
                gate: self.options.gate as f32,
                gap: self.options.gap,
            }),
            opinion: self.opinion.as_ref().map_or(&[], |opinion| &opinion.words),
        })
    }
}
