//! The maze of Psikharpax: walls around the robot, seen from above.
//!
//! Frame: x along the maze, y to the left of that, the middle of the maze at the origin. A wall
//! goes from one point to another, with free space to its left.

use super::{Corridor, keys};

/// A place seen from above, m.
pub(super) type Place = [f64; 2];

/// Straight walls that a quarter of a circle is made of.
const ARC: usize = 8;

keys! {
    Maze, rig:
    length_m: f64 => 0.5..=100.0,
    width_m: f64 => 0.5..=100.0,
    corner_m: f64 => 0.0..=rig.width_m.min(rig.length_m) / 2.0,
    mouth_m: f64 => 0.0..=rig.width_m / 2.0,
    start_m: f64 => 0.0..=rig.length_m / 2.0,
    aperture_mm: f64 => 0.0..=1000.0,
    detect_s: f64 => 0.0..=10.0,
    least_s: f64 => 0.0..=100.0,
    turn_deg: f64 => 0.0..=180.0,
    tour_s: f64 => 1.0..=10_000.0,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Made {
    Plain,
    Relief(usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wall {
    pub(crate) from_m: Place,
    pub(crate) along: Place,
    pub(crate) length_m: f64,
    pub(crate) made: Made,
}

fn product(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Wall {
    fn between(from_m: Place, to_m: Place, made: Made) -> Self {
        let way = [to_m[0] - from_m[0], to_m[1] - from_m[1]];
        let length_m = product(way, way).sqrt();
        Self {
            from_m,
            along: way.map(|part| part / length_m.max(f64::MIN_POSITIVE)),
            length_m,
            made,
        }
    }

    pub(crate) fn normal(&self) -> Place {
        let [x, y] = self.along;
        [-y, x]
    }

    /// Along the wall from where it begins, and above it, m.
    fn coordinates(&self, [x, y]: Place) -> (f64, f64) {
        let off = [x - self.from_m[0], y - self.from_m[1]];
        (product(off, self.along), product(off, self.normal()))
    }

    /// Which share of the straight way between two places lies before the wall, if it goes through.
    pub(crate) fn crossing(&self, from_m: Place, to_m: Place) -> Option<f64> {
        let ((a, above), (b, below)) = (self.coordinates(from_m), self.coordinates(to_m));
        if above <= 0.0 || below >= 0.0 {
            return None;
        }
        let share = above / (above - below);
        let at = a + share * (b - a);
        (0.0..=self.length_m).contains(&at).then_some(share)
    }

    /// The nearest place that is at least so far from the wall.
    pub(crate) fn kept_off(&self, place_m: Place, least_m: f64) -> Place {
        let (at, _) = self.coordinates(place_m);
        let at = at.clamp(0.0, self.length_m);
        let nearest = [0, 1].map(|k| self.from_m[k] + at * self.along[k]);
        let off = [0, 1].map(|k| place_m[k] - nearest[k]);
        let distance = product(off, off).sqrt();
        if distance >= least_m || distance == 0.0 {
            return place_m;
        }
        [0, 1].map(|k| nearest[k] + least_m / distance * off[k])
    }
}

/// Walls one after another, and where the last ends.
struct Line(Vec<Wall>, Place);

impl Line {
    fn to(&mut self, to_m: Place, made: Made) {
        let Self(walls, at_m) = self;
        if to_m != *at_m {
            walls.push(Wall::between(*at_m, to_m, made));
        }
        *at_m = to_m;
    }

    /// A quarter of a circle about a centre, from an angle in quarters of a turn on, `turn`
    /// quarters.
    fn round(&mut self, centre_m: Place, radius_m: f64, from: f64, turn: f64) {
        for part in 1..=ARC {
            let quarters = from + turn * part as f64 / ARC as f64;
            let (sine, cosine) = libm::sincos(core::f64::consts::FRAC_PI_2 * quarters);
            let [x, y] = centre_m;
            self.to([x + radius_m * cosine, y + radius_m * sine], Made::Plain);
        }
    }
}

impl Maze {
    /// All walls: those outside anticlockwise, those of the island clockwise. The corridor at the
    /// top has the reliefs 0 outside and 1 inside, that at the bottom 2 and 3.
    pub(crate) fn walls(&self, corridor: &Corridor) -> Vec<Wall> {
        let (a, b, r) = (self.length_m / 2.0, self.width_m / 2.0, self.corner_m);
        let half = corridor.length_m / 2.0;
        let mut outside = Line(Vec::new(), [r - a, -b]);
        outside.to([-half, -b], Made::Plain);
        outside.to([half, -b], Made::Relief(2));
        outside.to([a - r, -b], Made::Plain);
        outside.round([a - r, r - b], r, -1.0, 1.0);
        outside.to([a, b - r], Made::Plain);
        outside.round([a - r, b - r], r, 0.0, 1.0);
        outside.to([half, b], Made::Plain);
        outside.to([-half, b], Made::Relief(0));
        outside.to([r - a, b], Made::Plain);
        outside.round([r - a, b - r], r, 1.0, 1.0);
        outside.to([-a, r - b], Made::Plain);
        outside.round([r - a, r - b], r, 2.0, 1.0);

        let h = b - corridor.width_m;
        let m = self.mouth_m.min(h);
        let mut island = Line(outside.0, [-half, h]);
        island.to([half, h], Made::Relief(1));
        island.round([half, h - m], m, 1.0, -1.0);
        island.to([half + m, m - h], Made::Plain);
        island.round([half, m - h], m, 0.0, -1.0);
        island.to([-half, -h], Made::Relief(3));
        island.round([-half, m - h], m, -1.0, -1.0);
        island.to([-half - m, h - m], Made::Plain);
        island.round([-half, h - m], m, -2.0, -1.0);
        island.0
    }
}

#[cfg(test)]
mod tests {
    use super::{Made, Maze, Wall};
    use crate::rigs::{Corridor, Rigs};

    fn walls() -> (Maze, Corridor, Vec<Wall>) {
        let Rigs { maze, corridor, .. } = Rigs::with(&[]);
        let walls = maze.walls(&corridor);
        (maze, corridor, walls)
    }

    #[test]
    fn walls_are_closed_and_as_long_as_straights_and_circles() {
        let (maze, corridor, walls) = walls();
        let end = |wall: &Wall| [0, 1].map(|k| wall.from_m[k] + wall.length_m * wall.along[k]);
        // Each wall begins where another ends.
        for wall in &walls {
            let near = |other: &&Wall| {
                let [x, y] = end(other);
                (x - wall.from_m[0]).hypot(y - wall.from_m[1]) < 1e-9
            };
            assert_eq!(walls.iter().filter(near).count(), 1, "{wall:?}");
        }
        let length: f64 = walls.iter().map(|wall| wall.length_m).sum();
        // 2 r sin(π/4n) n to a quarter of a circle.
        let arc = 2.0 * 8.0 * (core::f64::consts::FRAC_PI_4 / 8.0).sin();
        let (r, m) = (maze.corner_m, maze.mouth_m);
        let outside = 2.0 * (maze.length_m + maze.width_m) - 8.0 * r + 4.0 * arc * r;
        let height = maze.width_m - 2.0 * corridor.width_m;
        let island = 2.0 * (corridor.length_m + height - 2.0 * m) + 4.0 * arc * m;
        assert!((length - outside - island).abs() < 1e-9, "{length}");
        for relief in 0..4 {
            let of = walls.iter().filter(|of| of.made == Made::Relief(relief));
            assert_eq!(of.map(|of| of.length_m).collect::<Vec<_>>(), [1.0]);
        }
    }

    #[test]
    fn a_way_through_a_wall_meets_it_where_it_is() {
        let (maze, corridor, walls) = walls();
        let b = maze.width_m / 2.0;
        // From the middle of the top corridor outwards and inwards.
        let middle = [0.1, b - corridor.width_m / 2.0];
        let meets = |to: [f64; 2]| -> Vec<(Made, f64)> {
            let met = |wall: &Wall| Some((wall.made, wall.crossing(middle, to)?));
            walls.iter().filter_map(met).collect()
        };
        let out = meets([0.1, b + 0.175]);
        assert!(out.len() == 1 && out[0].0 == Made::Relief(0) && (out[0].1 - 0.5).abs() < 1e-12);
        let inwards = meets([0.1, b - 0.525]);
        assert!(inwards.len() == 1 && inwards[0].0 == Made::Relief(1));
        assert!(meets([0.4, b - 0.175]).is_empty());
        // Not from behind.
        let behind = |wall: &Wall| wall.crossing([0.0, b + 0.1], [0.0, b - 0.1]);
        assert!(walls.iter().find_map(behind).is_none());
    }

    #[test]
    fn what_comes_too_near_is_kept_off() {
        let (maze, _, walls) = walls();
        let b = maze.width_m / 2.0;
        let kept = |at| walls.iter().fold(at, |at, wall| wall.kept_off(at, 0.125));
        let [x, y] = kept([0.0, b - 0.1]);
        assert!((y - (b - 0.125)).abs() < 1e-12 && x == 0.0, "{x} {y}");
        assert_eq!(kept([1.2, 0.0]), [1.2, 0.0]);
    }
}
