"""Checks of elastica.py: its tables at another tolerance, and two other methods. See there."""
from multiprocessing import Pool

import numpy as np
from scipy.integrate import solve_bvp
from scipy.optimize import minimize

from elastica import Press, planar_jobs, tilted_jobs, turned

COLUMNS = ["moment_x_nm", "moment_y_nm", "normal_n", "contact_m", "place_m", "across_m",
           "tip_slope_deg"]


def worst_of(job):
    """Largest relative change of any result when the tolerance is 100 times smaller."""
    inputs, pushes = job
    coarse = Press(**inputs).follow(pushes)
    fine = Press(rtol=1e-12, **inputs).follow(pushes, step_deg=0.7)
    assert len(coarse) == len(fine) == len(pushes)
    # What is below 1e-14 is zero in the tables too.
    return max(abs(a[name] - b[name]) / max(abs(b[name]), 1e-14)
               for a, b in zip(coarse, fine) for name in COLUMNS
               if max(abs(a[name]), abs(b[name])) > 1e-14)


def by_bvp(push_deg, **inputs):
    """A planar case with contact inside the shaft, by collocation: moment, normal force, c."""
    press = Press(**inputs)
    row = press.follow([push_deg])[-1]
    along, _, normal = press.frame
    push, slant = np.radians([push_deg, press.given["slant_deg"]])
    fx, fy, _ = press.force

    # y: angle, x and y of the centre line from the base on, moment; parameters: N, c.
    def slope(x, y, p):
        force, c = p
        angle, moment = y[0], y[3]
        return c * np.array([moment / press.stiffness(c * x), np.cos(angle), np.sin(angle),
                             -force * (fy * np.cos(angle) - fx * np.sin(angle))])

    def ends(at_base, at_contact, p):
        gap = normal[:2] @ (at_contact[1:3] - [press.length, 0.0])
        return np.array([at_base[0] - push - at_base[3] / press.k, at_base[1], at_base[2],
                         at_contact[0] + slant, at_contact[3], gap])

    x = np.linspace(0, 1, 200) ** 0.7
    c = row["contact_m"] * 0.99
    moment = -row["moment_x_nm"] * (1 - x)
    guess = np.array([push - (push + slant) * x**2, c * x, 0.2 * c * x * (1 - x), moment])
    out = solve_bvp(slope, ends, x, guess, p=[row["normal_n"] * 0.9, c], tol=1e-9,
                    max_nodes=100000)
    assert out.success, out.message
    pairs = [(abs(out.y[3, 0]), row["moment_x_nm"]), (out.p[0], row["normal_n"]),
             (out.p[1], row["contact_m"])]
    return max(abs(a / b - 1) for a, b in pairs)


def chain(turns):
    """Products of rotations, first to last: turns is (n, 4), quaternions."""
    out, reach = turns.copy(), 1
    while reach < len(out):
        a, b = out[:-reach], out[reach:]
        scalar = a[:, :1] * b[:, :1] - np.sum(a[:, 1:] * b[:, 1:], axis=1, keepdims=True)
        vector = a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])
        out = np.concatenate([out[:reach], np.concatenate([scalar, vector], axis=1)])
        reach *= 2
    return out


def by_energy(push_deg, twist_share, terms=7, steps=1500, **inputs):
    """A case without friction, as the least energy of a rod that bends and twists.

    Moments over the length are polynomials of the place over c; the shaft is straight beyond.
    GJ = `twist_share` E I. Where contact is inside, c is taken from the shooting, and the point at
    c and the tip are on the plate; c is right if then no moment is left at c. Otherwise the tip
    alone is on it. Returns the largest difference, the moment at c over that at the base, and
    the twist, rad.
    """
    press = Press(**inputs)
    row = press.follow([push_deg])[-1]
    inside = row["contact_m"] < press.length
    length, k, c = press.length, press.k, row["contact_m"]
    normal = press.frame[2]
    x = (np.arange(steps) + 0.5) / steps
    shapes = np.polynomial.legendre.legvander(2 * x - 1, terms - 1)
    push = np.radians(push_deg)
    # Axes of the motor: its direction, across, and its own axis.
    motor = np.array([[np.cos(push), np.sin(push), 0], [-np.sin(push), np.cos(push), 0], [0, 0, 1]])
    unit_nm = row["moment_x_nm"]

    def parts(v):
        moments = unit_nm * shapes @ v[: 3 * terms].reshape(terms, 3)
        base = v[3 * terms: 3 * terms + 2] * unit_nm / k
        curve = moments / press.stiffness(c * x)[:, None] / np.array([twist_share, 1.0, 1.0])
        energy = (0.5 * np.sum(moments * curve) * c / steps + 0.5 * k * base @ base) / unit_nm
        return curve, base, energy

    def gaps(v):
        curve, base, _ = parts(v)
        first = turned(motor.T, (base[0] * motor[1] + base[1] * motor[2])[:, None])
        # Half a step, then whole ones: the tangent in the middle of each step.
        half = curve * c / steps / 2
        ways = np.concatenate([half[:1], half[:-1] + half[1:]])
        size = np.linalg.norm(ways, axis=1, keepdims=True) + 1e-300
        turns = chain(np.concatenate([np.cos(size / 2), np.sin(size / 2) * ways / size], axis=1))
        w, p, q, r = turns.T
        t = np.stack([1 - 2 * (q * q + r * r), 2 * (p * q + w * r), 2 * (p * r - w * q)])
        place = first @ t.mean(axis=1) * c
        w, p, q, r = chain(np.stack([turns[-1], np.r_[np.cos(size[-1] / 2), 0, 0, 0]]))[0]
        last = first @ t[:, -1]
        gap = normal @ (place - [length, 0.0, 0.0]) / length
        return np.array([gap, gap + normal @ last * (length - c) / length] if inside else [gap])

    start = np.zeros(3 * terms + 2)
    start[2], start[5], start[3 * terms + 1] = -0.5, 0.5, -1.0
    done = minimize(lambda v: parts(v)[2], start, constraints=dict(type="eq", fun=gaps),
                    method="SLSQP", options=dict(ftol=1e-15, maxiter=500))
    curve, base, _ = parts(done.x)
    pairs = [(abs(k * base[1]), row["moment_x_nm"]), (abs(k * base[0]), row["moment_y_nm"])]
    left = np.linalg.norm(done.x[: 3 * terms].reshape(terms, 3).sum(axis=0))
    twist = np.sum(np.abs(curve[:, 0])) * c / steps
    return max(abs(a / b - 1) for a, b in pairs), left, twist


if __name__ == "__main__":
    for push, more in ((10, {}), (20, {}), (45, {}), (20, dict(friction=0.3)),
                       (30, dict(slant_deg=60.0, friction=0.5)), (20, dict(taper=15.0))):
        print(f"solve_bvp, {push} degrees, {more}: {by_bvp(push, **more):.1e}")
    for push in (5, 20):
        for share, says in ((1 / 1.3, "nu 0.3"), (1e3, "rigid")):
            off, left, twist = by_energy(push, share, tilt_deg=20.0)
            print(f"least energy, tilt 20, {push} degrees, torsion {says}: {off:.1e}, moment "
                  f"at the contact {left:.1e} of the base's, twists by {twist:.1e} rad")
    with Pool(2) as pool:
        for name, jobs in (("press.csv", planar_jobs()), ("tilt.csv", tilted_jobs())):
            print(f"{name}, tolerance 1e-10 to 1e-12: {max(pool.map(worst_of, list(jobs))):.1e}")
