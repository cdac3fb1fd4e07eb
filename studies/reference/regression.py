# Writes tests/reference/regression_2.csv and _4.csv: examples of three features,
# a noisy target, and what NumPy's least squares over all products of powers up
# to the degree gives for each.
#
#     python3 fit/regression.py
import itertools
import pathlib

import numpy

here = pathlib.Path(__file__).parent.parent / "tests" / "reference"
for degree, rows in (2, 40), (4, 90):
    random = numpy.random.default_rng(degree)
    x = random.uniform(-1, 1, (rows, 3)).round(6)
    target = (1 + x[:, 0] - 2 * x[:, 1] * x[:, 2] + random.normal(0, 0.3, rows)).round(6)
    powers = [p for p in itertools.product(range(degree + 1), repeat=3) if sum(p) <= degree]
    design = numpy.array([[numpy.prod(row**p) for p in powers] for row in x])
    fitted = design @ numpy.linalg.lstsq(design, target, rcond=None)[0]
    table = numpy.column_stack([x * [1, 1000, 0.001] + [0, 50, 2], target, fitted])
    with open(here / f"regression_{degree}.csv", "w") as out:
        for row in table:
            out.write(",".join(repr(float(v)) for v in row) + "\n")
