//! What was asked for: which experiments, how much of them, from which seed
//! and on which rigs; and the arms of an experiment: by the papers' protocol or with what they keep
//! drawn again, as it is or as a placebo.

use super::recording::Dataset;
use crate::rigs::{Chance, Rigs, seed_of};
use physics::Surface;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Name {
    Lep10,
    Lep12,
    Biotact,
    Pose,
    Psikharpax,
}

impl Name {
    pub(crate) const ALL: &'static [Self] = &[
        Self::Lep10,
        Self::Lep12,
        Self::Biotact,
        Self::Pose,
        Self::Psikharpax,
    ];

    /// As the command line has it.
    pub(crate) fn text(self) -> String {
        format!("{self:?}").to_lowercase()
    }

    pub(crate) const fn datasets(self) -> &'static [Dataset] {
        match self {
            Self::Lep10 | Self::Lep12 => &[Dataset::Floor],
            Self::Biotact => &[Dataset::Head],
            Self::Pose => &[Dataset::Table],
            Self::Psikharpax => &[Dataset::Pad, Dataset::Corridor, Dataset::Vibrissa],
        }
    }
}

/// How much of each experiment; the physics is the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Extent {
    /// Floor robot: trials of each rotation (LEP10 and LEP12: 4); of natural motion there are twice
    /// as many (LEP10 section III-D).
    pub(crate) trials: usize,
    /// Whisking head: whisks of each condition (BIOTACT: 12).
    pub(crate) whisks: usize,
    /// XY table: every how-manieth angle and speed is used (POSE: all).
    pub(crate) stride: usize,
    /// Fixed head: sweeps of each sandpaper to train on and to test with (PSIK: 300 and 100; five
    /// seeds have 200 and 50 together).
    pub(crate) sweeps: (usize, usize),
    /// Corridor: runs of each to train on (of these, to test with), and to decide in (PSIK: 10, 3,
    /// 20; five seeds have 20 to decide in together).
    pub(crate) runs: (usize, usize, usize),
}

impl Extent {
    /// As much as the papers, but for PSIK: of that, as much over five seeds or so.
    pub(crate) const FULL: Self = Self {
        trials: 4,
        whisks: 12,
        stride: 1,
        sweeps: (40, 10),
        runs: (10, 3, 4),
    };
    /// The least with which an experiment can still fail.
    pub(crate) const QUICK: Self = Self {
        trials: 2,
        whisks: 4,
        stride: 3,
        sweeps: (6, 2),
        runs: (2, 1, 1),
    };
}

/// What two recordings of one class share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Protocol {
    /// What is set up once stays, as in the papers: a class has its spot of the surface.
    ///
    /// - LEP10 section III-A, LEP12 section 4.1: "the initial 8 seconds of each trial was used for
    ///   training data, and the final 8 seconds" for validation: halves of one trial share its
    ///   placement.
    /// - BIOTACT section IV-B: surfaces "rigidly attached to the robot arm's support post", a
    ///   trajectory that "was preprogrammed", twelve whisks. That the arm moves between whisks, or
    ///   meets another spot, is not said.
    /// - POSE section II-A: "Repeatability of the robot is ± 0.01 mm"; section II-B: sandpapers
    ///   "affixed" to the object. That another spot is met is not said.
    /// - PSIK section 3.2.1: a sheet presented with "a small amount of variability in position
    ///   (~ ± 1 cm) between each trial"; section 3.3: walls "fixed on the sides" of corridors.
    AsInPaper,
    /// It is drawn again for each recording, and for each half of a trial and each whisk:
    /// what holds for a surface wherever it is touched.
    DrawnAgain,
}

impl Protocol {
    /// The keys of rigs that it sets, beside where [`Request::set_up`] draws the
    /// spot. The files of the rigs are as in the papers.
    pub(crate) const fn keys(self) -> &'static [&'static str] {
        match self {
            Self::AsInPaper => &[],
            Self::DrawnAgain => &[
                // Training and validation of a trial each have a placement.
                "floor.placements=2",
                // For each whisk: the arm's repeatability of a tenth of a millimetre, and a spot
                // 5 mm either way (both chosen).
                "head.placement_sd_m=0.0001",
                "head.spot_spread_m=0.005",
            ],
        }
    }

    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::AsInPaper => "as in the paper",
            Self::DrawnAgain => "drawn again",
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Placebo {
    /// All classes are one: one texture at one place, under different labels.
    Labels,
    /// All textures are one, each label at a spot of its own; distances, angles and speeds stay
    /// what they are. What tells these labels apart recognises the spot.
    Spots,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Arm {
    pub(crate) protocol: Protocol,
    pub(crate) placebo: Option<Placebo>,
}

impl Arm {
    pub(crate) const MAIN: Self = Self::of(Protocol::AsInPaper, None);
    pub(crate) const AGAIN: Self = Self::of(Protocol::DrawnAgain, None);
    pub(crate) const LABELS: Self = Self::of(Protocol::AsInPaper, Some(Placebo::Labels));
    pub(crate) const SPOTS: Self = Self::of(Protocol::AsInPaper, Some(Placebo::Spots));
    pub(crate) const AGAIN_LABELS: Self = Self::of(Protocol::DrawnAgain, Some(Placebo::Labels));

    /// All that a page has; a quick one has the first three.
    pub(crate) const ALL: &[Self] = &[
        Self::MAIN,
        Self::AGAIN,
        Self::SPOTS,
        Self::LABELS,
        Self::AGAIN_LABELS,
    ];
    pub(crate) const QUICK: &[Self] = Self::ALL.split_at(3).0;

    const fn of(protocol: Protocol, placebo: Option<Placebo>) -> Self {
        Self { protocol, placebo }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Request {
    pub(crate) names: Vec<Name>,
    pub(crate) extent: Extent,
    /// All chance comes from it.
    pub(crate) seed: u64,
    pub(crate) rigs: Rigs,
    pub(crate) arm: Arm,
    /// Whether what has no textures in it and PSIK's maze are done, too.
    pub(crate) is_whole: bool,
}

impl Request {
    /// What is felt for a texture of some: itself, or that of all in a placebo.
    pub(crate) fn surface(&self, all: &[&str], texture: usize, of_placebo: usize) -> Surface {
        let felt = self.arm.placebo.map_or(texture, |_| of_placebo);
        self.rigs.surfaces.of(all[felt])
    }

    /// The distance, angle or speed that is felt for `place`: itself, or that of all where labels
    /// alone differ.
    pub(crate) fn place(&self, place: usize, of_placebo: usize) -> usize {
        match self.arm.placebo {
            Some(Placebo::Labels) => of_placebo,
            _ => place,
        }
    }

    /// The seed of what is set up once: as in the papers for a label of texture, and for a `trial`
    /// of it where it has several; else for each recording, whose seed is given.
    pub(crate) fn set_up(
        &self,
        dataset: Dataset,
        (label, trial): (usize, usize),
        recording: u64,
    ) -> u64 {
        /// Apart from the seeds of jobs.
        const KEPT: u64 = 1 << 32;
        if self.arm.protocol == Protocol::DrawnAgain {
            return seed_of(recording, &[KEPT]);
        }
        let label = self.place(label, 0) as u64;
        let parts = [dataset.drawn_as() as u64, KEPT, label, trial as u64];
        seed_of(self.seed, &parts)
    }

    /// The spot of a surface that is met, m along and across it, within a metre either way.
    pub(crate) fn spot_m(&self, dataset: Dataset, label: usize, recording: u64) -> [f64; 2] {
        let mut chance = Chance::new(self.set_up(dataset, (label, 0), recording));
        [0, 1].map(|_| chance.between(-1.0, 1.0))
    }

    /// A quick run on the rigs that are built in.
    #[cfg(test)]
    pub(crate) fn quick(names: &[Name], seed: u64) -> Self {
        Self {
            names: names.to_vec(),
            extent: Extent::QUICK,
            seed,
            rigs: Rigs::with(&[]),
            arm: Arm::MAIN,
            is_whole: true,
        }
    }
}
