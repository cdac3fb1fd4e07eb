"""How a tapered whisker bends around a round bar: an exact elastica, as a truth for tests.

PLACES. The motor's axis is z and passes through the base, at the origin. At first touch the
unbent shaft lies along +x and touches the bar at `reach_m` from the base, away from its tip; the
motor then turns on by the push, towards +y. The bar's axis is parallel to z, at
(reach_m, radius_m). The shaft's own radius is neglected.

ROD. As in elastica.py, in a plane: psi is the tangent's angle, psi' = M / (E I(s)) with
M = (r(c) - r) x F up to the contact at s = c; beyond it the shaft is straight. The follicle is a
spring k: psi(0) = push + M(0) / k.

CONTACT. The shaft's tangent is the bar's: r(c) = axis + radius n with n = (sin psi, -cos psi) at
s = c, and F = N (n + friction t): shaft comes in over the bar towards the base, as the way along
a bent shaft is longer, and friction is against that.

METHOD. Shooting from the contact to the base (DOP853) for N, psi(c) and c; three equations, r(0)
and psi(0). Pushes are followed in steps of 0.1 degrees. A shaft lets go at the
push at which c = L, or where the branch ends in a fold before; that is the last row of its case,
without moment and force.

TABLE. `python bar.py` writes bar.csv, in some minutes (scipy 1.17).
"""
import csv
from itertools import product

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve

MIDDLE = dict(length_m=0.112, hub_m=0.002282, taper=8.0, youngs_pa=1.394e9, follicle_nm_rad=0.2)
PUSHES = [2, 5, 10, 15, 20, 25, 30]


class Bar:
    def __init__(self, reach_m, radius_m, friction, **shaft):
        self.g = {**MIDDLE, **shaft}
        self.axis, self.radius, self.mu = np.array([reach_m, radius_m]), radius_m, friction
        self.guess = np.array([0.01, 1e-3, reach_m])

    def stiffness(self, s):
        g = self.g
        d = g["hub_m"] * (1 + (1 / g["taper"] - 1) * s / g["length_m"])
        return g["youngs_pa"] * np.pi * d**4 / 64

    def miss(self, unknowns, push):
        force_n, psi, c = unknowns
        n, t = np.array([np.sin(psi), -np.cos(psi)]), np.array([np.cos(psi), np.sin(psi)])
        touch, force = self.axis + self.radius * n, force_n * (n + self.mu * t)

        def slope(s, y):
            arm = touch - y[:2]
            moment = arm[0] * force[1] - arm[1] * force[0]
            return [np.cos(y[2]), np.sin(y[2]), moment / self.stiffness(s)]

        out = solve_ivp(slope, (c, 0), [*touch, psi], "DOP853", rtol=1e-11, atol=1e-14)
        x, y, base = out.y[:, -1]
        self.moment = (touch[0] - x) * force[1] - (touch[1] - y) * force[0]
        follows = base - push - self.moment / self.g["follicle_nm_rad"]
        return [x / 0.1, y / 0.1, follows]

    def at(self, push_deg):
        found, _, ok, why = fsolve(self.miss, self.guess, np.radians(push_deg), full_output=True,
                                   xtol=1e-12)
        worst = max(map(abs, self.miss(found, np.radians(push_deg))))
        if ok != 1 and worst > 1e-9:
            raise ArithmeticError(f"no solution at {push_deg}: {why}")
        self.guess = found
        return found

    def follow(self, pushes_deg):
        """Rows up to the push at which the shaft lets go, and that push."""
        length = self.g["length_m"]
        for tenth in range(1, 10 * max(pushes_deg) + 1):
            push = tenth / 10
            before = self.guess.copy()
            try:
                force_n, _, c = self.at(push)
            except ArithmeticError:
                yield "lost", push
                return
            if c > length:
                def over(push_deg):
                    self.guess = before.copy()
                    return self.at(push_deg)[2] - length
                yield "lost", brentq(over, push - 0.1, push, xtol=1e-6)
                return
            if push in pushes_deg:
                yield push, (abs(self.moment), force_n, c)


def main():
    columns = [*MIDDLE, "reach_m", "radius_m", "friction", "push_deg", "moment_nm", "normal_n", "contact_m"]
    with open("bar.csv", "w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(columns)
        shafts = [{}, dict(length_m=0.06), dict(length_m=0.2, taper=3.0)]
        for shaft, part, radius_m, friction in product(shafts, [0.6, 0.9], [5e-4, 5e-3], [0.0, 0.3]):
            given = {**MIDDLE, **shaft}
            reach_m = part * given["length_m"]
            case = [*given.values(), round(reach_m, 6), radius_m, friction]
            for push, found in Bar(reach_m, radius_m, friction, **shaft).follow(PUSHES):
                if push == "lost":
                    rows.writerow([*case, f"{found:.5g}", 0, 0, given["length_m"]])
                else:
                    rows.writerow([*case, f"{push:g}", *(f"{value:.6g}" for value in found)])


if __name__ == "__main__":
    main()
