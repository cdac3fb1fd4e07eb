//! POSE: angle, speed and texture of one brief contact, by the template, the
//! spectral template and features.

mod matrices;
mod rules;
mod tables;

use tactile::score::{Confusion, Statistics};

use super::dataset::Dataset;
use super::page::Section;
use super::paper::pose::{ANGLES_DEG, ROWS, SPEEDS_MM_S, TEXTURE_ALONE, TEXTURES};
use super::record::table::{Contact, contacts, speeds};
use super::recording::Recordings;
use super::request::{Name, Request};
use crate::rigs::{Chance, seed_of};
use host_sim::Error;
use host_sim::progress::Verbosity;
use rules::{features, spectral, template};

fn refused(error: impl std::fmt::Display) -> Error {
    Error::Work(format!("POSE: {error}"))
}

/// A contact and x, sample by sample.
type Signal = (Contact, Vec<f64>);

/// Half of the contacts to learn from, the other half to test with: each set
/// has every pose once.
struct Sets {
    learning: Vec<Signal>,
    testing: Vec<Signal>,
    rate_hz: f64,
}

impl Sets {
    fn new(request: &Request, recordings: &Recordings) -> Self {
        let all = recordings.of(Dataset::Table);
        let contacts = contacts(request.scale);
        let poses = contacts.len() / 2;
        let mut chance = Chance::new(seed_of(request.seed, &[20]));
        let mut sets = Self {
            learning: Vec::new(),
            testing: Vec::new(),
            rate_hz: request.rigs.table.tick_hz,
        };
        for pose in 0..poses {
            let first = chance.among(2);
            for time in [first, 1 - first] {
                let job = time * poses + pose;
                let (Some(contact), Some(recording)) = (contacts.get(job), all.get(job)) else {
                    continue;
                };
                let samples = recording.part(0, recording.len()).iter();
                let x = samples.step_by(2).map(|x| f64::from(*x)).collect();
                if time == first {
                    sets.learning.push((*contact, x));
                } else {
                    sets.testing.push((*contact, x));
                }
            }
        }
        sets
    }
}

impl Sets {
    /// The share of the variance of all signals that lies between textures at
    /// the same angle and speed.
    fn share_of_texture(&self) -> f64 {
        let mean_of = |signals: &[&Vec<f64>]| -> Vec<f64> {
            let length = signals.first().map_or(0, |x| x.len());
            let mut mean = vec![0.0; length];
            for x in signals {
                for (mean, x) in mean.iter_mut().zip(x.iter()) {
                    *mean += x / signals.len() as f64;
                }
            }
            mean
        };
        let square = |x: &[f64], mean: &[f64]| -> f64 {
            x.iter().zip(mean).map(|(x, m)| (x - m) * (x - m)).sum()
        };
        let all: Vec<&Vec<f64>> = self.learning.iter().map(|(_, x)| x).collect();
        let grand = mean_of(&all);
        let total: f64 = all.iter().map(|x| square(x, &grand)).sum();
        // Contacts of a pose stand together, its textures one after another.
        let mut within = 0.0;
        for pose in self.learning.chunks(TEXTURES.len()) {
            let signals: Vec<&Vec<f64>> = pose.iter().map(|(_, x)| x).collect();
            let mean = mean_of(&signals);
            within += signals.iter().map(|x| square(x, &mean)).sum::<f64>();
        }
        within / total.max(f64::MIN_POSITIVE)
    }
}

/// What a classifier makes of the test set: a matrix a property.
#[derive(Debug, Clone)]
struct Scores([Confusion; 3]);

impl Scores {
    fn new() -> Self {
        Self([ANGLES_DEG.len(), SPEEDS_MM_S.2, TEXTURES.len()].map(Confusion::new))
    }

    /// Counts a contact: its classes of angle, speed and texture, and those named.
    fn add(&mut self, truth: &Contact, named: [usize; 3]) -> Result<(), Error> {
        let truth = [truth.angle, truth.speed, truth.texture];
        for ((score, truth), named) in self.0.iter_mut().zip(truth).zip(named) {
            score.add(truth, Some(named)).map_err(refused)?;
        }
        Ok(())
    }

    /// κ of each property.
    fn kappa(&self) -> [f64; 3] {
        self.0.each_ref().map(|score| score.kappa().unwrap_or(0.0))
    }

    /// Hit rate of each property, percent.
    fn hit(&self) -> [f64; 3] {
        self.0
            .each_ref()
            .map(|score| 100.0 * score.hit_rate().unwrap_or(0.0))
    }

    /// Errors of each property in its unit.
    fn errors(&self) -> [Option<Statistics>; 3] {
        let textures: Vec<f64> = (0..TEXTURES.len()).map(|n| n as f64).collect();
        [
            self.0[0].errors(&ANGLES_DEG),
            self.0[1].errors(&speeds()),
            self.0[2].errors(&textures),
        ]
    }
}

/// Evaluates the recordings.
pub(super) fn evaluate(request: &Request, recordings: &Recordings) -> Result<Section, Error> {
    let sets = Sets::new(request, recordings);
    let by_template = template(&sets)?;
    let by_spectrum = spectral(&sets)?;
    let by_features = features(&sets)?;
    let mut section = Section::default();
    section
        .page
        .heading(2, "POSE: one contact at an unknown angle and speed");
    section.page.say(format_args!(
        "A textured surface is carried into a fixed whisker (`studies/rigs/table.toml`): {} contacts to \
         learn from and {} to test with, each every combination of angle, speed and texture once. \
         Signals are x alone, as the paper's count of samples says. κ is Cohen's. That signals are \
         aligned by their peaks and that the approach ends at a deflection of 0.05 was chosen \
         after a first run; the paper's notch at the whisker's resonance is left out.",
        sets.learning.len(),
        sets.testing.len()
    ));
    let rows = [&by_template, &by_spectrum, &by_features.together];
    tables::main(&mut section, &rows);
    matrices::section(&mut section, &rows)?;
    tables::features(&mut section, &by_features.textures);
    let alone = [
        rules::template_of_textures(&sets)?,
        rules::spectral_of_textures(&sets)?,
    ];
    section.page.say(format_args!(
        "κ of texture alone, whatever the pose (one template a texture): template {:.2} / \
         **{:.2}**, spectral template {:.2} / **{:.2}**.",
        TEXTURE_ALONE[0], alone[0], TEXTURE_ALONE[1], alone[1]
    ));
    let why = why(request, &sets)?;
    claims(&mut section, &rows, &why);
    for (name, scores) in [
        "template by sum of squares, 352 poses",
        "spectral template |DFT|, 352 poses",
        "features f1–f5, quadratic",
    ]
    .into_iter()
    .zip(rows)
    {
        for (property, hit) in ["angle", "speed", "texture"].into_iter().zip(scores.hit()) {
            section.score(name, property, hit);
        }
    }
    Ok(section)
}

/// Largest deviation of a latency in the comparison below, s.
const IRREGULAR_S: f64 = 0.15;

/// Why the classifiers rank as they do, measured: the same contacts with a
/// controller that is much less regular; and how much of the signal differs
/// between textures.
fn why(request: &Request, sets: &Sets) -> Result<String, Error> {
    let mut other = request.clone();
    other.names = vec![Name::Pose];
    let table = &mut other.rigs.table;
    table.latency_spread_s = IRREGULAR_S.min(table.latency_s);
    let recordings = Recordings::make(&other, &other.jobs(), Verbosity::Quiet)?;
    let irregular = Sets::new(&other, &recordings);
    let kappas = [
        template(&irregular)?.kappa(),
        spectral(&irregular)?.kappa(),
        features(&irregular)?.together.kappa(),
    ];
    let text = |property: usize| {
        let [a, b, c] = kappas.map(|kappa| kappa[property]);
        format!("{a:.2}, {b:.2} and {c:.2}")
    };
    let share = sets.share_of_texture();
    Ok(format!(
        "the controller's latency here is within {:.0} ms of 300 ms, so that signals of the same \
         pose line up; within {:.0} ms, κ of template, spectral template and features is {} for \
         angle, {} for speed and {} for texture. Of the variance of all signals {:.1} % lies \
         between textures at the same angle and speed",
        1000.0 * request.rigs.table.latency_spread_s,
        1000.0 * IRREGULAR_S,
        text(0),
        text(1),
        text(2),
        100.0 * share
    ))
}

fn claims(section: &mut Section, rows: &[&Scores; 3], why: &str) {
    let kappas = rows.map(Scores::kappa);
    let all = |property: usize| kappas.map(|kappa| kappa[property]);
    for (property, name, best) in [(0, "angle", 1), (2, "texture", 1), (1, "speed", 2)] {
        let ours = all(property);
        let paper = [0, 1, 2].map(|row: usize| ROWS[row].figures[property].kappa);
        let most = ours.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let text = |kappas: [f64; 3]| {
            let [a, b, c] = kappas;
            format!("template {a:.2}, spectral {b:.2}, features {c:.2}")
        };
        section.claim(
            format_args!("POSE: {} are best for {name}", ROWS[best].what),
            text(paper),
            text(ours),
            ours[best] >= most,
            why,
        );
    }
}
