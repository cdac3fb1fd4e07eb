//! What is varied, and what came of it.

use anyhow::Result;
use host_sim::training;
use tactile::ModelBuf;
use tactile::train::Expect;
use tactile::train::joint::{JointModel, Options};

use super::instructions;
use crate::accuracy::counts::Counts;
use crate::decisions::figures::{Figures, over};
use crate::decisions::goals::Trained;
use crate::decisions::ground::{Ground, LONGEST_S};
use crate::moments::range;

pub(super) struct Setting {
    pub(super) name: &'static str,
    /// The values tried, the cheapest first.
    pub(super) values: &'static [u32],
    pub(super) default: fn(&Ground) -> u32,
    /// Of a training; none where it is refused.
    pub(super) model: fn(u32, &Ground, &Trained) -> Result<Option<ModelBuf>>,
    /// The last column, and what it says of a value and of the bytes of its model.
    pub(super) last: &'static str,
    pub(super) cost: fn(&Counts, u32, usize) -> String,
    /// By what the default is chosen, and whether by how soon decisions fall beside what it costs.
    pub(super) reason: &'static str,
    pub(super) is_for_time: bool,
}

pub(super) static SETTINGS: [Setting; 4] = [
    Setting {
        name: "bits of an entry",
        values: &[6, 8, 10, 12, 16],
        default: |_| 16,
        model: |bits, _, trained| Ok(Some(coarser(&trained.joint, bits).model()?)),
        last: "model",
        // The format has 16 bits; fewer are what a table would take.
        cost: |_, bits, bytes| kib(bytes * bits as usize / 16),
        reason: "a half-word is read in one instruction and needs no scale of its own; fewer bits \
                 would only save flash",
        is_for_time: false,
    },
    Setting {
        name: "bins an axis",
        values: &[8, 16, 24, 32, 64],
        default: |ground| ground.shipped().joint.options.bins as u32,
        model: |bins, ground, trained| {
            let bins = bins as usize;
            let options = trained.joint.options.clone();
            let options = Options { bins, ..options };
            of_options(options, ground.scene.duration_s, ground, trained).map(Some)
        },
        last: "model",
        cost: |_, _, bytes| kib(bytes),
        reason: "finer ones are quicker, but tell fewer of the unknown textures of the elastic whisker \
                 ([decisions.md](../decisions.md#28-bins-and-block-by-many-trainings))",
        is_for_time: true,
    },
    Setting {
        name: "samples of a block",
        values: &[80, 40, 20, 10, 5],
        default: |ground| ground.shipped().joint.options.block,
        model: |block, ground, trained| {
            let options = trained.joint.options.clone();
            let options = Options { block, ..options };
            of_options(options, ground.scene.duration_s, ground, trained).map(Some)
        },
        last: "instructions a sample, M4F; M0+",
        cost: |counts, block, _| instructions(counts, block),
        reason: "meant to be the quickest to decide that keeps the goals",
        is_for_time: true,
    },
    Setting {
        name: "s of training",
        values: &[10, 20, 40, LONGEST_S as u32],
        default: |ground| ground.scene.duration_s.round() as u32,
        // Too short a training is refused.
        model: |seconds, ground, trained| {
            let options = trained.joint.options.clone();
            Ok(of_options(options, seconds.into(), ground, trained).ok())
        },
        last: "model",
        cost: |_, _, bytes| kib(bytes),
        reason: "the scene's own length, in which each texture comes several times",
        is_for_time: false,
    },
];

/// Trained again on the first seconds of its run.
fn of_options(
    mut options: Options,
    seconds: f64,
    ground: &Ground,
    trained: &Trained,
) -> Result<ModelBuf> {
    options.expect = Expect::Same;
    let recording = ground.recording(trained.seed, seconds);
    let recordings = [(ground.scene.name.clone(), recording)];
    Ok(training::joint(&recordings, &options)?.model()?)
}

fn kib(bytes: usize) -> String {
    format!("{:.1} KiB", bytes as f64 / 1024.0)
}

/// A model whose entries have only so many bits: between the least and the largest of
/// each table are 2^bits − 1 equal steps.
fn coarser(joint: &JointModel, bits: u32) -> JointModel {
    let mut joint = joint.clone();
    if bits >= u16::BITS {
        return joint;
    }
    for table in &mut joint.tables {
        let (low, high) = range(table.log2_p.iter().copied());
        let step = (high - low) / f64::from((1_u32 << bits) - 1);
        if step > 0.0 {
            for log2_p in &mut table.log2_p {
                *log2_p = low + step * ((*log2_p - low) / step).round();
            }
        }
    }
    joint
}

/// What a setting's value gave, by training.
pub(super) struct Tried<'g> {
    pub(super) setting: &'static Setting,
    pub(super) value: u32,
    pub(super) ground: &'g Ground,
    pub(super) figures: Vec<(u64, Figures)>,
    pub(super) bytes: usize,
}

impl Tried<'_> {
    pub(super) fn mean(&self, figure: fn(&Figures) -> f64) -> (f64, f64) {
        let figures = self.figures.iter().map(|(_, figures)| figures);
        over(figures, figure)
    }

    /// Whether the mean over the trainings keeps the goals with a standard error to spare.
    pub(super) fn is_enough(&self) -> bool {
        let goals = self.ground.goals;
        let keeps = |(figure, most): (Figure, f64)| {
            let (mean, error) = self.mean(figure);
            mean + error <= most
        };
        let most = [1.5, 1.0, goals.contact_ms];
        let drawn = FIGURES.map(|(_, figure)| figure).into_iter().zip(most);
        let others: [(Figure, f64); 2] = [(undecided, goals.undecided), (known_refused, 6.0)];
        drawn.chain(others).all(keeps)
    }
}

fn undecided(figures: &Figures) -> f64 {
    100.0 * figures.undecided.share
}

/// Decisions on known textures that said "unknown", percent.
pub(super) fn known_refused(figures: &Figures) -> f64 {
    100.0 * figures.refused.share
}

type Figure = fn(&Figures) -> f64;

pub(super) type Drawn = (&'static str, Figure);

pub(super) const FIGURES: [Drawn; 3] = [
    ("errors, %", |f| 100.0 - f.hit_rate()),
    ("stated and found apart, points", |f| f.overstated().abs()),
    ("contact to a decision, ms", |f| f.contact_ms),
];
