from collections.abc import Iterable
from os import PathLike
from typing import Any, Union, final

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Self

from vibrissa._scenes import Problem

__version__: str

__all__ = [
    "Envs",
    "Model",
    "SceneError",
    "Sim",
    "__version__",
    "classify",
    "columns",
    "evaluate",
    "is_model",
    "press",
    "read",
    "record",
    "restored_envs",
    "restored_sim",
    "run_many",
    "train",
]

_Scene = str | PathLike[str] | dict[str, Any]
_Model = Union[Model, bytes, str, PathLike[str]]

class SceneError(ValueError):
    """What is wrong with a scene, one problem a line; `problems` has them singly."""

    problems: list[Problem]

@final
class Model:
    """A model, of its bytes or its file; `train` makes one. `bytes(model)` are what a board runs."""

    def __new__(cls, source: _Model) -> Self: ...
    def __bytes__(self) -> bytes: ...
    def save(self, path: str | PathLike[str]) -> None:
        """Writes the bytes to a file."""
    @property
    def classes(self) -> list[str]:
        """The names of its classes."""
    @property
    def calibration(self) -> NDArray[np.void] | None:
        """Of trials that were held out, at each threshold: the probability that decisions stated,
        the share that was found right with its 95 % interval, mean samples, and the shares of
        decisions for unknown and of trials without one. None of a model that was not just
        trained, or of single tables.
        """

@final
class Sim:
    """A scene in motion: the firmware's module on simulated sensors, motors and surfaces.

    `scene` is a name of SCENES or of `scenes/NAME.toml` here, a path, TOML text or a dictionary of
    the same keys; `seed` and the keys of `set` (such as {"plant.stiffness": 0.2}) take the place
    of the scene's own. `model` is a Model, its bytes or a path, in place of the one that the scene
    names.

    Raises SceneError for a scene that is wrong.
    """

    def __new__(
        cls,
        scene: _Scene,
        *,
        seed: int | None = None,
        model: _Model | None = None,
        set: dict[str, Any] | None = None,
    ) -> Self: ...
    def step(self, n: int = 1, *, every: int = 1) -> NDArray[np.void]:
        """Advances by `n` ticks, beyond the scene's end too, and returns every `every`th row of
        the trace as a structured array.
        """
    def run(self, *, every: int = 1) -> NDArray[np.void]:
        """Advances to the scene's end and returns every `every`th row of the trace."""
    def reset(self, seed: int | None = None) -> None:
        """Starts again, with another seed if one is given: from here on all is as of a new Sim.
        Setpoints and gains that were set are undone.
        """
    def setpoint(self, degrees: float | None, whisker: int = 0) -> None:
        """Sets θ′ of a whisker, degrees, from the next tick on, within the scene's
        `motor.min_deg` and `motor.max_deg`; None: the pattern generator's again. Whiskers are
        counted from 0, left side first.
        """
    def gain(self, gain: float, whisker: int = 0) -> None:
        """Sets the nominal gain g of a whisker from the next tick on, 0 to 2."""
    def lay(self, texture: str) -> None:
        """Has a texture laid in place of the present one, once that is not touched, and left there."""
    def shaft(self, whisker: int = 0) -> NDArray[np.float64]:
        """Points of a whisker's shaft as it is bent now, from base to tip, m: an array of shape
        (13, 3) with the columns x (against protraction), y (across it) and z (along the shaft as
        it is without a bend). Only with `plant.kind = "whisker"`.
        """
    def touch_at(self, whisker: int = 0) -> tuple[float, float] | None:
        """Where a whisker touches now: arc length from the base and place on the surface, m, as the
        trace has them of the first whiskers; None in the air.
        """
    def touches_at(self, whisker: int = 0) -> list[tuple[float, float]]:
        """All places in which a whisker touches now, as `touch_at` has them: none, one or two. The
        second is where the rest of the shaft whips onto a plate that lies nearly along it.
        """
    def trace_csv(self) -> bytes:
        """`trace.csv` from here to the scene's end, byte for byte as host-sim writes it."""
    @property
    def decisions(self) -> NDArray[np.void]:
        """The decisions since the start, with the columns of `decisions.csv`."""
    @property
    def posteriors(self) -> NDArray[np.void]:
        """`t_s` and, under the name of each of `classes` (of one called t_s: `t_s_`), its posterior: a
        row whenever a block has changed them, of the first whisker or of all together.
        """
    @property
    def classes(self) -> list[str]:
        """The names of the classes that are decided among."""
    @property
    def name(self) -> str:
        """The scene's name."""
    @property
    def tick_hz(self) -> int:
        """Ticks a second."""
    @property
    def seed(self) -> int:
        """The seed of this run."""
    @property
    def ticks(self) -> int:
        """How many ticks the scene lasts."""
    @property
    def ticks_done(self) -> int:
        """How many ticks have passed."""
    @property
    def done(self) -> bool:
        """Whether the scene has ended: `while not sim.done: sim.step(100)`. It can still be stepped."""

@final
class Envs:
    """`count` runs of a scene side by side, stepped on all cores; an action is a setpoint in degrees
    or a gain for each whisker, held for `ticks` ticks.
    """

    def __new__(
        cls,
        scene: _Scene,
        count: int,
        *,
        action: str = "setpoint",
        ticks: int = 1,
        model: _Model | None = None,
        set: dict[str, Any] | None = None,
    ) -> Self: ...
    def step(
        self,
        actions: NDArray[np.float64] | None,
        begin: NDArray[np.bool_],
        seeds: NDArray[np.uint64],
    ) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
        """Restarts those that `begin` names, with their `seeds`; the others act, `actions` having
        the shape (envs, whiskers), or stay as they are where there are none. Returns what each
        whisker then feels, of shape (envs, 4 × whiskers), and whether the scene has ended.
        """
    @property
    def whiskers(self) -> int:
        """How many whiskers each has."""
    @property
    def whiskers_per_side(self) -> int:
        """How many whiskers a side has."""
    @property
    def rate_hz(self) -> float:
        """Actions a second."""
    @property
    def limits(self) -> list[float]:
        """The least and the largest action."""

_Recipe = tuple[str, str, list[tuple[str, str]], bytes | None]

def restored_envs(
    parts: _Recipe, action: str, ticks: int, did: list[tuple[int, list[float]]]
) -> Envs:
    """Environments as others were that were made from `parts`."""
def restored_sim(
    parts: _Recipe, seed: int, calls: list[tuple[int, int, int, float]], done: int
) -> Sim:
    """A simulation as another one was that was made from `parts` with `seed`, `calls` being what was
    done to it in `done` ticks.
    """
def columns(table: str) -> dict[str, tuple[str, str]]:
    """Name to (unit, meaning) of every column: of "trace", "decisions", "recording" or "press". Those of
    further whiskers of a side have their place for the `*`.
    """
def is_model(source: Any) -> bool:
    """Whether it is a model, bytes that should be one, or a file of one, and no recording."""
def press(
    shaft: str | dict[str, float],
    *,
    push_deg: float | Iterable[float],
    slant_deg: float = 30.0,
    tilt_deg: float = 0.0,
    friction: float = 0.0,
) -> NDArray[np.void]:
    """How a tapered whisker bends that is pressed slowly against a plate, solved exactly: a row a
    push, with the columns of `columns("press")`.

    `shaft` is a name, as scenes have it, or a dictionary of `length_m`, `hub_m` (the diameter at
    the base), `taper` (that over the diameter at the tip), `youngs_pa` and `follicle_nm_rad`.
    `push_deg` is one angle of the motor beyond first touch, or several. What is wrong raises a
    `ValueError` with its range; a push that does not hold, with the largest that does.
    """
def read(
    path: str | PathLike[str], *, channels: tuple[str, str] = ("x", "y")
) -> NDArray[np.void]:
    """Reads a recording's file, as `host-sim record` and `whisker capture` write it: its rows, as
    `record` returns them, with the columns that the file has, and with its rate. `channels` are the columns that are read as the two channels.
    """
def record(
    scene: _Scene, *, seed: int | None = None, set: dict[str, Any] | None = None
) -> NDArray[np.void]:
    """Runs a scene and returns what its whiskers feel that are heard, the air included: a recording
    to train on. The scene's classifier is not used. Its type knows the rate,
    `dtype.metadata["tick_hz"]`, which train goes by.
    """
def run_many(
    scene: _Scene,
    seeds: Iterable[int],
    *,
    every: int = 20,
    model: _Model | None = None,
    set: dict[str, Any] | None = None,
) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Runs a scene once for each seed, on all cores. `rows` is a structured array of shape
    (seeds, rows) with every `every`th row of each trace (0: none); `decisions` has those of all
    runs, with the seed before the columns of `decisions.csv`. Scene, model and set are as for
    Sim.
    """
def train(
    data: list[Any],
    *,
    channels: tuple[str, str],
    tables: str,
    bins: int | None,
    smooth: float | None,
    block: int | None,
    gate: float | None,
    gap: float | None,
    expect: str,
    rate: int,
) -> Model:
    """Trains a model from recordings that the Python side has prepared."""
def classify(
    model: _Model,
    data: Any,
    *,
    channels: tuple[str, str],
    threshold: float,
    window: int | None,
    rate: int | None,
) -> NDArray[np.void]:
    """The decisions of a model on a recording that the Python side has prepared."""
def evaluate(
    model: _Model,
    data: list[Any],
    *,
    channels: tuple[str, str],
    threshold: float,
    rate: int | None,
) -> dict[str, Any]:
    """What a model is worth on recordings that the Python side has prepared, which puts it into arrays."""
