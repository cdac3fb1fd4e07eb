from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, Union, final

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Self

__all__ = [
    "Envs",
    "Model",
    "Problem",
    "SceneError",
    "Sim",
    "classify",
    "columns",
    "evaluate",
    "press",
    "record",
    "restored_envs",
    "restored_sim",
    "run_many",
    "train",
]

_Scene = str | PathLike[str] | Mapping[str, Any]
_Model = Union[Model, bytes, str, PathLike[str]]

class SceneError(ValueError):
    problems: list[Problem]

@final
class Problem:
    def __new__(
        cls, file: str, line: int | None, key: str, found: str, allowed: str
    ) -> Self: ...
    file: str
    line: int | None
    key: str
    found: str
    allowed: str

@final
class Model:
    def __new__(cls, source: _Model) -> Self: ...
    def __bytes__(self) -> bytes: ...
    def save(self, path: str | PathLike[str]) -> None: ...
    @property
    def classes(self) -> list[str]: ...
    @property
    def calibration(self) -> NDArray[np.void] | None: ...

@final
class Sim:
    def __new__(
        cls,
        scene: _Scene,
        *,
        seed: int | None = None,
        model: _Model | None = None,
        set: Mapping[str, Any] | None = None,
    ) -> Self: ...
    def step(self, n: int = 1, *, every: int = 1) -> NDArray[np.void]: ...
    def run(self, *, every: int = 1) -> NDArray[np.void]: ...
    def reset(self, seed: int | None = None) -> None: ...
    def setpoint(self, degrees: float | None, whisker: int = 0) -> None: ...
    def gain(self, gain: float, whisker: int = 0) -> None: ...
    def lay(self, texture: str) -> None: ...
    def shaft(self, whisker: int = 0) -> NDArray[np.float64]: ...
    def touch_at(self, whisker: int = 0) -> tuple[float, float] | None: ...
    def trace_csv(self) -> bytes: ...
    @property
    def decisions(self) -> NDArray[np.void]: ...
    @property
    def posteriors(self) -> NDArray[np.void]: ...
    @property
    def classes(self) -> list[str]: ...
    @property
    def name(self) -> str: ...
    @property
    def tick_hz(self) -> int: ...
    @property
    def seed(self) -> int: ...
    @property
    def ticks(self) -> int: ...
    @property
    def done(self) -> int: ...

@final
class Envs:
    def __new__(
        cls,
        scene: _Scene,
        count: int,
        *,
        action: str = "setpoint",
        ticks: int = 1,
        model: _Model | None = None,
        set: Mapping[str, Any] | None = None,
    ) -> Self: ...
    def step(
        self, actions: NDArray[np.float64], begin: NDArray[np.bool_], seeds: NDArray[np.uint64]
    ) -> tuple[NDArray[np.float32], NDArray[np.bool_]]: ...
    def restart(
        self, begin: NDArray[np.bool_], seeds: NDArray[np.uint64]
    ) -> NDArray[np.float32]: ...
    @property
    def whiskers(self) -> int: ...
    @property
    def limits(self) -> list[float]: ...

_Recipe = tuple[str, str, list[tuple[str, str]], bytes | None]

def restored_envs(
    recipe: _Recipe, action: str, ticks: int, did: list[tuple[int, list[float]]]
) -> Envs: ...
def restored_sim(
    recipe: _Recipe, seed: int, calls: list[tuple[int, int, int, float]], done: int
) -> Sim: ...
def columns(table: str) -> dict[str, tuple[str, str]]: ...
def press(
    shaft: str | dict[str, float],
    *,
    push_deg: float | Iterable[float],
    slant_deg: float = 30.0,
    tilt_deg: float = 0.0,
    friction: float = 0.0,
) -> NDArray[np.void]: ...
def record(
    scene: _Scene, *, seed: int | None = None, set: Mapping[str, Any] | None = None
) -> NDArray[np.void]: ...
def run_many(
    scene: _Scene,
    seeds: Iterable[int],
    *,
    every: int = 20,
    model: _Model | None = None,
    set: Mapping[str, Any] | None = None,
) -> tuple[NDArray[np.void], NDArray[np.void]]: ...
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
) -> Model: ...
def classify(
    model: _Model,
    data: Any,
    *,
    channels: tuple[str, str],
    threshold: float,
    window: int | None,
) -> NDArray[np.void]: ...
def evaluate(
    model: _Model, data: Any, *, channels: tuple[str, str], threshold: float
) -> dict[str, Any]: ...
