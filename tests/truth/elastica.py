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
Three equations: t(0), and r(c) on the plate. Pushes are followed from 0.05 degrees on.

SOURCES. Euler-Bernoulli elastica and Kirchhoff rod: Love, A Treatise on the Mathematical Theory
of Elasticity, 4th ed., ch. XVIII-XIX; Antman, Nonlinear Problems of Elasticity, 2nd ed., ch. 4, 8.

TABLES. `python elastica.py tables`, in this folder, writes press.csv; `python elastica.py check` runs the checks
of accuracy. Made with Python 3.11.7, numpy 2.4.6, scipy 1.17.1.
"""
import csv
import sys
from multiprocessing import Pool

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

MIDDLE = dict(length_m=0.112, hub_m=0.002282, taper=8.0, youngs_pa=1.394e9, follicle_nm_rad=0.2)
SETTING = dict(slant_deg=30.0, tilt_deg=0.0, friction=0.0)


def plate(slant_deg, tilt_deg, **_):
    """Along, across and normal of the plate, unit vectors."""
    b, q = np.radians([slant_deg, tilt_deg])
    along = np.array([np.cos(b), -np.sin(b), 0.0])
    normal = np.array([-np.cos(q) * np.sin(b), -np.cos(q) * np.cos(b), np.sin(q)])
    return along, np.cross(normal, along), normal


def friction_way(slant_deg, tilt_deg, friction, **_):
    """Friction over normal force, a vector in the plate, against the tip's first slide.

    A slide of first order in the push is along e, where the plate meets the plane x = L. It
    comes about only if friction along e does not hold it: tan tilt m / cos slant > mu. Otherwise
    friction's part along e is what holds it, and the slide, of second order as the shaft bends
    and so reaches less far, is against the rest of friction, along g.
    """
    if friction == 0.0:
        return np.zeros(3)
    b, q = np.radians([slant_deg, tilt_deg])
    normal = plate(slant_deg, tilt_deg)[2]
    m = np.hypot(np.cos(q) * np.cos(b), np.sin(q))
    e = np.array([0.0, np.sin(q), np.cos(q) * np.cos(b)]) / m
    g = np.cross(e, normal)
    g *= np.sign(g[0])
    if abs(np.tan(q)) * m / np.cos(b) >= friction:
        return -np.sign(q) * friction * e
    # f_e = -tan tilt (m + f_g cos tilt sin slant) / cos slant, and f_e^2 + f_g^2 = mu^2.
    u, v = np.tan(q) * m / np.cos(b), np.tan(q) * np.cos(q) * np.tan(b)
    f_g = (-u * v + np.sqrt((u * v) ** 2 + (1 + v * v) * (friction**2 - u * u))) / (1 + v * v)
    return -(u + v * f_g) * e + f_g * g


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
        self.way = g.get("way", friction_way(**g))
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

    def shoot(self, unknowns):
        """From the contact to the base; unknowns in columns. Returns c, F, r(c), t(0), t(c)."""
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
        out = solve_ivp(slope, (0, 1), start, "DOP853", rtol=self.rtol, atol=self.rtol * 1e-3)
        q, t = out.y[:, -1].reshape(2, 3, cols)
        return c, force, -q, t, t_c

    def miss(self, unknowns, push):
        c, force, r_c, t_0, _ = self.shoot(unknowns)
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
                guess = u * ahead / push if past is None else u + (u - past[1]) * (ahead - push) / (push - past[0])
                if past is None:
                    guess[1:] = u[1:]
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
        c, force, r_c, t_0, t_c = (v[..., 0] for v in self.shoot(u[:, None]))
        rad = np.radians(push)
        moment = np.cross(r_c, force)
        motor = np.array([np.cos(rad), np.sin(rad), 0.0])
        slid = r_c - np.array([self.length, 0.0, 0.0])
        normal_n = u[0] * self.unit_n
        return dict(push_deg=push, moment_x_nm=abs(moment[2]),
                    moment_y_nm=abs(moment @ np.array([-motor[1], motor[0], 0.0])),
                    normal_n=normal_n, friction_n=normal_n * np.linalg.norm(self.way),
                    contact_m=c, place_m=self.frame[0] @ slid, across_m=self.frame[1] @ slid,
                    tip_slope_deg=np.degrees(np.arccos(np.clip(motor @ t_c, -1, 1))))


def curve(job):
    """Rows of one press, with its inputs in front, and what ended it."""
    inputs, pushes = job
    press = Press(**inputs)
    rows = press.follow(pushes)
    given = {key: value for key, value in press.given.items() if key != "way"}
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


def write(path, jobs, columns):
    with Pool(2) as pool:
        curves = pool.map(curve, list(jobs), chunksize=1)
    with open(path, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(columns)
        for rows, given, ended in curves:
            for row in rows:
                row["moment_nm"] = np.hypot(row["moment_x_nm"], row["moment_y_nm"])
                out.writerow([f"{row[name]:.9g}" for name in columns])
            if ended is not None:
                print(f"{path}: ends at {ended:.3f} degrees:", given)


INPUTS = list(MIDDLE) + list(SETTING)
RESULTS = ["contact_m", "place_m", "tip_slope_deg"]


if __name__ == "__main__":
    if sys.argv[1:] == ["tables"]:
        write("press.csv", planar_jobs(),
              INPUTS + ["push_deg", "moment_nm", "normal_n", "friction_n"] + RESULTS)
    else:
        sys.exit(__doc__)
