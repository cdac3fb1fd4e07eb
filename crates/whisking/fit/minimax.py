#!/usr/bin/env python3
"""Minimax coefficients of the elementary functions in ../src/math/single.rs.

Run: python3 minimax.py      (needs numpy; prints what single.rs holds)

Three fits by Lawson's iteration (weighted least squares whose weights drift
towards the largest errors), then rounded to single precision:
  tanh(2x)/2 = x P(x^2)/Q(x^2), P of degree 2, Q of degree 3 with Q(0) = 1, |x| <= 1.5
  exp(-u) = R(u)^2, R of degree 6, 0 <= u <= 2.25 (u = x^2, |x| <= 1.5)
  1 - 1/sqrt(1 + x) = x S(x), S of degree 2, |x| <= 1/16
"""
import numpy as np


def lawson(columns, target, rounds=400):
    weight = np.full(len(target), 1.0 / len(target))
    best, best_error = None, np.inf
    for _ in range(rounds):
        root = np.sqrt(weight)[:, None]
        c, *_ = np.linalg.lstsq(columns * root, target * root[:, 0], rcond=None)
        error = np.abs(columns @ c - target)
        if error.max() < best_error:
            best, best_error = c, error.max()
        weight *= error + 1e-18
        weight /= weight.sum()
    return best


def chebyshev_grid(lo, hi, n=4001):
    return lo + (hi - lo) * (1 - np.cos(np.pi * (np.arange(n) + 0.5) / n)) / 2


def fit_tanh():
    x = chebyshev_grid(1e-4, 1.5)
    u, y = x * x, np.tanh(2 * x) / 2
    q = np.ones_like(u)
    for _ in range(60):  # linearised: (x P - y (Q - 1)) / Q_previous = y / Q_previous
        columns = np.stack([x, x * u, x * u**2, -y * u, -y * u**2, -y * u**3], 1) / q[:, None]
        c = lawson(columns, y / q, 60)
        q = 1 + c[3] * u + c[4] * u**2 + c[5] * u**3
    return c[:3], np.concatenate([[1.0], c[3:]])


def fit_root_exp():
    u = chebyshev_grid(0.0, 2.25)
    root = np.exp(-u / 2)
    # The error of the square is twice the root times that of the root.
    return lawson((u[:, None] ** np.arange(7)[None, :]) * 2 * root[:, None], root * 2 * root, 8000)


def fit_excess():
    x = chebyshev_grid(-1 / 16, 1 / 16)
    return lawson(x[:, None] ** np.arange(1, 4)[None, :], 1 - 1 / np.sqrt(1 + x), 8000)


if __name__ == "__main__":
    p, q = fit_tanh()
    e, s = fit_root_exp(), fit_excess()
    f = np.float32
    x = np.linspace(-1.5, 1.5, 2_000_001).astype(f)
    u = x * x
    num = x * ((f(p[2]) * u + f(p[1])) * u + f(p[0]))
    den = ((f(q[3]) * u + f(q[2])) * u + f(q[1])) * u + f(1)
    print("tanh P", [float(f(v)) for v in p])
    print("tanh Q", [float(f(v)) for v in q])
    print("tanh(2x)/2 largest error in f32", np.abs(num / den - np.tanh(2 * x.astype(float)) / 2).max())
    root = np.full_like(u, f(e[6]))
    for k in range(5, -1, -1):
        root = root * u + f(e[k])
    print("root of exp", [float(f(v)) for v in e])
    print("exp(-x^2) largest error in f32", np.abs(root * root - np.exp(-x.astype(float) ** 2)).max())
    x = np.linspace(-1 / 16, 1 / 16, 2_000_001).astype(f)
    excess = ((f(s[2]) * x + f(s[1])) * x + f(s[0])) * x
    print("excess", [float(f(v)) for v in s])
    exact = 1 - 1 / np.sqrt(1 + x.astype(float))
    print("1 - 1/sqrt(1 + x) largest error in f32", np.abs(excess - exact).max())
