"""Whiskers that whip onto a plate which lies nearly along them: more than one place touches.

    OPENBLAS_NUM_THREADS=1 python tests/truth/whip.py > tests/truth/whip.csv

BIOTACT's middle whisker is swung once, as a cosine, from 2 degrees before a hard, frictionless
plate to 20 or 30 beyond first touch and back, at 8 or 16 Hz; a row is the moment at the base at the
end of each 0.5 ms. The truth is MuJoCo's chain of 40 links (`chain.py`), with spheres on all of it,
a step of 2 us and exact damping. The same of 24 links differs by at most 0.7 % of the peak (rms).
Two minutes; numpy, scipy, MuJoCo 4.
"""
import sys

import chain
import numpy as np
import rod

# Slant, push, degrees; seconds.
MOTIONS = ((3, 30, 1 / 16), (5, 20, 1 / 8), (20, 30, 1 / 16), (0, 20, 1 / 8))


def moments(slant_deg, push_deg, push_s, links):
    rod.SLANT, rod.PUSH_S = np.radians(slant_deg), push_s
    chain.TOUCHES = 0.02
    model = chain.model_of(links, 1, 2e-6, "Euler", True, links)
    return chain.run(model, push_deg)[0]


if __name__ == "__main__":
    print("slant_deg,push_deg,push_s,time_s,moment_nm")
    for motion in MOTIONS:
        true, coarse = (moments(*motion, links) for links in (40, 24))
        apart = np.sqrt(np.mean((coarse - true) ** 2)) / np.max(np.abs(true))
        print(f"{motion}: 24 links are {100 * apart:.1f} % apart", file=sys.stderr)
        for n, moment in enumerate(true):
            print(",".join(f"{value:.6g}" for value in (*motion, (n + 1) * 5e-4, moment)))
