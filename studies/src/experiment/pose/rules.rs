//! The classifiers of POSE section II-C.

use classifiers::feature_train::{Extractor, FeatureSettings};
use classifiers::features::Feature;
use classifiers::regression::Regression;
use classifiers::spectral_train::SpectralTrainer;
use classifiers::spectrum::{Bins, Measure};
use classifiers::template_train::TemplateTrainer;
use rayon::prelude::*;
use tactile::score::Confusion;

use super::notch::{notched, resonance_hz};
use super::scores::Scores;
use super::sets::{Sets, Signal};
use crate::paper::pose::{ANGLES_DEG, SPEEDS_MM_S, TEXTURES};
use crate::refused::refused;
use host_sim::Error;

/// Contact counts from this deflection on, sensor codes: above the noise.
const ONSET_CODES: f64 = 40.0;

/// The place of the least error.
fn least(errors: &[f64]) -> usize {
    let places = errors.iter().enumerate();
    let found = places.min_by(|a, b| a.1.total_cmp(b.1));
    found.map_or(0, |(place, _)| place)
}

fn length(sets: &Sets) -> usize {
    sets.training.first().map_or(0, |(_, x)| x.len())
}

/// The nearest of all training contacts, by the errors that `errors` gives;
/// class n is the n-th training contact.
fn nearest(
    sets: &Sets,
    errors: impl Fn(&[f64]) -> Result<Vec<f64>, Error> + Sync,
) -> Result<Scores, Error> {
    let found: Result<Vec<usize>, Error> = sets
        .testing
        .par_iter()
        .map(|(_, x)| Ok(least(&errors(x)?)))
        .collect();
    let mut scores = Scores::new();
    for ((truth, _), found) in sets.testing.iter().zip(found?) {
        if let Some((named, _)) = sets.training.get(found) {
            scores.add(truth, [named.angle, named.speed, named.texture])?;
        }
    }
    Ok(scores)
}

/// Sum of squared errors (eq. 1) against every training contact.
pub(super) fn template(sets: &Sets) -> Result<Scores, Error> {
    let mut trainer = TemplateTrainer::new(1, length(sets)).map_err(refused)?;
    for (class, (_, x)) in sets.training.iter().enumerate() {
        trainer.add(class, x).map_err(refused)?;
    }
    let templates = trainer.train().map_err(refused)?;
    nearest(sets, |x| Ok(templates.errors(x)))
}

fn spectral_trainer(sets: &Sets) -> Result<SpectralTrainer, Error> {
    let block = length(sets);
    let bins = Bins::all(block as u32);
    SpectralTrainer::new(1, bins, block, Measure::Magnitude).map_err(refused)
}

/// The same on |DFT| (eq. 2).
pub(super) fn spectral(sets: &Sets) -> Result<Scores, Error> {
    let mut trainer = spectral_trainer(sets)?;
    for (class, (_, x)) in sets.training.iter().enumerate() {
        trainer.add(class, x).map_err(refused)?;
    }
    let templates = trainer.train().map_err(refused)?;
    nearest(sets, |x| templates.clone().errors(x).map_err(refused))
}

/// κ of texture by one template a texture.
pub(super) fn template_of_textures(sets: &Sets) -> Result<f64, Error> {
    let mut trainer = TemplateTrainer::new(1, length(sets)).map_err(refused)?;
    for (contact, x) in &sets.training {
        trainer.add(contact.texture, x).map_err(refused)?;
    }
    let templates = trainer.train().map_err(refused)?;
    textures(sets, |x| Ok(templates.errors(x)))
}

/// The same on |DFT|.
pub(super) fn spectral_of_textures(sets: &Sets) -> Result<f64, Error> {
    let mut trainer = spectral_trainer(sets)?;
    for (contact, x) in &sets.training {
        trainer.add(contact.texture, x).map_err(refused)?;
    }
    let mut templates = trainer.train().map_err(refused)?;
    textures(sets, |x| templates.errors(x).map_err(refused))
}

fn textures(
    sets: &Sets,
    mut errors: impl FnMut(&[f64]) -> Result<Vec<f64>, Error>,
) -> Result<f64, Error> {
    let mut score = Confusion::new(TEXTURES.len());
    for (contact, x) in &sets.testing {
        let named = least(&errors(x)?);
        score.add(contact.texture, Some(named)).map_err(refused)?;
    }
    Ok(score.kappa().unwrap_or(0.0))
}

/// What features tell.
pub(super) struct ByFeatures {
    /// f2 for angle, f1 for speed, f5 for texture (Figs. 7 and 8).
    pub(super) together: Scores,
    /// Texture by f3, f4, f5 (second degree) and by all three (fourth degree).
    pub(super) textures: Vec<Confusion>,
}

/// Features f1 to f5 (eq. 3–7) with polynomial regression, rounded to the
/// nearest class; those of texture behind a notch at the whisker's resonance.
pub(super) fn features(sets: &Sets) -> Result<ByFeatures, Error> {
    let settings =
        FeatureSettings::pose(0.0, ONSET_CODES, sets.rate_hz, length(sets)).map_err(refused)?;
    let extract = |signals: &[Signal]| -> Result<Vec<[f64; 5]>, Error> {
        let mut extractor = Extractor::new(settings).map_err(refused)?;
        let resonance_hz = resonance_hz()?;
        let features = signals.iter().map(|(_, x)| {
            let [f1, f2, ..] = extractor.features(x).map_err(refused)?;
            let x = notched(x, resonance_hz, sets.notch_quality, sets.rate_hz);
            let [_, _, f3, f4, f5] = extractor.features(&x).map_err(refused)?;
            Ok([f1, f2, f3, f4, f5])
        });
        features.collect()
    };
    let (training, testing) = (extract(&sets.training)?, extract(&sets.testing)?);
    let estimate = |chosen: &[Feature], degree: u8, property: usize, classes: usize| {
        let truth = |signal: &Signal| {
            let (contact, _) = signal;
            [contact.angle, contact.speed, contact.texture][property]
        };
        let some = |features: &[f64; 5]| -> Vec<f64> {
            chosen.iter().map(|feature| feature.of(features)).collect()
        };
        let examples: Vec<(Vec<f64>, f64)> = sets
            .training
            .iter()
            .zip(&training)
            .map(|(signal, features)| (some(features), truth(signal) as f64))
            .collect();
        let regression = Regression::fit(degree, &examples).map_err(refused)?;
        let last = classes.saturating_sub(1) as f64;
        let named = testing.iter().map(|features| {
            let value = regression.value(&some(features));
            value.round().clamp(0.0, last) as usize
        });
        Ok::<Vec<usize>, Error>(named.collect())
    };
    let angle = estimate(&[Feature::Slope], 2, 0, ANGLES_DEG.len())?;
    let speed = estimate(&[Feature::Peak], 2, 1, SPEEDS_MM_S.2)?;
    let of_texture: [(&[Feature], u8); 4] = [
        (&[Feature::Centroid], 2),
        (&[Feature::CentroidMagnitude], 2),
        (&[Feature::TotalMagnitude], 2),
        (
            &[
                Feature::Centroid,
                Feature::CentroidMagnitude,
                Feature::TotalMagnitude,
            ],
            4,
        ),
    ];
    let mut textures = Vec::new();
    let mut total = Vec::new();
    for (n, (chosen, degree)) in of_texture.into_iter().enumerate() {
        let named = estimate(chosen, degree, 2, TEXTURES.len())?;
        let mut score = Confusion::new(TEXTURES.len());
        for ((contact, _), named) in sets.testing.iter().zip(&named) {
            score.add(contact.texture, Some(*named)).map_err(refused)?;
        }
        textures.push(score);
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
