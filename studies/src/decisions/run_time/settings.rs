//! What is varied, and what came of it.

use anyhow::Result;
use tactile::ModelBuf;
use tactile::train::Expect;
use tactile::train::joint::{JointModel, Options};

use crate::decisions::figures::{Figures, over};
use crate::decisions::goals::Trained;
use crate::decisions::ground::{Ground, LONGEST_S};
use crate::moments::range;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Setting {
    /// Bits of an entry of a table, between the least and the largest of it.
    Bits,
    Bins,
    Block,
    Training,
}

impl Setting {
    pub(super) const ALL: [Self; 4] = [Self::Bits, Self::Bins, Self::Block, Self::Training];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Bits => "bits of an entry",
            Self::Bins => "bins an axis",
            Self::Block => "samples of a block",
            Self::Training => "s of training",
        }
    }

    /// The values tried, the cheapest first.
    pub(super) const fn values(self) -> &'static [u32] {
        match self {
            Self::Bits => &[6, 8, 10, 12, 16],
            Self::Bins => &[8, 16, 24, 32, 64],
            Self::Block => &[80, 40, 20, 10, 5],
            Self::Training => &[10, 20, 40, LONGEST_S as u32],
        }
    }

    pub(super) fn default(self, ground: &Ground) -> u32 {
        let options = &ground.shipped().joint.options;
        match self {
            Self::Bits => 16,
            Self::Bins => options.bins as u32,
            Self::Block => options.block,
            Self::Training => ground.scene.duration_s.round() as u32,
        }
    }

    pub(super) fn model(self, value: u32, ground: &Ground, trained: &Trained) -> Result<ModelBuf> {
        let options = trained.joint.options.clone();
        let seconds = match self {
            Self::Training => f64::from(value),
            _ => ground.scene.duration_s,
        };
        let joint = match self {
            Self::Bits => coarser(&trained.joint, value),
            Self::Bins | Self::Block | Self::Training => {
                let options = match self {
                    Self::Bins => Options {
                        bins: value as usize,
                        ..options
                    },
                    Self::Block => Options {
                        block: value,
                        ..options
                    },
                    _ => options,
                };
                let options = Options {
                    expect: Expect::Same,
                    ..options
                };
                ground.train_by(ground.recording(trained.seed, seconds), &options)?
            }
        };
        joint.model().map_err(anyhow::Error::new)
    }
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
    pub(super) setting: Setting,
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
