//! The arms of an experiment: by the papers' protocol or with what they keep drawn again, as it is
//! or as a placebo.

/// What two recordings of one class share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    /// The keys of rigs that it sets, beside where [`super::request::Request::set_up`] draws the
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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Placebo {
    /// All classes are one: one texture at one place, under different labels.
    Labels,
    /// All textures are one, each label at a spot of its own; distances, angles and speeds stay
    /// what they are. What tells these labels apart recognises the spot.
    Spots,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Arm {
    pub(crate) protocol: Protocol,
    pub(crate) placebo: Option<Placebo>,
}

impl Arm {
    pub(crate) const MAIN: Self = Self {
        protocol: Protocol::AsInPaper,
        placebo: None,
    };
    pub(crate) const AGAIN: Self = Self {
        protocol: Protocol::DrawnAgain,
        placebo: None,
    };
    pub(crate) const LABELS: Self = Self {
        placebo: Some(Placebo::Labels),
        ..Self::MAIN
    };
    pub(crate) const SPOTS: Self = Self {
        placebo: Some(Placebo::Spots),
        ..Self::MAIN
    };
    pub(crate) const AGAIN_LABELS: Self = Self {
        placebo: Some(Placebo::Labels),
        ..Self::AGAIN
    };

    /// All that a page has; a quick one has the first three.
    pub(crate) const ALL: &[Self] = &[
        Self::MAIN,
        Self::AGAIN,
        Self::SPOTS,
        Self::LABELS,
        Self::AGAIN_LABELS,
    ];
    pub(crate) const QUICK: &[Self] = Self::ALL.split_at(3).0;
}
