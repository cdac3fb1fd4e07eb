"""How stiff the obstacle and how strong the retreat are: what decisions are worth.

python sweep_stiffness.py                       # processes of this machine
WHISKER_SWEEP=dask python sweep_stiffness.py    # Dask
WHISKER_SWEEP=ray python sweep_stiffness.py     # Ray
"""

import sys

import numpy as np

from vibrissa import SCENES
from vibrissa.sweep import sweep

KEYS = {"rcp.gain": [0.0, 0.7], "plant.stiffness": [0.05, 0.1]}


def figures(rows: np.ndarray, decisions: np.ndarray) -> dict[str, float]:
    """Of one run."""
    named = decisions[decisions["decision"] != "unknown"]
    return {
        "right": float(np.mean(named["decision"] == named["label"])) if len(named) else np.nan,
        "deepest_contact": float(rows["contact_left"].max()),
    }


def main(seeds: int) -> list[dict]:
    rows = sweep(SCENES["textures"], KEYS, range(1000, 1000 + seeds), figures)
    for n in range(0, len(rows), seeds):
        of_setting = rows[n : n + seeds]
        setting = " ".join(f"{key}={of_setting[0][key]}" for key in KEYS)
        right = np.array([row["right"] for row in of_setting])
        count = np.isfinite(right).sum()
        error = np.nanstd(right, ddof=1) / np.sqrt(count) if count > 1 else np.nan
        print(f"{setting}: right {np.nanmean(right):.3f} ± {error:.3f}")
    return rows


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
