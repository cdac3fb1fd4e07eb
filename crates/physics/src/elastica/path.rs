//! The solutions from push to push, and the rod between contact and base.
//!
//! Lengths are in units of L, forces in E I/L² and moments in E I/L, with E I at the base.

use core::f64::consts::PI;

use super::{Press, PressError, Pressed};
use crate::pose::Pose;
use crate::shaft::Shaft;
use crate::vector::{V3, add, dot, length};

/// Steps of the integration, even in the logarithm of the diameter.
pub(super) const STEPS: u32 = 128;

/// Each so-manieth step has a point of the shape.
const POINT_EVERY: u32 = 2;

/// Largest step between pushes, degrees, and the smallest before one counts as the end.
const STEP_DEG: [f64; 2] = [2.0, 1e-4];

/// The plane in which the rod bends at a push, all with components along z and e.
struct Plane {
    push_rad: f64,
    z: V3,
    e: V3,
    normal: [f64; 2],
    force: [f64; 2],
    /// ψ of a tangent in the plate.
    parallel: f64,
}

/// What a shot from the contact arrives at, in units of L and E I at the base.
struct Shot {
    psi: f64,
    moment: f64,
    contact: f64,
    /// From the base.
    place: [f64; 2],
}

pub(super) struct Path<'p> {
    press: &'p Press,
    normal: V3,
    force: V3,
    /// Diameter at the tip over that at the base.
    tip: f64,
    /// E I/(k L), of the base.
    give: f64,
    /// P for a push of 1 rad of a plate across the shaft, in E I/L².
    unit: f64,
    steps: u32,
    step_deg: f64,
    /// The last two pushes and P in `unit` and w there.
    last: [(f64, [f64; 2]); 2],
    /// Sign of the equations' determinant before any fold.
    sign: f64,
}

impl<'p> Path<'p> {
    pub(super) fn new(press: &'p Press, steps: u32) -> Self {
        let shaft = &press.shaft;
        let (normal, force) = press.directions();
        let tip = shaft.tip_diameter_m / shaft.hub_diameter_m;
        let give = Self::rigidity(shaft) / (shaft.follicle.rotation_n_m_rad * shaft.length_m);
        let mut path = Self {
            press,
            normal,
            force,
            tip,
            give,
            unit: 1.0 / (1.0 / (3.0 * tip) + give),
            steps,
            step_deg: 0.25,
            last: [(0.0, [0.0; 2]); 2],
            sign: 0.0,
        };
        let straight = (0.0, [0.0, path.plane(0.0).parallel]);
        path.last = [straight; 2];
        path
    }

    /// E I at the base, N m².
    fn rigidity(shaft: &Shaft) -> f64 {
        let square = shaft.hub_diameter_m * shaft.hub_diameter_m;
        shaft.youngs_pa * PI * square * square / 64.0
    }

    fn plane(&self, push_deg: f64) -> Plane {
        let push_rad = push_deg.to_radians();
        let pose = Pose::swung(push_rad);
        let z = pose.z();
        let cross = add(self.force, -dot(self.force, z), z);
        // Without a part along the axis the rod keeps to the plane of whisking.
        let e = if cross[2] == 0.0 {
            pose.x
        } else {
            cross.map(|part| part / length(cross))
        };
        let normal = [dot(self.normal, z), dot(self.normal, e)];
        Plane {
            push_rad,
            z,
            e,
            normal,
            force: [dot(self.force, z), dot(self.force, e)],
            parallel: libm::atan2(-normal[0], normal[1]),
        }
    }

    /// Integrates from the contact to the base; `visit` gets arc length and place from the
    /// contact, every step.
    fn shoot(
        &self,
        plane: &Plane,
        [p, w]: [f64; 2],
        mut visit: impl FnMut(u32, f64, [f64; 2]),
    ) -> Shot {
        let contact = 1.0 + w.min(0.0);
        let [fz, fe] = plane.force.map(|part| p * self.unit * part);
        let slope = |s: f64, [psi, z, e]: V3| {
            let d = 1.0 - (1.0 - self.tip) * s;
            let (sine, cosine) = libm::sincos(psi);
            [(fz * e - fe * z) / (d * d * d * d), cosine, sine]
        };
        // ln d from the base to the contact.
        let thinner = libm::log1p((self.tip - 1.0) * contact);
        let at = |n: u32| {
            let share = f64::from(self.steps - n) / f64::from(self.steps);
            if thinner == 0.0 {
                contact * share
            } else {
                libm::expm1(thinner * share) / (self.tip - 1.0)
            }
        };
        let mut state = [plane.parallel - w.max(0.0), 0.0, 0.0];
        let mut s = contact;
        visit(0, s, [0.0; 2]);
        for n in 1..=self.steps {
            let next = at(n);
            let h = next - s;
            let k1 = slope(s, state);
            let k2 = slope(s + 0.5 * h, add(state, 0.5 * h, k1));
            let k3 = slope(s + 0.5 * h, add(state, 0.5 * h, k2));
            let k4 = slope(next, add(state, h, k3));
            let middle = add(k2, 1.0, k3);
            state = add(state, h / 6.0, add(add(k1, 2.0, middle), 1.0, k4));
            s = next;
            visit(n, s, [state[1], state[2]]);
        }
        let [psi, z, e] = state;
        Shot {
            psi,
            moment: fz * e - fe * z,
            contact,
            place: [-z, -e],
        }
    }

    /// What is left of the equations of base and plate.
    fn residual(&self, plane: &Plane, unknowns: [f64; 2]) -> [f64; 2] {
        let shot = self.shoot(plane, unknowns, |_, _, _| {});
        let [nz, ne] = plane.normal;
        let height = shot.place[0] * nz + shot.place[1] * ne - self.normal[0];
        [shot.psi - self.give * shot.moment, height]
    }

    /// Newton's method, each step halved until it helps; none where it does not arrive, or
    /// arrives beyond a fold.
    fn newton(&self, plane: &Plane, start: [f64; 2]) -> Option<([f64; 2], f64)> {
        let size = |[a, b]: [f64; 2]| a * a + b * b;
        let mut at = start;
        let mut left = self.residual(plane, at);
        for _ in 0..20 {
            let h = [1e-6 * at[0].abs().max(1e-2), 1e-6_f64.copysign(at[1])];
            let [a, c] = self.residual(plane, [at[0] + h[0], at[1]]);
            let [b, d] = self.residual(plane, [at[0], at[1] + h[1]]);
            let [a, c] = [(a - left[0]) / h[0], (c - left[1]) / h[0]];
            let [b, d] = [(b - left[0]) / h[1], (d - left[1]) / h[1]];
            let determinant = a * d - b * c;
            let change = [
                (b * left[1] - d * left[0]) / determinant,
                (c * left[0] - a * left[1]) / determinant,
            ];
            if change[0].abs() <= 1e-10 * at[0].abs() && change[1].abs() <= 1e-10 {
                return Some((at, determinant.signum()));
            }
            let mut share = before_kink(at[1], change[1]);
            let tried = loop {
                let next = [at[0] + share * change[0], at[1] + share * change[1]];
                if next[1] > -0.99 {
                    let found = self.residual(plane, next);
                    if size(found) < size(left) || share * size(change) < 1e-16 {
                        break Some((next, found));
                    }
                }
                share *= 0.5;
                if share < 1e-3 {
                    break None;
                }
            };
            (at, left) = tried?;
        }
        None
    }

    /// Follows the shaft to a push that is not below the last one.
    pub(super) fn go_to(&mut self, push_deg: f64) -> Result<(), PressError> {
        while self.last[1].0 < push_deg {
            let [(before, u), (now, v)] = self.last;
            let next = (now + self.step_deg).min(push_deg);
            let ahead = if now > before {
                (next - now) / (now - before)
            } else {
                0.0
            };
            let change = [ahead * (v[0] - u[0]), ahead * (v[1] - u[1])];
            let share = before_kink(v[1], change[1]);
            let guess = [v[0] + share * change[0], v[1] + share * change[1]];
            let plane = self.plane(next);
            let found = self.newton(&plane, guess);
            let found = found.filter(|(at, sign)| self.holds(&plane, *at, *sign));
            if let Some((at, sign)) = found {
                self.sign = sign;
                self.last = [self.last[1], (next, at)];
                self.step_deg = (1.5 * self.step_deg).min(STEP_DEG[0]);
            } else {
                self.step_deg = 0.5 * (next - now);
                if self.step_deg < STEP_DEG[1] {
                    let up_to_deg = libm::floor(now * 1e3) / 1e3;
                    return Err(PressError::Ends { up_to_deg });
                }
            }
        }
        Ok(())
    }

    /// Whether a solution is near the last, presses, and lies before the plate.
    fn holds(&self, plane: &Plane, at: [f64; 2], sign: f64) -> bool {
        let (push, last) = self.last[1];
        let is_near = push == 0.0 || (at[1] - last[1]).abs() < 0.2 && at[0] < 3.0 * last[0];
        let mut lowest = 0.0_f64;
        let [nz, ne] = plane.normal;
        self.shoot(plane, at, |_, _, [z, e]| {
            lowest = lowest.min(z * nz + e * ne);
        });
        // None within rounding is none.
        let presses = at[0] > 1e-9 * plane.push_rad;
        is_near && presses && lowest > -1e-9 && sign * self.sign >= 0.0
    }

    pub(super) fn pressed(&self) -> Pressed {
        let Press { shaft, .. } = self.press;
        let (push_deg, at) = self.last[1];
        let plane = self.plane(push_deg);
        let mut from_contact = Vec::new();
        let shot = self.shoot(&plane, at, |n, s, place| {
            if n % POINT_EVERY == 0 {
                from_contact.push((s, place));
            }
        });
        let l = shaft.length_m;
        let in_space = |s: f64, [z, e]: [f64; 2]| {
            let [x, y, up] = add(plane.z.map(|part| z * part), e, plane.e).map(|part| l * part);
            [l * s, x, y, up]
        };
        let point =
            |(s, [z, e]): &(f64, [f64; 2])| in_space(*s, [shot.place[0] + z, shot.place[1] + e]);
        let mut points_m: Vec<[f64; 4]> = from_contact.iter().rev().map(point).collect();
        if shot.contact < 1.0 {
            let (sine, cosine) = libm::sincos(plane.parallel);
            let rest = 1.0 - shot.contact;
            let tip = [shot.place[0] + rest * cosine, shot.place[1] + rest * sine];
            points_m.push(in_space(1.0, tip));
        }
        let [_, x, y, up] = in_space(shot.contact, shot.place);
        let normal_n = at[0] * self.unit * Self::rigidity(shaft) / (l * l);
        let moment_n_m = shot.moment.abs() * Self::rigidity(shaft) / l;
        // The straight shaft touches where it is, to the last bit.
        let place_m = if push_deg > 0.0 {
            dot([x - l, y, up], self.press.along())
        } else {
            0.0
        };
        let in_plane = dot(plane.e, Pose::swung(push_deg.to_radians()).x);
        Pressed {
            moment_n_m: [moment_n_m * in_plane.abs(), moment_n_m * plane.e[2].abs()],
            normal_n,
            friction_n: self.press.friction * normal_n,
            contact_m: l * shot.contact,
            place_m,
            points_m,
        }
    }
}

/// How much of a change of w, up to all, brings it no more than just across 0: what w means
/// is another there, and so are the equations' slopes.
fn before_kink(w: f64, change: f64) -> f64 {
    if w * (w + change) < 0.0 {
        -w / change * (1.0 + 1e-9)
    } else {
        1.0
    }
}
