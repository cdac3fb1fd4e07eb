//! The classifiers of POSE section II-C, and what they make of angle, speed and texture: tables with
//! the paper's figures beside ours, and confusion matrices.

use anyhow::Result;
use rayon::prelude::*;
use tactile::score::{Confusion, Statistics};

use super::{Sets, Signal, notched, resonance_hz};
use crate::classifiers::{
    Bins, CENTROID, CENTROID_MAGNITUDE, Extractor, MAGNITUDE, PEAK, Regression, SLOPE, Spectrum,
    TOTAL_MAGNITUDE, Templates,
};
use crate::experiment::shades::{self, Matrix};
use crate::page::{Page, figure};
use crate::paper::pose::{ANGLES_DEG, Figure, ROWS, SPEEDS_MM_S, TEXTURE_FEATURES, TEXTURES};
use crate::rigs::table::{Contact, speeds};

/// Contact counts from this deflection on, sensor codes: above the noise.
const ONSET_CODES: f64 = 40.0;

/// Nearest templates, by the sum of squared errors of signals (eq. 1) or of |DFT| (eq. 2).
#[derive(Clone, Copy)]
pub(super) enum Nearest {
    Signal,
    Spectrum,
}

impl Nearest {
    fn vectors(self, signals: &[Signal]) -> Result<Vec<Vec<f64>>> {
        let length = signals.first().map_or(0, |(_, x)| x.len());
        let spectrum = Spectrum::new(Bins::all(length));
        let vector = |(_, x): &Signal| match self {
            Self::Signal => Ok(x.clone()),
            Self::Spectrum => spectrum.of(x.iter().copied(), MAGNITUDE),
        };
        signals.par_iter().map(vector).collect()
    }

    /// The class of the nearest template to each contact of the test, by templates of the training
    /// contacts, each of the class that `class` gives it.
    fn named(self, sets: &Sets, class: impl Fn(usize, &Contact) -> usize) -> Result<Vec<usize>> {
        let vectors = self.vectors(&sets.training)?;
        let known = sets.training.iter().zip(&vectors).enumerate();
        let known = known.map(|(n, ((contact, _), vector))| (class(n, contact), &vector[..]));
        let templates = Templates::of(known, false)?;
        let testing = self.vectors(&sets.testing)?;
        Ok(testing.par_iter().map(|x| templates.classify(x)).collect())
    }

    /// By the nearest of all training contacts; class n is the n-th training contact.
    pub(super) fn contacts(self, sets: &Sets) -> Result<Scores> {
        let mut scores = Scores::new();
        let found = self.named(sets, |n, _| n)?;
        for ((truth, _), found) in sets.testing.iter().zip(found) {
            let (named, _) = &sets.training[found];
            scores.add(truth, named)?;
        }
        Ok(scores)
    }

    /// κ of texture by one template a texture.
    pub(super) fn textures(self, sets: &Sets) -> Result<f64> {
        let found = self.named(sets, |_, contact| contact[2])?;
        Ok(of_texture(sets, &found)?.kappa().unwrap_or(0.0))
    }
}

fn of_texture(sets: &Sets, named: &[usize]) -> Result<Confusion> {
    let mut score = Confusion::new(TEXTURES.len());
    for ((contact, _), named) in sets.testing.iter().zip(named) {
        score.add(contact[2], Some(*named))?;
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
        let some = |features: &[f64; 5]| -> Vec<f64> {
            chosen.iter().map(|&feature| features[feature]).collect()
        };
        let examples = sets.training.iter().zip(&training);
        let examples = examples.map(|((contact, _), of)| (some(of), contact[property] as f64));
        let examples: Vec<(Vec<f64>, f64)> = examples.collect();
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
        together.add(contact, &[angle[n], speed[n], total[n]])?;
    }
    Ok(ByFeatures { together, textures })
}

/// What a classifier makes of the test set: a matrix a property.
#[derive(Debug, Clone)]
pub(super) struct Scores(pub(super) [Confusion; 3]);

impl Scores {
    pub(super) fn new() -> Self {
        Self([ANGLES_DEG.len(), SPEEDS_MM_S.2, TEXTURES.len()].map(Confusion::new))
    }

    /// Counts a contact: its classes of angle, speed and texture, and those named.
    pub(super) fn add(&mut self, truth: &Contact, named: &Contact) -> Result<()> {
        for ((score, truth), named) in self.0.iter_mut().zip(truth).zip(named) {
            score.add(*truth, Some(*named))?;
        }
        Ok(())
    }

    pub(super) fn kappa(&self) -> [f64; 3] {
        self.0.each_ref().map(|score| score.kappa().unwrap_or(0.0))
    }

    pub(super) fn hit(&self) -> [f64; 3] {
        let hit = |score: &Confusion| 100.0 * score.hit_rate().unwrap_or(0.0);
        self.0.each_ref().map(hit)
    }

    pub(super) fn errors(&self) -> [Option<Statistics>; 3] {
        let textures: Vec<f64> = (0..TEXTURES.len()).map(|n| n as f64).collect();
        [
            self.0[0].errors(&ANGLES_DEG),
            self.0[1].errors(&speeds()),
            self.0[2].errors(&textures),
        ]
    }
}

pub(super) fn kappas(page: &mut Page, rows: &[&Scores; 3]) {
    let errors = |paper: Figure, ours: Option<Statistics>| {
        let ours = ours.map_or("none".to_owned(), |s| {
            format!("**{} ({})**", figure(s.mean, 2), figure(s.sd, 1))
        });
        format!("{:.2} ({:.1}) / {ours}", paper.mean, paper.spread)
    };
    let lines = ROWS.iter().zip(rows).map(|(row, scores)| {
        let mut cells = vec![row.what.clone()];
        let (kappa, found) = (scores.kappa(), scores.errors());
        for k in 0..3 {
            let paper = row.figures[k];
            cells.push(format!("{:.2} / **{}**", paper.kappa, figure(kappa[k], 2)));
            cells.push(errors(paper, found[k]));
        }
        cells
    });
    page.say(
        "**κ and errors** (sections III-A to III-C, Table I, Figs. 7 and 8): paper / **ours**; \
         errors are the mean (and the spread) in degrees, mm/s and classes.",
    );
    page.table(
        "classifier | angle κ | angle error | speed κ | speed error | texture κ | texture error",
        lines,
    );
}

pub(super) fn table_of_features(page: &mut Page, found: &[Confusion]) {
    let classes: Vec<f64> = (0..TEXTURES.len()).map(|n| n as f64).collect();
    let lines = TEXTURE_FEATURES.iter().zip(found).map(|(feature, score)| {
        let errors = score.errors(&classes);
        let ours = errors.map_or("none".to_owned(), |s| {
            format!("{} ({})", figure(s.mean, 2), figure(s.sd, 2))
        });
        let alone = feature.alone.map(|kappa| format!("{kappa:.2}"));
        let (mean, spread) = feature.error;
        vec![
            feature.name.clone(),
            format!("{:.2}", feature.together),
            alone.unwrap_or("–".to_owned()),
            format!("**{}**", figure(score.kappa().unwrap_or(0.0), 2)),
            format!("{mean:.2} ({spread:.2}) / **{ours}**"),
        ]
    });
    page.say("**Texture by features** (section III-C and Table I).");
    page.table(
        "feature | κ in the paper, together | κ in the paper, alone | κ here | error, classes",
        lines,
    );
}

pub(super) fn matrices(page: &mut Page, rows: &[&Scores; 3]) -> Result<()> {
    let numbers = |values: &[f64]| values.iter().map(|value| format!("{value:.0}")).collect();
    let classes: [(&str, Vec<String>); 3] = [
        ("angle, degrees", numbers(&ANGLES_DEG)),
        ("speed, mm/s", numbers(&speeds())),
        ("texture", TEXTURES.map(str::to_owned).to_vec()),
    ];
    let mut matrices = Vec::new();
    for (row, scores) in ROWS.iter().zip(rows) {
        for ((what, classes), score) in classes.iter().zip(&scores.0) {
            matrices.push(Matrix {
                title: format!("{}: {what}", row.what),
                classes: classes.clone(),
                score: score.clone(),
            });
        }
    }
    page.say(
        "**Confusion**: a row is the true class, a column the one that was named; the darker, \
         the larger its share of the row.",
    );
    let svg = shades::matrices(&matrices, classes.len())?;
    let what = "Confusion matrices of three classifiers";
    page.picture("pose-confusion.svg", what, svg);
    Ok(())
}
