#!/usr/bin/env python3
"""Outputs of two small networks by numpy, for tests/suite/mlp.rs.

Run: python3 mlp.py      (needs numpy; prints what the test holds)

Weights, scales and inputs are sines of their index, so that both sides can
make them; the order of the weights is that of Shape::weights.
"""
import numpy as np


def outputs(inputs, hidden, classes):
    count = (inputs + 1) * hidden + (hidden + 1) * classes
    weights = 1.5 * np.sin(1.0 + np.arange(count))
    w, weights = np.split(weights, [inputs * hidden])
    b, weights = np.split(weights, [hidden])
    v, c = np.split(weights, [hidden * classes])
    i = np.arange(inputs)
    offset, gain, x = np.sin(0.3 * i), 1.0 + 0.5 * np.sin(0.7 * i), 2.0 * np.sin(0.9 * i + 0.2)
    z = (x - offset) * gain

    def sigma(u):
        return 1.0 / (1.0 + np.exp(-u))

    h = sigma(b + z @ w.reshape(inputs, hidden))
    return sigma(c + v.reshape(classes, hidden) @ h)


for shape in [(3, 4, 2), (7, 5, 3)]:
    print(shape, [float(y) for y in outputs(*shape)])
