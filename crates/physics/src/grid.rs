//! Where along a shaft its direction is known, and how that becomes places.
//!
//! Glossary:
//!
//! - *node*: one of the arc lengths at which the tangent is computed: three Gauss
//!   points in each of six segments, which grow shorter towards the tip, where a
//!   tapered shaft bends most; and the tip;
//! - *place*: an arc length, with the weight of each node's tangent in the integral
//!   of the tangent from the base to there.
//!
//! Within a segment the tangent is taken as the parabola through its three nodes. Whole
//! segments are integrated with the error of Gauss' quadrature (degree 5). On shafts of
//! taper 3 to 15 pushed by 2 to 45° the base moment differs from that of ten segments by 0.2 %
//! root mean square, 1.1 % at most.

const SEGMENTS: usize = 6;

/// Nodes of a segment.
pub(crate) const POINTS: usize = 3;

/// Nodes of a shaft; the last is the tip, which no integral counts.
pub(crate) const NODES: usize = SEGMENTS * POINTS + 1;

/// √(3/5)/2: how far the outer Gauss points are from the middle of a segment.
const OFF: f64 = 0.387_298_334_620_741_7;

/// The least arc length of a contact, as a share of the length: nearer to the base
/// nothing gives way.
const LEAST: f64 = 0.1;

#[derive(Debug, Clone)]
pub(crate) struct Grid {
    length_m: f64,
    edges: [f64; SEGMENTS + 1],
    pub(crate) nodes: [f64; NODES],
    tip: Place,
}

/// An arc length, and how places there come from tangents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub(crate) at_m: f64,
    /// Of each node in the integral of the tangent, m.
    pub(crate) weights: [f64; NODES],
    /// First node of its segment, and the weights of the segment's nodes in the tangent
    /// and in its change along the shaft, 1/m.
    pub(crate) first: usize,
    pub(crate) along: [f64; POINTS],
    pub(crate) bend: [f64; POINTS],
}

impl Place {
    /// How many nodes count: no later one does in its integral.
    #[inline]
    pub(crate) fn nodes(&self) -> usize {
        self.first + POINTS
    }
}

impl Grid {
    pub(crate) fn new(length_m: f64) -> Self {
        let edge = |n: usize| {
            let left = 1.0 - n as f64 / SEGMENTS as f64;
            length_m * (1.0 - left * left)
        };
        let edges = core::array::from_fn(edge);
        let (mut nodes, mut weights) = ([length_m; NODES], [0.0; NODES]);
        for (segment, pair) in edges.windows(2).enumerate() {
            let long = pair[1] - pair[0];
            for (n, [area, ..]) in parabolas(1.0).into_iter().enumerate() {
                nodes[segment * POINTS + n] = pair[0] + (0.5 + [-OFF, 0.0, OFF][n]) * long;
                weights[segment * POINTS + n] = long * area;
            }
        }
        let mut grid = Self {
            length_m,
            edges,
            nodes,
            tip: Place {
                at_m: length_m,
                weights,
                first: 0,
                along: [0.0; POINTS],
                bend: [0.0; POINTS],
            },
        };
        grid.tip = grid.place(length_m);
        grid
    }

    #[inline]
    pub(crate) fn tip(&self) -> &Place {
        &self.tip
    }

    /// The place at an arc length, at least a tenth of the length.
    pub(crate) fn place(&self, at_m: f64) -> Place {
        self.anywhere(at_m.max(LEAST * self.length_m))
    }

    /// The place at an arc length of the shaft.
    pub(crate) fn anywhere(&self, at_m: f64) -> Place {
        let at_m = at_m.max(0.0).min(self.length_m);
        let edges = &self.edges[1..SEGMENTS];
        let segment = edges.iter().filter(|edge| **edge < at_m).count();
        let first = segment * POINTS;
        let long = self.edges[segment + 1] - self.edges[segment];
        let parabolas = parabolas((at_m - self.edges[segment]) / long);
        // Segments before count whole.
        let mut weights = [0.0; NODES];
        weights[..first].copy_from_slice(&self.tip.weights[..first]);
        for (weight, [area, ..]) in weights.iter_mut().skip(first).zip(parabolas) {
            *weight = long * area;
        }
        Place {
            at_m,
            weights,
            first,
            along: parabolas.map(|[_, height, _]| height),
            bend: parabolas.map(|[_, _, slope]| slope / long),
        }
    }

    /// The place where a shaft stands lowest, by the rates at which it rises along
    /// itself at its nodes: where it turns from falling to rising.
    pub(crate) fn lowest(&self, rise: &[f64; NODES]) -> Place {
        let mut low = (0.0, 0.0);
        let mut height = 0.0;
        // Trapezoids tell valleys apart; where there is one it is found by its root.
        for n in 1..NODES {
            let (a, b) = (rise[n - 1], rise[n]);
            let way = self.nodes[n] - self.nodes[n - 1];
            if a < 0.0 && b >= 0.0 {
                let share = a / (a - b);
                let valley = height + 0.5 * share * way * a;
                if valley < low.1 {
                    low = (self.nodes[n - 1] + share * way, valley);
                }
            }
            height += 0.5 * way * (a + b);
        }
        if rise[NODES - 1] < 0.0 && height < low.1 {
            return self.tip;
        }
        if low.0 > 0.0 {
            self.place(low.0)
        } else if height < 0.0 {
            self.tip
        } else {
            self.place(0.0)
        }
    }
}

/// The parabolas that are 1 at one of the three Gauss points of 0..1 and 0 at the others:
/// of each the integral from 0 to s, the value and the slope there.
#[inline]
fn parabolas(s: f64) -> [[f64; 3]; POINTS] {
    let (s2, s3) = (s * s / 2.0, s * s * s / 3.0);
    let (low, mid, high) = (0.5 - OFF, 0.5, 0.5 + OFF);
    let outer = 1.0 / (2.0 * OFF * OFF);
    let of = |scale: f64, a: f64, b: f64| {
        [
            scale * (s3 - (a + b) * s2 + a * b * s),
            scale * (s - a) * (s - b),
            scale * (2.0 * s - a - b),
        ]
    };
    [
        of(outer, mid, high),
        of(-2.0 * outer, low, high),
        of(outer, low, mid),
    ]
}

#[cfg(test)]
mod tests {
    use super::{Grid, NODES, OFF};

    #[test]
    fn places_integrate_a_polynomial_of_degree_five_to_the_tip_and_a_parabola_anywhere() {
        let grid = Grid::new(0.7);
        let sum = |at: f64, f: fn(f64) -> f64| -> f64 {
            let place = grid.place(at);
            let terms = grid.nodes.iter().zip(place.weights);
            terms.map(|(s, weight)| weight * f(*s)).sum()
        };
        assert!((sum(0.7, |s| s.powi(5)) - 0.7_f64.powi(6) / 6.0).abs() < 1e-16);
        for at in [0.07, 0.2, 0.33, 0.5, 0.69, 0.7] {
            let error = sum(at, |s| s * s) - at.powi(3) / 3.0;
            assert!(error.abs() < 1e-16, "{at}");
        }
        assert!((OFF - 0.15_f64.sqrt()).abs() < 1e-16);
    }

    #[test]
    fn the_lowest_place_is_where_a_valley_is_deepest() {
        let grid = Grid::new(1.0);
        let rise = |f: fn(f64) -> f64| -> [f64; NODES] { grid.nodes.map(f) };
        assert_eq!(grid.lowest(&rise(|_| -1.0)).at_m, 1.0);
        assert_eq!(grid.lowest(&rise(|_| 1.0)).at_m, 0.1);
        assert!((grid.lowest(&rise(|s| s - 0.83)).at_m - 0.83).abs() < 1e-12);
        // A hill after the valley, from which the tip hangs lower, and not as low.
        let low = |s: f64| {
            if s < 0.6 {
                s - 0.5
            } else {
                0.05 - 10.0 * (s - 0.6)
            }
        };
        assert_eq!(grid.lowest(&rise(low)).at_m, 1.0);
        let not_as_low = |s: f64| {
            if s < 0.6 {
                s - 0.5
            } else {
                0.1 - 0.3 * (s - 0.6)
            }
        };
        assert!((grid.lowest(&rise(not_as_low)).at_m - 0.5).abs() < 1e-12);
    }
}
