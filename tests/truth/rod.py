"""A swung whisker against a plate: an exact planar rod, as a truth for motion.

ROD. Inextensible and unshearable; its tangent at the arc length s has turned from the motor's
direction by psi(s) = sum of phi_k'(s) q_k, its places are integrals of the tangent, and its energies

    kinetic  1/2 int rho A |dr/dt|^2 ds,    elastic  1/2 sum omega_k^2 q_k^2

are those of a beam of any deflection: nothing is linearised, inertia changes with the shape. phi_k
are the first 16 modes of the straight beam on the follicle's spring, from Legendre polynomials;
further modes follow the contact's force at once, and count for the base moment alone.
Each mode has the damping ratio 0.05. Neglected are rotary inertia, thickness, gravity.

CONTACT. 150 points of the outer 45 % of the shaft, the last the tip; each that is behind the
plate is pushed back along its normal by 2e4 N/m of depth. No friction.

METHOD. Runge-Kutta of order 4. Integrals by 40 Gauss points, from the base to a point by the
polynomial through them. `reference` gives the base moment every 0.5 ms.
"""
import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

LENGTH, HUB, TAPER, YOUNG, DENSITY, FOLLICLE = 0.112, 0.002282, 8.0, 1.394e9, 1200.0, 0.2
ZETA, SLANT, BEFORE, PUSH_S = 0.05, np.radians(30), np.radians(2), 0.5
POINTS, STIFFNESS = 150, 2e4

X, W = legendre.leggauss(40)
S, W = (X + 1) * LENGTH / 2, W * LENGTH / 2


def diameter(s):
    return HUB * (1 - (1 - 1 / TAPER) * s / LENGTH)


RIGIDITY = YOUNG * np.pi * diameter(S) ** 4 / 64
LINE = DENSITY * np.pi * diameter(S) ** 2 / 4


def to(s):
    """Row of weights for each place s: of the values at S in the integral from 0 to s."""
    n = len(X)
    x = 2 * np.asarray(s) / LENGTH - 1
    values = legendre.legvander(x, n)
    integrals = np.zeros((len(x), n))
    integrals[:, 0] = x + 1
    for k in range(1, n):
        integrals[:, k] = (values[:, k + 1] - values[:, k - 1]) / (2 * k + 1)
    fit = legendre.legvander(X, n - 1).T * (2 * np.arange(n)[:, None] + 1) / LENGTH * W
    return LENGTH / 2 * integrals @ fit


HERE = to(S)
TOUCHING = to(np.linspace(0.55, 1.0, POINTS) * LENGTH)


def modes(count):
    """omega, phi' at S and at the base; as many as there are, the first `count` and the others."""
    many = 34
    slope = legendre.legvander(X, many - 1)
    bend = np.stack([legendre.legval(X, legendre.legder(row)) * 2 / LENGTH
                     for row in np.eye(many)], 1)
    base = legendre.legvander([-1.0], many - 1)[0]
    stiff = bend.T @ (bend * (W * RIGIDITY)[:, None]) + FOLLICLE * np.outer(base, base)
    place = HERE @ slope
    w2, shape = eigh(stiff, place.T @ (place * (W * LINE)[:, None]))
    all_of = np.sqrt(w2), slope @ shape, base @ shape
    return [a[..., :count] for a in all_of], [a[..., count:] for a in all_of]


def motor(t, push):
    """Angle beyond first touch and its acceleration."""
    rate = 2 * np.pi / PUSH_S
    half = (BEFORE + push) / 2
    sin, cos = np.sin(rate * t), np.cos(rate * t)
    return -BEFORE + half * (1 - cos), half * rate * sin, half * rate**2 * cos


def reference(push_deg, contact, count=16, step_s=2.5e-6):
    """Base moments, N m, a row for each push."""
    push, contact = np.radians(push_deg), np.asarray(contact, float)
    (omega, slope, base), (high, high_slope, high_base) = modes(count)
    at_once = high_slope @ (high_base / high**2)
    normal = -np.array([np.sin(SLANT), np.cos(SLANT)])
    mass = (W * LINE)[None, :, None]

    def rates(t, q, v):
        theta, theta1, theta2 = motor(t, push)
        angle = theta[:, None] + q @ slope.T
        turn = theta1[:, None] + v @ slope.T
        sin, cos = np.sin(angle), np.cos(angle)
        x = HERE @ (-sin[:, :, None] * slope)
        y = HERE @ (cos[:, :, None] * slope)
        ax = (-sin * theta2[:, None] - cos * turn**2) @ HERE.T
        ay = (cos * theta2[:, None] - sin * turn**2) @ HERE.T
        xm, ym = (x * mass).transpose(0, 2, 1), (y * mass).transpose(0, 2, 1)
        inertia = xm @ x + ym @ y
        force = -(xm @ ax[:, :, None] + ym @ ay[:, :, None])[..., 0]
        force -= omega**2 * q + 2 * ZETA * omega * v
        return v, np.linalg.solve(inertia, (force + load(sin, cos) @ slope)[..., None])[..., 0]

    def load(sin, cos):
        """Moment of the contact on the shaft, over its length, at S."""
        gap = normal[0] * (cos @ TOUCHING.T - LENGTH) + normal[1] * (sin @ TOUCHING.T)
        pressed = np.maximum(-gap, 0) * STIFFNESS * contact[:, None]
        return (pressed @ TOUCHING) * (-normal[0] * sin + normal[1] * cos)

    q = np.zeros((len(push), count))
    v = np.zeros_like(q)
    every, out = round(5e-4 / step_s), []
    for n in range(round(PUSH_S / step_s)):
        t, h = n * step_s, step_s
        q1, v1 = rates(t, q, v)
        q2, v2 = rates(t + h / 2, q + h / 2 * q1, v + h / 2 * v1)
        q3, v3 = rates(t + h / 2, q + h / 2 * q2, v + h / 2 * v2)
        q4, v4 = rates(t + h, q + h * q3, v + h * v3)
        q, v = q + h / 6 * (q1 + 2 * q2 + 2 * q3 + q4), v + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
        if (n + 1) % every == 0:
            angle = motor(t + h, push)[0][:, None] + q @ slope.T
            out.append(-FOLLICLE * (q @ base + load(np.sin(angle), np.cos(angle)) @ at_once))
    return np.array(out).T
