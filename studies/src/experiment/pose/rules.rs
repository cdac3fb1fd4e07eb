//! The classifiers of POSE section II-C.

use anyhow::Result;
use rayon::prelude::*;
use tactile::score::Confusion;

use super::notch::{notched, resonance_hz};
use super::scores::Scores;
use super::sets::{Sets, Signal};
use crate::classifiers::features::{
    CENTROID, CENTROID_MAGNITUDE, Extractor, PEAK, SLOPE, TOTAL_MAGNITUDE,
};
use crate::classifiers::regression::Regression;
use crate::classifiers::spectrum::{Bins, Measure, Spectrum};
use crate::classifiers::template::TemplateTrainer;
use crate::experiment::record::table::Contact;
use crate::paper::pose::{ANGLES_DEG, SPEEDS_MM_S, TEXTURES};

/// Contact counts from this deflection on, sensor codes: above the noise.
const ONSET_CODES: f64 = 40.0;

/// Nearest templates, by the sum of squared errors of signals (eq. 1) or of |DFT| (eq. 2).
#[derive(Clone, Copy)]
pub(super) enum Nearest {
    Signal,
    Spectrum,
}

impl Nearest {
    /// What of a signal is held against templates.
    fn vectors(self, signals: &[Signal]) -> Result<Vec<Vec<f64>>> {
        let length = signals.first().map_or(0, |(_, x)| x.len());
        let spectrum = Spectrum::new(Bins::all(length));
        let vector = |(_, x): &Signal| match self {
            Self::Signal => Ok(x.clone()),
            Self::Spectrum => spectrum.of(x.iter().copied(), Measure::Magnitude),
        };
        signals.par_iter().map(vector).collect()
    }

    /// The class of the nearest template to each contact of the test, by templates of the training
    /// contacts, each of the class that `class` gives it.
    fn named(self, sets: &Sets, class: impl Fn(usize, &Contact) -> usize) -> Result<Vec<usize>> {
        let mut trainer = TemplateTrainer::default();
        let vectors = self.vectors(&sets.training)?;
        for (n, ((contact, _), vector)) in sets.training.iter().zip(vectors).enumerate() {
            trainer.add(class(n, contact), &vector)?;
        }
        let templates = trainer.train();
        let testing = self.vectors(&sets.testing)?;
        Ok(testing.par_iter().map(|x| templates.classify(x)).collect())
    }

    /// By the nearest of all training contacts; class n is the n-th training contact.
    pub(super) fn contacts(self, sets: &Sets) -> Result<Scores> {
        let mut scores = Scores::new();
        let found = self.named(sets, |n, _| n)?;
        for ((truth, _), found) in sets.testing.iter().zip(found) {
            let (named, _) = &sets.training[found];
            scores.add(truth, [named.angle, named.speed, named.texture])?;
        }
        Ok(scores)
    }

    /// κ of texture by one template a texture.
    pub(super) fn textures(self, sets: &Sets) -> Result<f64> {
        let found = self.named(sets, |_, contact| contact.texture)?;
        Ok(of_texture(sets, &found)?.kappa().unwrap_or(0.0))
    }
}

fn of_texture(sets: &Sets, named: &[usize]) -> Result<Confusion> {
    let mut score = Confusion::new(TEXTURES.len());
    for ((contact, _), named) in sets.testing.iter().zip(named) {
        score.add(contact.texture, Some(*named))?;
    }
    Ok(score)
}

pub(super) struct ByFeatures {
    /// f2 for angle, f1 for speed, f5 for texture (Figs. 7 and 8).
    pub(super) together: Scores,
    /// Texture by f3, f4, f5 (second degree) and by all three (fourth degree).
    pub(super) textures: Vec<Confusion>,
}

/// Features f1 to f5 (eq. 3–7) with polynomial regression, rounded to the
/// nearest class; those of texture behind a notch at the whisker's resonance.
pub(super) fn features(sets: &Sets) -> Result<ByFeatures> {
    let extract = |signals: &[Signal]| -> Result<Vec<[f64; 5]>> {
        let length = signals.first().map_or(0, |(_, x)| x.len());
        let extractor = Extractor::new(ONSET_CODES, sets.rate_hz, length)?;
        let resonance_hz = resonance_hz()?;
        let features = signals.iter().map(|(_, x)| {
            let [f1, f2, ..] = extractor.features(x)?;
            let x = notched(x, resonance_hz, sets.notch_quality, sets.rate_hz);
            let [_, _, f3, f4, f5] = extractor.features(&x)?;
            Ok([f1, f2, f3, f4, f5])
        });
        features.collect()
    };
    let (training, testing) = (extract(&sets.training)?, extract(&sets.testing)?);
    let estimate = |chosen: &[usize], degree: u8, property: usize, classes: usize| {
        let truth = |signal: &Signal| {
            let (contact, _) = signal;
            [contact.angle, contact.speed, contact.texture][property]
        };
        let some = |features: &[f64; 5]| -> Vec<f64> {
            chosen.iter().map(|&feature| features[feature]).collect()
        };
        let examples: Vec<(Vec<f64>, f64)> = sets
            .training
            .iter()
            .zip(&training)
            .map(|(signal, features)| (some(features), truth(signal) as f64))
            .collect();
        let regression = Regression::fit(degree, &examples)?;
        let last = classes.saturating_sub(1) as f64;
        let named = testing.iter().map(|features| {
            let value = regression.value(&some(features));
            value.round().clamp(0.0, last) as usize
        });
        anyhow::Ok(named.collect::<Vec<usize>>())
    };
    let angle = estimate(&[SLOPE], 2, 0, ANGLES_DEG.len())?;
    let speed = estimate(&[PEAK], 2, 1, SPEEDS_MM_S.2)?;
    let chosen: [(&[usize], u8); 4] = [
        (&[CENTROID], 2),
        (&[CENTROID_MAGNITUDE], 2),
        (&[TOTAL_MAGNITUDE], 2),
        (&[CENTROID, CENTROID_MAGNITUDE, TOTAL_MAGNITUDE], 4),
    ];
    let mut textures = Vec::new();
    let mut total = Vec::new();
    for (n, (chosen, degree)) in chosen.into_iter().enumerate() {
        let named = estimate(chosen, degree, 2, TEXTURES.len())?;
        textures.push(of_texture(sets, &named)?);
        if n == 2 {
            total = named;
        }
    }
    let mut together = Scores::new();
    for (n, (contact, _)) in sets.testing.iter().enumerate() {
        together.add(contact, [angle[n], speed[n], total[n]])?;
    }
    Ok(ByFeatures { together, textures })
}
