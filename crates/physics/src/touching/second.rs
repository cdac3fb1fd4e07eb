//! Another place of the shaft that touches at once, apart from the first: a tip that whips through
//! while the shaft lies on the plate, a shaft along the plate.
//!
//! Each is a contact of its own, with its foot, friction and spring. They share the shapes: the
//! force on one moves the other. So each is found in turn for shapes that the other's force has
//! pushed, until the first force changes no more (Gauss–Seidel; it converges as the shapes give
//! way less to a force elsewhere than where it acts). The work of each force is that of the whole
//! change of the shapes, and the energy of each spring is at most what it was less that work: so
//! the energy never grows, however far the iteration went. Where that leaves a spring less than
//! nothing, the first touches alone.

use super::body::{Body, Touch};
use super::law::Part;
use super::rounds::Found;
use crate::grid::Place;
use crate::modal::pushed;
use crate::pose::PlatePose;
use crate::shapes::{Amplitudes, Curve};
use crate::vector::{dot, sub};

/// Another place touches where it is deeper in the ground than this share of the length: as
/// deep as shapes bring a shaft that lies straight along the plate.
pub(super) const DEEP: f64 = 5e-3;

/// Places this share of the length apart can both touch, and are one below half of it.
const APART: f64 = 0.1;

/// Most exchanges of forces, and by what share of itself the first changes in the last one.
const EXCHANGES: usize = 12;
const SETTLED: f64 = 1e-6;

impl Body {
    /// Places that have come together are one.
    pub(super) fn join(&mut self) {
        let at = |touch: &Touch| touch.place.map(|place| place.at_m);
        if let (Some(first), Some(second)) = (at(&self.touch), at(&self.other))
            && self.is_one(first, second)
        {
            self.other = Touch::default();
        }
    }

    /// What is done with the other contact as if it were the first.
    fn as_other<T>(&mut self, done: impl FnOnce(&mut Self) -> T) -> T {
        core::mem::swap(&mut self.touch, &mut self.other);
        let result = done(self);
        core::mem::swap(&mut self.touch, &mut self.other);
        result
    }

    fn is_one(&self, first_m: f64, second_m: f64) -> bool {
        (first_m - second_m).abs() < 0.5 * APART * self.shaft.length_m
    }

    /// What a part comes to in which the first contact was found alone and another place touches:
    /// the first then, and the forces of the other on the shapes. The other is settled.
    #[cold]
    pub(super) fn both(
        &mut self,
        [old, new]: [&PlatePose; 2],
        part: &mut Part<'_>,
        alone: &Found,
    ) -> Option<(Found, Amplitudes)> {
        let mut place = self.second_place(part.before, new, alone)?;
        let tangent = (!self.outline.is_plane())
            .then(|| self.outline.tangent(old.place(part.before.at(&place))));
        let seen = tangent.map(|tangent| [tangent.see(old), tangent.see(new)]);
        let [old, new] = seen.as_ref().map_or([old, new], |[old, new]| [old, new]);
        let mut own = Part {
            old,
            pose: new,
            touching: self.other.is_contact(),
            friction: self.ground.surface.friction_at(self.other.slip_m_s),
            stretch: new.vector(self.other.stretch),
            tangent,
            ..part.clone()
        };
        let free = part.free;
        let mut first = alone.clone();
        for n in 1..=EXCHANGES {
            own.free = pushed(&free, &part.responses, &first.forces);
            let mut second = self.as_other(|body| body.find(&mut own, place, first.end, None));
            place = second.place;
            if self.is_one(first.place.at_m, place.at_m) {
                break;
            }
            part.free = pushed(&free, &part.responses, &second.forces);
            let again = self.find(part, first.place, second.end, None);
            let change = sub(again.force, first.force);
            let size = dot(again.force, again.force);
            first = again;
            if n < EXCHANGES && dot(change, change) > SETTLED * SETTLED * size {
                continue;
            }
            // The last word was the first's.
            let end = first.end;
            second.next = sub(new.place(self.curve?.at(&place)), second.solved.stretch);
            let left_j = [(&self.touch, &*part, &first), (&self.other, &own, &second)]
                .map(|(touch, part, found)| left_j(touch, part, found, &end));
            let [first_j, second_j] = left_j;
            if first_j < 0.0 || second_j < 0.0 {
                break;
            }
            first.solved.left_j = first_j;
            second.solved.left_j = second_j;
            self.as_other(|body| body.settle(&own, &second));
            return Some((first, second.forces));
        }
        part.free = free;
        // That of the first alone.
        self.curve = None;
        None
    }

    /// Whether it is soon seen that no other place touches at the end of a part in which the first is
    /// alone.
    #[inline]
    pub(super) fn is_alone(&self, new: &PlatePose, first: &Found) -> bool {
        let (grid, at_m) = (&self.shaft.grid, first.place.at_m);
        let has_one = |curve: &Curve| curve.has_one_valley(grid, at_m, new.up());
        let is_plane = self.outline.is_plane();
        !self.other.is_contact() && is_plane && self.curve.as_ref().is_none_or(has_one)
    }

    /// Where another place touches at the end of a part in which the first is alone.
    fn second_place(&mut self, before: &Curve, new: &PlatePose, alone: &Found) -> Option<Place> {
        if self.other.is_contact() {
            return Some(self.as_other(|body| body.expected(before, new)));
        }
        let length_m = self.shaft.length_m;
        let curve = self.curve?;
        let (place, tangent) = self.nearest(&curve, new);
        if (place.at_m - alone.place.at_m).abs() < APART * length_m {
            return None;
        }
        let most_m = DEEP * length_m;
        let most_m = tangent.map_or(most_m, |tangent| tangent.deeper_m(most_m));
        let seen = tangent.map(|tangent| tangent.see(new));
        let deep_m = self.deep(&curve, &place, seen.as_ref().unwrap_or(new));
        (deep_m > most_m).then_some(place)
    }
}

/// Energy of a contact's spring at the start less the work of its force on the shapes and on the
/// base, J.
fn left_j(touch: &Touch, part: &Part<'_>, found: &Found, end: &Amplitudes) -> f64 {
    let solved = &found.solved;
    let of_base = dot(solved.frame.plate(solved.force.local), part.carried);
    let forces = found.forces.iter().flatten();
    let moved = end.iter().flatten().zip(part.start.iter().flatten());
    let of_shapes: f64 = forces
        .zip(moved)
        .map(|(f, (end, start))| f * (end - start))
        .sum();
    touch.spring_j - of_base - of_shapes
}

pub(super) fn sum(one: &Amplitudes, two: &Amplitudes) -> Amplitudes {
    core::array::from_fn(|k| [0, 1].map(|axis| one[k][axis] + two[k][axis]))
}
