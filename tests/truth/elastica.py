"""How a tapered whisker bends against a plate: an exact elastica, as a truth for tests.

PLACES. The motor's axis is z and passes through the base, at the origin. At first touch the
unbent shaft lies along +x, its tip at p = (L, 0, 0); the motor then turns on by the push,
towards +y. The plate passes through p. Its normal, on the whisker's side, is
    n = (-cos tilt sin slant, -cos tilt cos slant, sin tilt),
and the line in which it meets the plane of whisking is, away from the base,
    a = (cos slant, -sin slant, 0).

ROD (Kirchhoff; inextensible, unshearable, circular sections; E I(s) = E pi d(s)^4 / 64, d linear
in arc length s). r is the centre line, t its tangent. One force F acts, at s = c, so for s < c
    r' = t,    t' = M x t / (E I),    M = (r(c) - r) x F,
and beyond c the shaft is straight. The moment of torsion M.t is the same along all of the shaft:
    (M.t)' = M'.t + M.t' = (F x t).t + M.(M x t) / (E I) = 0,
and it is 0 at c. So nothing twists, and torsion's stiffness has no part in it, rigid or not.

BASE. The follicle is a spring between motor and shaft, k in both axes of bending, rigid in
torsion: t(0) is the motor's direction (cos push, sin push, 0) turned by the vector M(0) / k.

CONTACT. The radius of the shaft is neglected. Either the tip touches and points into the plate,
c = L and t(L).n <= 0; or a point inside touches, its tangent in the plate: t(c).n = 0, c < L.
F = N (n + friction), where the friction has the size mu and a fixed direction, against the first
slide of the tip; `friction_way` finds it.

METHOD. Shooting from the contact to the base (DOP853) for three unknowns: N, the direction of
t(c) in the plate, and w: w >= 0 is the tip's angle into the plate, w < 0 says c = L (1 + w).
Three equations: t(0), and r(c) on the plate. Pushes are followed from 0.05 degrees on. Of every
row the shaft is checked not to pass the plate.

SOURCES. Love, A Treatise on the Mathematical Theory of Elasticity, 4th ed., ch. XVIII and XIX
(Kirchhoff's rod, the elastica); Antman, Nonlinear Problems of Elasticity, 2nd ed., ch. 4 and 8.

TABLES. `python elastica.py`, in this folder, writes press.csv (no tilt) and tilt.csv, in two
minutes. Made with Python 3.11.7, numpy 2.4.6, scipy 1.17.1. Sizes, in SI units and degrees:
    moment_x_nm, moment_y_nm   moment at the base about the motor's axis, and across both that
                               axis and the motor's direction; moment_nm: both together
    normal_n, friction_n       forces at the contact
    contact_m                  arc length of the contact from the base, c
    place_m, across_m          place of the contact, from p along a, and along n x a (signed)
    tip_slope_deg              angle between the tip's tangent and the motor's direction
    friction_along, _across    friction over normal force along a and n x a (signed)
    sideways                   1: the planar shaft also keeps its plane; 0: without a guide it
                               falls sideways, as the force has passed the motor's direction,
                               push >= 90 - slant + atan(friction); the row is planar all the same
EXTENT. A solution exists at every push of the tables. With a slant of 60 degrees and no friction
it ends in a fold, where the shaft snaps over, soon after: at 50.3 degrees for the middle shaft,
55.6 and 49.2 for 60 mm and tapers of 3 and 15, 54.0 and 47.7 for 200 mm.

ACCURACY. `python elastica_check.py` computes the tables at another tolerance, and some cases in
two other ways: solve_bvp, and the least energy of a rod that also twists. It prints, at most:
    press.csv and tilt.csv, tolerance of the integration 1e-10 against 1e-12 and steps of push
    halved, any size: 2.6e-9 relative
    six planar cases by solve_bvp, moment, force and c: 9e-11 relative
    tilt of 20 degrees, 5 and 20 degrees of push, by least energy: 4.5e-6 relative; it twists by
    less than 1e-7 rad, whether GJ = E I / 1.3 (Poisson's ratio 0.3) or 1000 E I
THE STUDY'S TABLE. Base moment, normal force and contact agree in every digit but the moment at
20 degrees, 2.6285e-3, printed as 2.629e-3. Its slope of the tip (39, 48, 70, 89, 121 degrees) is
that of a shaft held at the tip alone, Press(tip_only=True). With contact inside and no tilt it is
slant + push.
"""
import csv
from multiprocessing import Pool

import numpy as np
from scipy.integrate import solve_ivp

MIDDLE = dict(length_m=0.112, hub_m=0.002282, taper=8.0, youngs_pa=1.394e9, follicle_nm_rad=0.2)
SETTING = dict(slant_deg=30.0, tilt_deg=0.0, friction=0.0)


def plate(slant_deg, tilt_deg, **_):
    """Along, across and normal of the plate, unit vectors."""
    b, q = np.radians([slant_deg, tilt_deg])
    along = np.array([np.cos(b), -np.sin(b), 0.0])
    normal = np.array([-np.cos(q) * np.sin(b), -np.cos(q) * np.cos(b), np.sin(q)])
    return along, np.cross(normal, along), normal


def friction_way(slant_deg, tilt_deg, friction, rule="own", **_):
    """Friction over normal force, a vector in the plate, against the tip's first slide.

    To first order in the push the tip can slide along e alone, where the plate meets the plane
    x = L. It does if friction along e cannot hold it: tan tilt m / cos slant > mu. Otherwise
    friction takes what would push the tip out of the plane of whisking, n_z + friction_z = 0,
    and what is left of it, along a, is against the slide of second order: as the shaft bends it
    reaches less far, so its tip comes back along the plate. That is the limit, for small pushes,
    of a friction that turns with the slide. Rule "free": against the first slide that there
    would be without friction, along e whenever there is a tilt.
    """
    b, q = np.radians([slant_deg, tilt_deg])
    along, side, _ = plate(slant_deg, tilt_deg)
    m = np.hypot(np.cos(q) * np.cos(b), np.sin(q))
    if tilt_deg != 0.0 and (rule == "free" or abs(np.tan(q)) * m / np.cos(b) > friction):
        return -np.sign(q) * friction * np.array([0.0, np.sin(q), np.cos(q) * np.cos(b)]) / m
    return np.sqrt(friction**2 - np.tan(q) ** 2) * along - np.tan(q) * side


def turned(vector, by):
    """`vector`, turned by the rotation vector `by`; columns."""
    angle = np.linalg.norm(by, axis=0) + 1e-300
    axis = by / angle
    along = np.sum(axis * vector, axis=0)
    return (vector * np.cos(angle) + np.cross(axis, vector, axis=0) * np.sin(angle)
            + axis * along * (1 - np.cos(angle)))


class Press:
    """A shaft and a plate; `at` finds the state at a push."""

    def __init__(self, rtol=1e-10, tip_only=False, **inputs):
        self.given = {**MIDDLE, **SETTING, **inputs}
        self.rtol, self.tip_only = rtol, tip_only
        g = self.given
        self.length, self.k = g["length_m"], g["follicle_nm_rad"]
        self.frame = plate(**g)
        self.way = friction_way(**g)
        self.force = self.frame[2] + self.way
        s = (np.arange(4000) + 0.5) / 4000 * self.length
        bend = (self.length - s) / self.stiffness(s) * self.length / 4000
        give = np.sum(bend * (self.length - s)) + self.length**2 / self.k
        self.turn = np.sum(bend) + self.length / self.k
        # Force of a push of 1 rad, to first order, without tilt and friction.
        self.unit_n = self.length / give

    def stiffness(self, s):
        g = self.given
        d = g["hub_m"] * (1 + (1 / g["taper"] - 1) * s / self.length)
        return g["youngs_pa"] * np.pi * d**4 / 64

    def shoot(self, unknowns, nodes=2):
        """From the contact to the base; unknowns in columns.

        Returns c, F, r(c), t(0), t(c), and points of the bent part, from the contact on."""
        n_rel, eta, w = unknowns
        along, side, normal = (v[:, None] for v in self.frame)
        into = w if self.tip_only else np.maximum(w, 0.0)
        c = self.length * (1 + (0.0 * w if self.tip_only else np.minimum(w, 0.0)))
        force = n_rel * self.unit_n * self.force[:, None]
        t_c = np.cos(into) * (np.cos(eta) * along + np.sin(eta) * side) - np.sin(into) * normal
        cols = len(c)

        def slope(x, y):
            q, t = y.reshape(2, 3, cols)
            moment = np.cross(-q, force, axis=0)
            bent = np.cross(moment, t, axis=0) / self.stiffness(c * (1 - x))
            return -np.concatenate([c * t, c * bent]).ravel()

        start = np.concatenate([np.zeros((3, cols)), t_c]).ravel()
        out = solve_ivp(slope, (0, 1), start, "DOP853", rtol=self.rtol, atol=self.rtol * 1e-3,
                        t_eval=np.linspace(0, 1, nodes))
        assert out.success
        q, t = out.y[:, -1].reshape(2, 3, cols)
        points = out.y.reshape(2, 3, cols, nodes)[0].transpose(2, 0, 1) - q
        return c, force, -q, t, t_c, points

    def miss(self, unknowns, push):
        c, force, r_c, t_0, *_ = self.shoot(unknowns)
        motor = np.array([[np.cos(push)], [np.sin(push)], [0.0]])
        base = turned(motor, np.cross(r_c, force, axis=0) / self.k)
        wrong = t_0 - base
        gap = self.frame[2] @ (r_c - np.array([[self.length], [0.0], [0.0]])) / self.length
        return np.array([motor[0] * wrong[1] - motor[1] * wrong[0], wrong[2], gap])

    def solve(self, guess, push):
        """Newton; its Jacobian by central differences, all in one integration."""
        u = guess.copy()
        step = 1e-5
        for _ in range(25):
            sides = np.where(u[2] < 0, -1.0, 1.0)
            h = np.diag([step * max(u[0], 1e-3), step, step])
            cols = np.column_stack([u, *(u + d for d in h), *(u - d for d in h)])
            f = self.miss(cols, push)
            jac = (f[:, 1:4] - f[:, 4:7]) / (2 * np.diag(h))
            move = np.linalg.solve(jac, -f[:, 0])
            scale = max(abs(move) / np.array([0.3 * u[0] + 1e-3, 0.3, 0.3]))
            u = u + move / max(1.0, scale)
            if scale < 1e-9:
                return u, np.linalg.det(jac)
            if not np.all(np.isfinite(u)) or u[0] <= 0 or (u[2] < -0.95 and not self.tip_only):
                break
        raise ArithmeticError(f"no solution at {np.degrees(push):.4f}")

    def follow(self, pushes_deg, step_deg=1.5):
        """Rows for rising pushes; ends early, with `self.ended`, where the branch ends."""
        push, self.ended = 0.05, None
        rad = np.radians(push)
        slant = np.radians(self.given["slant_deg"])
        n_rel = rad / np.cos(slant) / (1 + np.linalg.norm(self.way) * np.tan(slant))
        u, _ = self.solve(np.array([n_rel, 0.0, slant + rad * (1 - self.turn * self.unit_n)]), rad)
        past, rows, step = None, [], 0.2
        for target in sorted(pushes_deg):
            while push < target:
                ahead = min(target, push + step)
                if past is None:
                    guess = np.array([u[0] * ahead / push, u[1], u[2]])
                else:
                    guess = u + (u - past[1]) * (ahead - push) / (push - past[0])
                guess[0] = max(guess[0], 0.2 * u[0])
                try:
                    new, _ = self.solve(guess, np.radians(ahead))
                    if max(abs(new[1:] - u[1:])) > 0.35:
                        raise ArithmeticError("a jump")
                except (ArithmeticError, np.linalg.LinAlgError):
                    step = (ahead - push) / 3
                    if step < 1e-3:
                        self.ended = push
                        return rows
                    continue
                past, u, push = (push, u), new, ahead
                step = min(step_deg, step * 1.6)
            rows.append(self.row(u, push))
        return rows

    def row(self, u, push):
        c, force, r_c, _, t_c, points = (v[..., 0] for v in self.shoot(u[:, None], 1001))
        rad = np.radians(push)
        moment = np.cross(r_c, force)
        motor = np.array([np.cos(rad), np.sin(rad), 0.0])
        slid = r_c - np.array([self.length, 0.0, 0.0])
        normal_n = u[0] * self.unit_n
        # No point of the shaft is behind the plate.
        above = (points - np.array([self.length, 0.0, 0.0])) @ self.frame[2]
        assert self.tip_only or min(above) > -1e-8 * self.length, (self.given, push, min(above))
        return dict(push_deg=push, moment_x_nm=abs(moment[2]),
                    moment_y_nm=abs(moment @ np.array([-motor[1], motor[0], 0.0])),
                    normal_n=normal_n, friction_n=normal_n * np.linalg.norm(self.way),
                    contact_m=c, place_m=self.frame[0] @ slid, across_m=self.frame[1] @ slid,
                    friction_along=self.frame[0] @ self.way,
                    friction_across=self.frame[1] @ self.way,
                    sideways=float(push < 90 - self.given["slant_deg"]
                                   + np.degrees(np.arctan(self.given["friction"]))),
                    tip_slope_deg=np.degrees(np.arccos(np.clip(motor @ t_c, -1, 1))))


def curve(job):
    """Rows of one press, with its inputs in front, and what ended it."""
    inputs, pushes = job
    press = Press(**inputs)
    rows = press.follow(pushes)
    given = {key: value for key, value in press.given.items() if key != "rule"}
    return [{**given, **row} for row in rows], given, press.ended


def planar_jobs():
    """The study's table, then slants and frictions, shafts, and corners of both."""
    pushes = [2, 5, 10, 20, 30, 45]
    yield {}, [2, 3, 5, 8, 10, 15, 20, 25, 30, 45]
    for slant in (20.0, 30.0, 45.0, 60.0):
        for friction in (0.0, 0.1, 0.3, 0.5):
            if (slant, friction) != (30.0, 0.0):
                yield dict(slant_deg=slant, friction=friction), pushes
    for length in (0.060, 0.112, 0.200):
        for taper in (3.0, 8.0, 15.0):
            shaft = dict(length_m=length, hub_m=MIDDLE["hub_m"] * length / 0.112, taper=taper)
            if (length, taper) != (0.112, 8.0):
                yield shaft, pushes
            if length != 0.112 and taper != 8.0:
                for slant in (20.0, 60.0):
                    for friction in (0.0, 0.5):
                        yield dict(**shaft, slant_deg=slant, friction=friction), pushes


def tilted_jobs():
    """Tilts without friction, with it, and with it against the frictionless slide."""
    for rule, friction in (("own", 0.0), ("own", 0.3), ("free", 0.3)):
        for tilt in (5.0, 10.0, 20.0):
            yield dict(tilt_deg=tilt, friction=friction, rule=rule), [2, 5, 10, 20, 30]


def write(path, jobs, columns):
    with Pool(2) as pool:
        curves = pool.map(curve, list(jobs), chunksize=1)
    with open(path, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(columns)
        for rows, given, ended in curves:
            for row in rows:
                row["moment_nm"] = np.hypot(row["moment_x_nm"], row["moment_y_nm"])
                # What is zero but for rounding is written as zero.
                out.writerow([f"{row[name] if abs(row[name]) > 1e-14 else 0:.9g}"
                              for name in columns])
            if ended is not None:
                print(f"{path}: ends at {ended:.3f} degrees:", given)


INPUTS = list(MIDDLE) + list(SETTING)
RESULTS = ["contact_m", "place_m", "tip_slope_deg"]


if __name__ == "__main__":
    write("press.csv", planar_jobs(),
          INPUTS + ["push_deg", "moment_nm", "normal_n", "friction_n"] + RESULTS + ["sideways"])
    write("tilt.csv", tilted_jobs(),
          INPUTS + ["friction_along", "friction_across", "push_deg", "moment_x_nm",
                    "moment_y_nm", "normal_n", "friction_n"] + RESULTS + ["across_m"])
