//! The shapes in which a shaft bends before a plate, and how they become places.
//!
//! Glossary:
//!
//! - *ψ(s)*: how far the tangent at the arc length s has turned from the base's
//!   direction, rad, as a vector across it, in axes x and y that move with the base;
//! - *shape*: ψ(s) = Σ φ′_k(s) q_k; the first are the modes, which have inertia, the
//!   others are static, without;
//! - *way*: how a place moves for a unit more of q_k along x, and along y.
//!
//! The tangent is (sin|ψ| ψ/|ψ|, cos|ψ|), a place its integral. The elastic energy
//! of an inextensible shaft that bends in a plane is ½ Σ ω_k² q_k² whatever its
//! angle, and so what is linear of it stays so; places alone are not. Inertia is taken as that of small
//! deflections, which costs 1e-3 of a base moment.
//!
//! Static shapes are what the modes leave out of four: the base turned with a straight shaft,
//! without which the base moment is no better than the shapes; the shaft under a force at its tip;
//! what that force's part along the shaft adds, ∫ w′ δw′ ds; and the shaft under a couple at its tip,
//! which lets it turn where it touches away from the tip. So that the energy of each is ½ a², its
//! unit is √J.

use crate::grid::{Grid, NODES, Place};
use crate::vector::{V3, add, dot};

/// Modes that are kept. For a shaft of taper 8 the fourth rings at ten times the
/// first's frequency, beyond what a sensor of 2 to 4 kHz resolves.
pub(crate) const MODES: usize = 4;

pub(crate) const STATIC: usize = 4;

pub(crate) const SHAPES: usize = MODES + STATIC;

/// Amplitudes of all shapes, in x and y.
pub(crate) type Amplitudes = [[f64; 2]; SHAPES];

/// Ways of a place for each shape: along x for a unit more along x, along x for y and the reverse,
/// along y for y, along z for x and for y.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ways([[f64; SHAPES]; 5]);

impl Ways {
    /// The ways of a shape for its two axes.
    #[inline]
    pub(crate) fn of(&self, k: usize) -> [V3; 2] {
        let [xx, xy, yy, xz, yz] = [0, 1, 2, 3, 4].map(|row| self.0[row][k]);
        [[xx, xy, xz], [xy, yy, yz]]
    }

    /// How far each goes in a direction.
    #[inline]
    pub(crate) fn towards(&self, direction: V3) -> Amplitudes {
        core::array::from_fn(|k| {
            let [x, y] = self.of(k);
            [dot(x, direction), dot(y, direction)]
        })
    }
}

/// Largest square of ψ at which directions are computed, rad²: at four radians the shaft
/// points back and on.
const LARGEST: f64 = 16.0;

/// Slopes and tip of each shape; zero for one that a shaft does not have.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Shapes {
    /// φ′ at the nodes, node by node.
    slope: [[f64; SHAPES]; NODES],
    /// φ′ at the base.
    pub(crate) base: [f64; SHAPES],
    /// φ at the tip.
    pub(crate) tip: [f64; SHAPES],
}

/// How far a bent shaft is turned at its nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Angles {
    psi: [[f64; NODES]; 2],
    /// |ψ|², limited.
    square: [f64; NODES],
    /// sin|ψ|/|ψ|.
    sinc: [f64; NODES],
    /// (cos|ψ| − sin|ψ|/|ψ|)/|ψ|².
    bend: [f64; NODES],
}

/// Directions of a bent shaft at its nodes: x, y and z of the tangent.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Curve([[f64; NODES]; 3]);

impl Shapes {
    pub(crate) fn clear(&mut self, k: usize) {
        self.set(k, [0.0; NODES], 0.0, 0.0);
    }

    pub(crate) fn set(&mut self, k: usize, slope: [f64; NODES], base: f64, tip: f64) {
        for (slopes, slope) in self.slope.iter_mut().zip(slope) {
            slopes[k] = slope;
        }
        self.base[k] = base;
        self.tip[k] = tip;
    }

    /// The bent shaft with these amplitudes. A round takes it twice: code that is there once stays
    /// in the processor's cache.
    #[inline(never)]
    pub(crate) fn angles(&self, amplitudes: &Amplitudes) -> Angles {
        Angles::new(|n| weighted(&self.slope[n], amplitudes))
    }

    #[inline]
    pub(crate) fn curve(&self, amplitudes: &Amplitudes) -> Curve {
        self.angles(amplitudes).curve()
    }

    /// Rotation of the base, rad.
    #[inline]
    pub(crate) fn base(&self, amplitudes: &Amplitudes) -> [f64; 2] {
        weighted(&self.base, amplitudes)
    }

    /// ψ at the tip.
    #[inline]
    pub(crate) fn turned(&self, amplitudes: &Amplitudes) -> [f64; 2] {
        let tip = &self.slope[NODES - 1];
        weighted(&core::array::from_fn(|k| tip[k]), amplitudes)
    }

    /// Ways of a place of the shaft that is bent so.
    #[inline]
    pub(crate) fn ways(&self, angles: &Angles, place: &Place) -> Ways {
        self.sums(angles, 0, &place.weights[..place.nodes()])
    }

    /// How the tangent at a place turns for a unit more of each shape.
    #[inline]
    pub(crate) fn turns(&self, angles: &Angles, place: &Place) -> Ways {
        self.sums(angles, place.first, &place.along)
    }

    /// How a weighted sum of the tangents from a node on turns for a unit more of each shape.
    #[inline]
    fn sums(&self, angles: &Angles, first: usize, weights: &[f64]) -> Ways {
        let mut turns = [[0.0; NODES]; 5];
        for (n, weight) in weights.iter().enumerate() {
            for (turns, turn) in turns.iter_mut().zip(angles.turn(first + n, *weight)) {
                turns[n] = turn;
            }
        }
        let slopes = &self.slope[first..];
        let sums = [0, 1, 2, 3, 4].map(|row| {
            let mut sums = [0.0; SHAPES];
            for (turn, slopes) in turns[row][..weights.len()].iter().zip(slopes) {
                for (sum, slope) in sums.iter_mut().zip(slopes) {
                    *sum += turn * slope;
                }
            }
            sums
        });
        Ways(sums)
    }
}

/// Σ wₖ qₖ in both axes.
#[inline]
fn weighted(weights: &[f64; SHAPES], values: &Amplitudes) -> [f64; 2] {
    [0, 1].map(|axis| {
        let terms = weights.iter().zip(values).map(|(w, value)| w * value[axis]);
        terms.sum()
    })
}

impl Angles {
    /// Of a shaft that is turned so at each node.
    #[inline]
    fn new(turned: impl Fn(usize) -> [f64; 2]) -> Self {
        let mut psi = [[0.0; NODES]; 2];
        let mut square = [0.0; NODES];
        for (n, square) in square.iter_mut().enumerate() {
            let [x, y] = turned(n);
            (psi[0][n], psi[1][n]) = (x, y);
            *square = (x * x + y * y).min(LARGEST);
        }
        Self {
            psi,
            square,
            sinc: polynomial(&SINC, &square),
            bend: polynomial(&BEND, &square),
        }
    }

    #[inline]
    pub(crate) fn curve(&self) -> Curve {
        let along = |axis: usize| core::array::from_fn(|n| self.tangent(n)[axis]);
        Curve([along(0), along(1), along(2)])
    }

    #[inline]
    fn tangent(&self, n: usize) -> V3 {
        let sinc = self.sinc[n];
        [
            sinc * self.psi[0][n],
            sinc * self.psi[1][n],
            sinc + self.square[n] * self.bend[n],
        ]
    }

    /// The tangent at a place, in the axes of the base.
    #[inline]
    pub(crate) fn along(&self, place: &Place) -> V3 {
        let nodes = (place.first..).zip(place.along);
        nodes.fold([0.0; 3], |sum, (n, along)| add(sum, along, self.tangent(n)))
    }

    /// Change of a weighted tangent for a change of ψ at a node: along x for x, along x for y
    /// and the reverse, along y for y, along z for x and for y.
    #[inline]
    fn turn(&self, n: usize, weight: f64) -> [f64; 5] {
        let (x, y) = (self.psi[0][n], self.psi[1][n]);
        let own = weight * self.sinc[n];
        let more = weight * self.bend[n];
        [
            own + more * x * x,
            more * x * y,
            own + more * y * y,
            -own * x,
            -own * y,
        ]
    }
}

impl Curve {
    /// Where a place is, from the base, in its axes, m.
    #[inline]
    pub(crate) fn at(&self, place: &Place) -> V3 {
        let [x, y, z] = &self.0;
        let mut at = [0.0; 3];
        for (n, weight) in place.weights[..place.nodes()].iter().enumerate() {
            at = add(at, *weight, [x[n], y[n], z[n]]);
        }
        at
    }

    /// How steeply the shaft rises at its nodes, for heights along `up`, in the axes of the base.
    #[inline]
    fn rises(&self, up: V3) -> [f64; NODES] {
        let [x, y, z] = &self.0;
        core::array::from_fn(|n| up[0] * x[n] + up[1] * y[n] + up[2] * z[n])
    }

    #[inline]
    pub(crate) fn lowest(&self, grid: &Grid, up: V3) -> Place {
        grid.lowest(&self.rises(up))
    }

    /// Whether it falls up to an arc length and rises from there on, for such heights.
    #[inline]
    pub(crate) fn has_one_valley(&self, grid: &Grid, at_m: f64, up: V3) -> bool {
        let nodes = grid.nodes.iter().zip(self.rises(up));
        nodes.fold(true, |has, (node_m, rise)| {
            has & if *node_m < at_m {
                rise <= 0.0
            } else {
                rise >= 0.0
            }
        })
    }

    /// How much lower another place is, for such heights, m.
    #[inline]
    pub(crate) fn deeper_m(&self, place: &Place, other: &Place, up: V3) -> f64 {
        let weights = place.weights.iter().zip(&other.weights);
        let terms = weights
            .zip(self.rises(up))
            .map(|((here, there), rise)| (here - there) * rise);
        terms.sum()
    }

    /// The tangent at a place, in the axes of the base.
    #[inline]
    pub(crate) fn along(&self, place: &Place) -> V3 {
        [0, 1, 2].map(|axis| {
            let nodes = self.0[axis].iter().skip(place.first).zip(&place.along);
            nodes.map(|(part, along)| part * along).sum()
        })
    }

    /// How steeply the shaft rises at a place for heights along `up`, and how that changes
    /// along it, 1/m.
    #[inline]
    pub(crate) fn rise(&self, place: &Place, up: V3) -> [f64; 2] {
        let [x, y, z] = &self.0;
        let mut rise = [0.0; 2];
        for (n, (along, bend)) in (place.first..).zip(place.along.iter().zip(&place.bend)) {
            let part = up[0] * x[n] + up[1] * y[n] + up[2] * z[n];
            rise[0] += along * part;
            rise[1] += bend * part;
        }
        rise
    }
}

/// Values at all nodes of a polynomial in x/8 − 1, coefficients from the highest.
#[inline]
fn polynomial(coefficients: &[f64; TERMS], at: &[f64; NODES]) -> [f64; NODES] {
    let at = at.map(|x| 0.125 * x - 1.0);
    let mut value = [0.0; NODES];
    for coefficient in coefficients {
        for (value, at) in value.iter_mut().zip(&at) {
            *value = *value * at + coefficient;
        }
    }
    value
}

const TERMS: usize = 11;

/// sin √x/√x for x of 0 to 16, within 3e-16 (Chebyshev's series).
const SINC: [f64; TERMS] = [
    1.765_118_007_613_064e-11,
    -9.113_057_307_044_909e-10,
    3.813_125_511_870_439e-8,
    -1.263_683_339_781_756_9e-6,
    3.210_403_259_912_857e-5,
    -5.994_912_694_158_787e-4,
    7.761_444_460_898_595e-3,
    -6.385_808_745_728_657e-2,
    2.886_862_923_856_729e-1,
    -5.301_414_685_921_428e-1,
    1.089_198_090_584_320_6e-1,
];

/// (cos √x − sin √x/√x)/x, likewise.
const BEND: [f64; TERMS] = [
    -7.783_273_555_172_839e-13,
    4.413_081_444_116_443_5e-11,
    -2.048_686_657_535_190_6e-9,
    7.626_250_450_890_71e-8,
    -2.211_447_206_690_946_6e-6,
    4.815_604_890_245_219e-5,
    -7.493_640_863_442_006e-4,
    7.761_444_460_897_699_6e-3,
    -4.789_356_559_301_053_6e-2,
    1.443_431_461_928_365e-1,
    -1.325_353_671_480_349_4e-1,
];

#[cfg(test)]
mod tests {
    use super::Angles;
    use crate::grid::Grid;

    /// A shaft that is turned by the same angle everywhere, in a direction.
    fn turned(x: f64, y: f64) -> Angles {
        Angles::new(|_| [x, y])
    }

    #[test]
    fn a_turned_shaft_points_where_it_is_turned() {
        let grid = Grid::new(2.0);
        for angle in [0.0, 1e-9, 0.3, 1.5, 3.0, 3.99_f64] {
            let [x, y, z] = turned(0.6 * angle, -0.8 * angle).curve().at(grid.tip());
            let (sine, cosine) = angle.sin_cos();
            assert!((x - 1.2 * sine).abs() < 4e-15, "{angle} {x}");
            assert!((y + 1.6 * sine).abs() < 4e-15, "{angle} {y}");
            assert!((z - 2.0 * cosine).abs() < 4e-15, "{angle} {z}");
        }
        // Beyond the range: finite.
        assert!(turned(1e200, 1e9).curve().at(grid.tip())[2].is_finite());
    }

    #[test]
    fn turns_are_the_derivatives_of_the_tangent() {
        let grid = Grid::new(1.0);
        let at = |x: f64, y: f64| turned(x, y).curve().at(grid.tip());
        let (x, y, step) = (0.9, -0.4, 1e-6);
        let angles = turned(x, y);
        let sum = |i: usize| -> f64 {
            let turns = grid.tip().weights.iter().enumerate();
            turns.map(|(n, weight)| angles.turn(n, *weight)[i]).sum()
        };
        let slope = |i: usize, dx: f64, dy: f64| {
            (at(x + dx, y + dy)[i] - at(x - dx, y - dy)[i]) / (2.0 * step)
        };
        let truth = [
            slope(0, step, 0.0),
            slope(0, 0.0, step),
            slope(1, 0.0, step),
            slope(2, step, 0.0),
            slope(2, 0.0, step),
        ];
        for (i, truth) in truth.into_iter().enumerate() {
            assert!((sum(i) - truth).abs() < 1e-9, "{i}: {} {truth}", sum(i));
        }
    }
}
