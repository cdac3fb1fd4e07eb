"""Simulator and classifier of an active artificial whisker.

Names, units and shapes are those of the files that ``host-sim`` writes; ``columns("trace")``
returns them.

>>> import vibrissa
>>> sim = vibrissa.Sim("textures", seed=7)
>>> rows = sim.run(every=20)
>>> sim.decisions["decision"][0] in sim.classes + ["unknown"]
True
"""

from vibrissa._core import (
    Model,
    SceneError,
    Sim,
    __version__,
    columns,
    press,
    read,
    record,
    run_many,
)
from vibrissa._scenes import SCENES, Problem
from vibrissa.learning import Evaluation, Share, Why, classify, evaluate, train, why

__all__ = [
    "SCENES",
    "Evaluation",
    "Model",
    "Problem",
    "SceneError",
    "Share",
    "Sim",
    "Why",
    "__version__",
    "classify",
    "columns",
    "evaluate",
    "press",
    "read",
    "record",
    "run_many",
    "train",
    "why",
]
