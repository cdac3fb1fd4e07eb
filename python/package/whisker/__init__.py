"""Simulator and classifier of an active artificial whisker.

Names, units and shapes are those of the files that ``host-sim`` writes; ``columns("trace")``
tells them.

>>> import whisker
>>> sim = whisker.Sim(whisker.SCENES["textures"], seed=7)
>>> rows = sim.run(every=20)
>>> sim.decisions["decision"][0] in sim.classes + ["unknown"]
True
"""

from pathlib import Path

from whisker._core import Model, Problem, SceneError, Sim, columns, press, record, run_many
from whisker.learning import Evaluation, Why, classify, evaluate, train, why

#: The scenes of the project by their names, with their models beside them.
SCENES: dict[str, Path] = {
    path.stem: path for path in sorted((Path(__file__).parent / "scenes").glob("*.toml"))
}

__all__ = [
    "SCENES",
    "Evaluation",
    "Model",
    "Problem",
    "SceneError",
    "Sim",
    "Why",
    "classify",
    "columns",
    "evaluate",
    "press",
    "record",
    "run_many",
    "train",
    "why",
]
