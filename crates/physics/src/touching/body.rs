//! A whisker before a plate: its modes, the ground, and the state of their contact.

use crate::compliance::Compliance;
use crate::grid::Place;
use crate::modal::{ModalShaft, ModalState, ModalStep};
use crate::outline::{Outline, Tangent};
use crate::pose::PlatePose;
use crate::relief::Relief;
use crate::shapes::{Amplitudes, Curve};
use crate::surface::Surface;
use crate::vector::{V3, dot};

/// Rounds in which the place is found that is nearest to a body, and how far each goes at most, as
/// a share of the length.
const NEARER: usize = 5;
const FARTHEST: f64 = 0.05;

#[derive(Debug, Clone)]
pub(super) struct Body {
    pub(super) shaft: ModalShaft,
    pub(super) state: ModalState,
    /// How the shaft is bent, where the last part has computed it.
    pub(super) curve: Option<Curve>,
    pub(super) ground: Ground,
    pub(super) outline: Outline,
    pub(super) touch: Touch,
    /// Of another place that touches at once.
    pub(super) other: Touch,
    pub(super) last: Option<Last>,
    /// Steps in contact are cut 2ⁿ times as finely as usual.
    pub(super) finer: u32,
}

impl Body {
    /// A step where no plate is.
    pub(super) fn free(&mut self, steps: &Steps) {
        self.state.free(&steps.parts[0]);
        self.state.keep(0.0);
        if self.last.is_some() {
            self.leave();
        }
    }

    /// The place of a shaft that is nearest to the body, and the plane there where it is none for
    /// all places.
    pub(super) fn nearest(&self, curve: &Curve, pose: &PlatePose) -> (Place, Option<Tangent>) {
        let grid = &self.shaft.grid;
        if self.outline.is_plane() {
            return (curve.lowest(grid, pose.up()), None);
        }
        let tangent_at = |place: &Place| self.outline.tangent(pose.place(curve.at(place)));
        let leaves = |place: &Place, tangent: &Tangent| {
            let [leaves, round] = tangent.leaves(pose.vector(curve.along(place)));
            [
                leaves,
                round + curve.rise(place, pose.components(tangent.up()))[1],
            ]
        };
        let mut place = grid.lowest(&grid.nodes.map(|at_m| {
            let node = grid.anywhere(at_m);
            leaves(&node, &tangent_at(&node))[0]
        }));
        let mut tangent = tangent_at(&place);
        // Newton's method from there; a few rounds, as nodes are as far apart as bars are thick.
        for _ in 0..NEARER {
            let [leaves, grows] = leaves(&place, &tangent);
            if grows <= 0.0 || (place.at_m == self.shaft.length_m && leaves <= 0.0) {
                break;
            }
            let most_m = FARTHEST * self.shaft.length_m;
            place = grid.place(place.at_m - (leaves / grows).clamp(-most_m, most_m));
            tangent = tangent_at(&place);
        }
        (place, Some(tangent))
    }

    /// Over what distance the ground under a place changes, m.
    pub(super) fn finest_m(&self) -> f64 {
        let finest_m = self.ground.relief.finest_m;
        if self.outline.is_plane() {
            finest_m
        } else {
            finest_m.min(self.outline.radius_m)
        }
    }

    /// The plane that a shaft touches, where it is none for all places.
    pub(super) fn tangent(&self, curve: &Curve, pose: &PlatePose) -> Option<Tangent> {
        if self.outline.is_plane() {
            return None;
        }
        match self.touch.place.filter(|_| self.other.is_contact()) {
            Some(place) => Some(self.outline.tangent(pose.place(curve.at(&place)))),
            None => self.nearest(curve, pose).1,
        }
    }

    pub(super) fn place(&mut self, state: ModalState) {
        self.state = state;
        self.leave();
    }

    fn leave(&mut self) {
        self.curve = None;
        self.touch = Touch::default();
        self.other = Touch::default();
        self.last = None;
    }
}

/// The end of the last step before the plate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Last {
    pub(super) pose: PlatePose,
    /// No part of the shaft is below this over the mean plane, m.
    pub(super) above: f64,
}

/// Parts of a step are less than 2 to this power.
pub(super) const POWERS: usize = 6;

/// How modes move in a step of one length, and in a half, a quarter … of it.
#[derive(Debug, Clone, Default)]
pub(super) struct Steps {
    pub(super) dt_s: f64,
    pub(super) parts: [ModalStep; POWERS],
}

impl Steps {
    pub(super) fn new(shaft: &ModalShaft, dt_s: f64) -> Self {
        let of = |power: usize| ModalStep::new(shaft, dt_s / f64::from(1_u32 << power));
        Self {
            dt_s,
            parts: core::array::from_fn(of),
        }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Ground {
    given: Surface,
    /// With its values limited to their ranges.
    pub(super) surface: Surface,
    pub(super) relief: Relief,
    pub(super) compliance_m_n: f64,
}

impl Ground {
    pub(super) fn new(given: Surface, tip_radius_m: f64) -> Self {
        let surface = given.limited();
        Self {
            given,
            surface,
            relief: Relief::new(&surface, tip_radius_m),
            compliance_m_n: 1.0 / surface.stiffness_n_m,
        }
    }

    /// Whether this is the ground of a surface already.
    #[inline]
    pub(super) fn is_of(&mut self, given: &Surface) -> bool {
        if self.given == *given {
            return true;
        }
        let same = given.limited() == self.surface;
        if same {
            self.given = *given;
        }
        same
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Touch {
    /// Stretch along the whisker's axes x, y and z, m.
    pub(super) stretch: V3,
    pub(super) spring_j: f64,
    /// Where on the shaft; none: has not touched yet.
    pub(super) place: Option<Place>,
    /// Where it is expected to touch in the next part, m from the base.
    pub(super) next_m: f64,
    /// Where the foot is, plate coordinates, m, and which place of the ground it feels; none: the
    /// one that it is over.
    pub(super) foot: V3,
    pub(super) felt: Option<[f64; 2]>,
    /// Height and slopes under the foot, if known.
    pub(super) ground: Option<[f64; 3]>,
    /// Force on the shaft, the mean of the part, plate coordinates, N.
    pub(super) force: V3,
    /// The same on each shape.
    pub(super) forces: Amplitudes,
    /// Its normal component; positive: in contact.
    pub(super) normal_n: f64,
    pub(super) stuck: bool,
    pub(super) slip_m_s: f64,
    /// By how much the ground is taken as lower than it is, m.
    pub(super) lowered_m: f64,
}

impl Touch {
    #[inline]
    pub(super) fn in_the_air(compliance: &Compliance, stretch: V3) -> Self {
        let force = compliance.force(stretch);
        Self {
            stretch,
            spring_j: -0.5 * dot(force, stretch),
            ..Self::default()
        }
    }

    #[inline]
    pub(super) fn is_contact(&self) -> bool {
        self.normal_n > 0.0
    }
}
