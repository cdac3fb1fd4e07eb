//! The contacts, to train on and to test with.

use crate::experiment::dataset::Dataset;
use crate::experiment::record::table::{Contact, contacts};
use crate::experiment::recording::{Recordings, of_set};
use crate::experiment::request::Request;
use crate::paper::pose::TEXTURES;
use crate::rigs::{Chance, seed_of};

/// A contact and x, sample by sample.
pub(super) type Signal = (Contact, Vec<f64>);

/// Half of the contacts to train on, the other half to test with: each set
/// has every pose once.
pub(super) struct Sets {
    pub(super) training: Vec<Signal>,
    pub(super) testing: Vec<Signal>,
    pub(super) rate_hz: f64,
}

impl Sets {
    pub(super) fn new(request: &Request, recordings: &Recordings) -> Self {
        let all = of_set(recordings, Dataset::Table);
        let contacts = contacts(request.extent);
        let poses = contacts.len() / 2;
        let mut chance = Chance::new(seed_of(request.seed, &[20]));
        let mut sets = Self {
            training: Vec::new(),
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
                    sets.training.push((*contact, x));
                } else {
                    sets.testing.push((*contact, x));
                }
            }
        }
        sets
    }

    /// The share of the variance of all signals that lies between textures at
    /// the same angle and speed.
    pub(super) fn share_of_texture(&self) -> f64 {
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
        let all: Vec<&Vec<f64>> = self.training.iter().map(|(_, x)| x).collect();
        let grand = mean_of(&all);
        let total: f64 = all.iter().map(|x| square(x, &grand)).sum();
        // Contacts of a pose stand together, its textures one after another.
        let mut within = 0.0;
        for pose in self.training.chunks(TEXTURES.len()) {
            let signals: Vec<&Vec<f64>> = pose.iter().map(|(_, x)| x).collect();
            let mean = mean_of(&signals);
            within += signals.iter().map(|x| square(x, &mean)).sum::<f64>();
        }
        within / total.max(f64::MIN_POSITIVE)
    }
}
