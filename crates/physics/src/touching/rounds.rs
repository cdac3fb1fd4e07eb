//! The force at a place of the shaft and where it brings the foot, at the end of a part; *place*,
//! *stretch* and *foot* as in [`super::part`].
//!
//! A foot that slides moves along a plane through the ground at both ends of its
//! path, so that the plane rises as far as the ground does. The far end is
//! found by iteration: the force on a plane ([`super::law`]), where it brings the
//! foot, the plane to there. Steep ground throws the foot about from round to
//! round; it is then moved by only a share of that (Aitken's method for vectors:
//! Irons and Tuck 1969).
//!
//! Beyond the place where an elastica is pressed on a plane it lies straight along it: its
//! lowest place is not defined, and where it runs along the plane depends on where it is
//! pressed. Both are found together by Newton's method, in the rounds of the same iteration.
//!
//! Ways are those in the middle of the part: times a change of the amplitudes they are
//! the place's displacement but for the third order of the change. A round that changes the
//! middle by too much is repeated.

use super::body::Body;
use super::law::{Moves, Part, Solved};
use crate::contact::Frame;
use crate::grid::Place;
use crate::modal::pushed;
use crate::outline::Tangent;
use crate::shapes::{Amplitudes, Angles, Curve};
use crate::vector::{V3, add, dot, length, length2, sub};

/// Most rounds of the iteration for the end of a part; mostly one or two.
const ROUNDS: usize = 8;

/// The iteration ends once the foot moves by less than this share of the distance
/// of the finest octave, and is off where ways bring it by less than this share of
/// what the force displaces it by.
const NEAR: f64 = 0.1;
const OFF: f64 = 1e-4;

/// The same for a place that moves along the shaft, as a share of the length.
const SHIFT: f64 = 1e-4;

/// As far as a place moves towards the base in a round at most, as a share of the length.
const MOST: f64 = 0.1;

/// Smallest share of a round.
const LEAST: f64 = 0.05;

/// Distances below this have no direction, m: heights are rounded.
const NO_WAY_M: f64 = 1e-12;

/// A place of the ground, with its height and slopes.
pub(super) type Known = (V3, [f64; 3]);

struct Round {
    found: Found,
    /// Where the foot was expected, and how far that is from where it is on ground that it feels.
    there: V3,
    miss: [f64; 2],
    /// How far the place is off where its ways bring it, m.
    off_m: f64,
    curve: Curve,
}

/// Where a contact has been found, and how it ends: what the last round has found of it.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) place: Place,
    /// Which place of the ground the foot feels at the end.
    pub(super) felt: [f64; 2],
    /// Where on the shaft it would rather be, m from the base.
    pub(super) better_m: f64,
    /// Where the foot is.
    pub(super) next: V3,
    pub(super) solved: Solved,
    /// The force along x, y and z, and on each shape.
    pub(super) force: V3,
    pub(super) forces: Amplitudes,
    pub(super) end: Amplitudes,
}

impl Body {
    /// The force at a place and where it brings the foot, by rounds from where the shapes end
    /// about. Keeps how the shaft is then bent.
    pub(super) fn find(
        &mut self,
        part: &mut Part<'_>,
        mut place: Place,
        mut end: Amplitudes,
        mut ground: Option<Known>,
    ) -> Found {
        let length_m = self.shaft.length_m;
        let near = NEAR * self.finest_m();
        let (mut missed, mut relax, mut to) = (None, 1.0, None);
        let mut n = 0;
        loop {
            n += 1;
            let round = self.round(part, &place, &end, to, ground.take());
            end = round.found.end;
            let miss = round.miss;
            if let Some(old) = missed.replace(miss) {
                relax = relaxed(relax, old, miss);
            }
            let small = OFF * part.response * length(round.found.force);
            let better_m = round.found.better_m;
            let still = n > 2 || (better_m.min(length_m) - place.at_m).abs() <= SHIFT * length_m;
            if n == ROUNDS || (round.off_m <= small && length2(miss) < near && still) {
                self.curve = Some(round.curve);
                return round.found;
            }
            if still {
                to = Some([0, 1].map(|i| round.there[i] + relax * miss[i]));
            } else {
                place = self.shaft.grid.place(better_m);
                (missed, to) = (None, None);
            }
        }
    }

    /// One round: the force at a place, on a plane to where the foot is expected, for shapes
    /// that end about as they do in `end`.
    fn round(
        &mut self,
        part: &mut Part<'_>,
        place: &Place,
        end: &Amplitudes,
        to: Option<[f64; 2]>,
        known: Option<Known>,
    ) -> Round {
        let shapes = &self.shaft.shapes;
        let new = part.pose;
        let at = part.before.at(place);
        let foot = self.foot(part, at);
        let felt = self.touch.felt.unwrap_or([foot[0], foot[1]]);
        let middle = shapes.angles(&between(&part.start, end));
        let lengthwise = part.touching && place.at_m < self.shaft.length_m;
        let along = lengthwise.then(|| level(new.vector(middle.along(place))));
        let relief = &mut self.ground.relief;
        let tangent = part.tangent;
        let mut ground_at = |at: V3| {
            let [x, y] = aside(along, [at[0] - foot[0], at[1] - foot[1]]);
            bowed(tangent.as_ref(), relief.at([felt[0] + x, felt[1] + y]), at)
        };
        let kept = self
            .touch
            .ground
            .map(|ground| bowed(tangent.as_ref(), ground, foot));
        let ground = kept.unwrap_or_else(|| ground_at(foot));
        part.foot = foot;
        part.ground = ground;
        part.carried = sub(sub(new.place(at), part.stretch), foot);
        let moves = Moves::new(&shapes.ways(&middle, place), part);
        let (there, ground) = known.unwrap_or_else(|| {
            let there = match to {
                Some([x, y]) => [x, y, 0.0],
                None if self.touch.stuck => foot,
                None => {
                    let moved = new.vector(moves.between(&part.start, end));
                    add(add(foot, 1.0, part.carried), 1.0, moved)
                }
            };
            (there, ground_at(there))
        });
        let way = aside(along, [there[0] - foot[0], there[1] - foot[1]]);
        let slopes = aside(along, secant(part.ground, way, ground));
        let solved = self.solve(part, Frame::new(slopes), &moves);
        let force = new.components(solved.frame.plate(solved.force.local));
        let forces = moves.forces(force);
        let end = pushed(&part.free, &part.responses, &forces);
        let straight = add(at, 1.0, moves.under(force));
        let angles = shapes.angles(&end);
        let curve = angles.curve();
        let bent = curve.at(place);
        let next = sub(new.place(bent), solved.stretch);
        let went = [0, 1].map(|i| next[i] - foot[i]);
        let slid = aside(along, went);
        Round {
            miss: aside(along, [0, 1].map(|i| next[i] - there[i])),
            there,
            off_m: length(sub(bent, straight)),
            found: Found {
                place: *place,
                felt: [0, 1].map(|i| felt[i] + slid[i]),
                better_m: self.better_m(part, place, force, &moves, &angles, &curve),
                next,
                solved,
                force,
                forces,
                end,
            },
            curve,
        }
    }

    /// Where the shaft would run along the plane if it were pressed there, m from the base, by
    /// Newton's method; beyond the length where the tip points at the plane.
    fn better_m(
        &self,
        part: &Part<'_>,
        place: &Place,
        force: V3,
        moves: &Moves,
        angles: &Angles,
        curve: &Curve,
    ) -> f64 {
        let up = part.pose.up();
        let [mut rise, mut bend] = curve.rise(place, up);
        let along = part.tangent.as_ref().map(|tangent| {
            // Along the surface, which falls away from the plane.
            let at_m = part.pose.place(curve.at(place))[0];
            let along = part.pose.vector(curve.along(place))[0];
            let [slope, change] = tangent.falls(at_m);
            rise -= slope * along;
            bend -= change * along * along;
            (tangent, at_m, along)
        });
        if place.at_m == self.shaft.length_m && rise <= 0.0 {
            return place.at_m;
        }
        let turns = self.shaft.shapes.turns(angles, place);
        let steep = bend + dot(force, up) * moves.turned(&turns, up, &part.responses);
        let mut shift = if steep > 0.0 { -rise / steep } else { 0.0 };
        if let Some((tangent, at_m, along)) = along.filter(|(.., along)| *along != 0.0) {
            shift = (tangent.on(at_m + shift * along) - at_m) / along;
        }
        place.at_m + shift.max(-MOST * self.shaft.length_m)
    }
}

/// The ground at a place, where the body is round too.
#[inline]
pub(super) fn bowed(tangent: Option<&Tangent>, ground: [f64; 3], at: V3) -> [f64; 3] {
    match tangent {
        Some(tangent) => tangent.bowed(ground, at[0]),
        None => ground,
    }
}

/// Slopes of a plane through the ground (height, slopes) at both ends of a way: the mean
/// of the slopes there, corrected along it (the mean-value discrete gradient
/// of Gonzalez 1996), so that slopes · distance is the difference of the heights.
#[inline]
fn secant(start: [f64; 3], way: [f64; 2], end: [f64; 3]) -> [f64; 2] {
    let mean = [0.5 * start[1] + 0.5 * end[1], 0.5 * start[2] + 0.5 * end[2]];
    let square = way[0] * way[0] + way[1] * way[1];
    if square < NO_WAY_M * NO_WAY_M {
        return mean;
    }
    let missed = (end[0] - start[0] - mean[0] * way[0] - mean[1] * way[1]) / square;
    [mean[0] + missed * way[0], mean[1] + missed * way[1]]
}

/// The direction of a vector along the plate; none of a vector across it.
#[inline]
fn level(v: V3) -> [f64; 2] {
    let size = length2([v[0], v[1]]);
    let keep = if size > 1e-9 { 1.0 / size } else { 0.0 };
    [keep * v[0], keep * v[1]]
}

/// The part of a way on the plate that is not lengthwise, where there is a lengthwise.
#[inline]
fn aside(along: Option<[f64; 2]>, way: [f64; 2]) -> [f64; 2] {
    let Some(along) = along else {
        return way;
    };
    let far = along[0] * way[0] + along[1] * way[1];
    [0, 1].map(|i| way[i] - far * along[i])
}

#[inline]
fn between(start: &Amplitudes, end: &Amplitudes) -> Amplitudes {
    core::array::from_fn(|k| [0, 1].map(|axis| 0.5 * start[k][axis] + 0.5 * end[k][axis]))
}

/// The share of the next round, from the misses of two rounds with `share`
/// between them.
fn relaxed(share: f64, old: [f64; 2], new: [f64; 2]) -> f64 {
    let change = [new[0] - old[0], new[1] - old[1]];
    let square = change[0] * change[0] + change[1] * change[1];
    if square > 0.0 {
        let along = old[0] * change[0] + old[1] * change[1];
        (-share * along / square).clamp(LEAST, 1.0)
    } else {
        share
    }
}
