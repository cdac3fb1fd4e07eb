"""Whisking by scipy's DOP853 at rtol 1e-13: the rows of whisk_*hz.csv.

Run beside this file: python3 dop853.py
Ten whisks of the continuous equations (BIOTACT eq. 2-8: coupling on, z = 0,
g = 1, no noise), sides started at psi = [1, 0] and [0.6, 0.5], muscles at rest.
Columns: tick (of 0.5 ms), theta' of the left and right side in degrees.
"""

import numpy as np
from scipy.integrate import solve_ivp

TICK_S = 0.0005
STRIDE = {2: 25, 8: 7, 25: 2}  # ticks a row, to keep each file short


def rates(_, y, f):
    p1, q1, p2, q2, th1, v1, th2, v2 = y
    period = 1.0 / f
    tau, mass, w = 2.0 * period, period**2 / 100.0, 2.0 * np.pi * f
    nu = 4.0 * np.sqrt(mass)

    def oscillator(p, q, p_other):
        r = np.hypot(p, q)
        a = (1.0 - r) / (tau * r)
        return a * p - w * q + (p_other - p) / tau, a * q + w * p

    def muscle(p, th, v):
        force = 1.45 * np.exp(-th * th) * (np.tanh(2.0 * p) + 1.0) / 2.0
        return v, (force - th - nu * v) / mass

    return [
        *oscillator(p1, q1, p2),
        *oscillator(p2, q2, p1),
        *muscle(p1, th1, v1),
        *muscle(p2, th2, v2),
    ]


for f, stride in STRIDE.items():
    y = np.array([1.0, 0.0, 0.6, 0.5, 0.0, 0.0, 0.0, 0.0])
    with open(f"whisk_{f}hz.csv", "w") as out:
        out.write("tick,theta_left_deg,theta_right_deg\n")
        ticks = round(10 / f / TICK_S)
        # A solve from row to row: end points are more accurate than the
        # interpolant between them.
        for tick in range(stride, ticks + 1, stride):
            span = (0.0, stride * TICK_S)
            run = solve_ivp(rates, span, y, method="DOP853", args=(f,), rtol=1e-13, atol=1e-15)
            y = run.y[:, -1]
            out.write(f"{tick},{100 * y[4] + 50:.13f},{100 * y[6] + 50:.13f}\n")
