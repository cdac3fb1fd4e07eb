"""Sweeps on a process pool, on Dask or on Ray: the same script for all three.

The environment variable ``WHISKER_SWEEP`` says where: ``processes`` (if it is not set), ``dask``
(the scheduler that ``DASK_SCHEDULER_ADDRESS`` names, or workers of this machine) or ``ray`` (the
cluster that ``RAY_ADDRESS`` names, or workers of this machine). Seeds go in batches, so that a
task takes about a second, whatever the scene takes.

The latter two need ``dask[distributed]`` and ``ray``.
"""

import itertools
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np

from vibrissa._core import run_many

#: What a task should take, s.
TASK_S = 1.0

#: Rows and decisions of one run to its figures.
Measure = Callable[[np.ndarray, np.ndarray], Mapping[str, float]]
Task = tuple[Any, dict[str, Any], list[int], int, Any, Measure]


def _alone() -> None:
    # There are as many workers as cores.
    os.environ["RAYON_NUM_THREADS"] = "1"


def work(task: Task) -> list[dict[str, Any]]:
    """A batch of seeds of one setting: a row for each."""
    scene, setting, seeds, every, model, measure = task
    rows, decisions = run_many(scene, seeds, every=every, model=model, set=setting)
    of_seed = (decisions[decisions["seed"] == seed] for seed in seeds)
    return [
        {**setting, "seed": seed, **measure(of_run, decided)}
        for seed, of_run, decided in zip(seeds, rows, of_seed)
    ]


def _processes(tasks: list[Task]) -> Iterator[list[dict[str, Any]]]:
    with ProcessPoolExecutor(mp_context=get_context("spawn"), initializer=_alone) as pool:
        yield from pool.map(work, tasks)


def _dask(tasks: list[Task]) -> Iterator[list[dict[str, Any]]]:
    from dask.distributed import Client

    address = os.environ.get("DASK_SCHEDULER_ADDRESS")
    local = {} if address else {"threads_per_worker": 1, "dashboard_address": None}
    with Client(address, **local) as client:
        client.run(_alone)
        yield from client.gather(client.map(work, tasks, pure=False))


def _ray(tasks: list[Task]) -> Iterator[list[dict[str, Any]]]:
    import ray

    with ray.init(
        address=os.environ.get("RAY_ADDRESS"),
        runtime_env={"env_vars": {"RAYON_NUM_THREADS": "1"}},
        include_dashboard=False if "RAY_ADDRESS" not in os.environ else None,
    ):
        remote = ray.remote(work)
        yield from ray.get([remote.remote(task) for task in tasks])


BACKENDS = {"processes": _processes, "dask": _dask, "ray": _ray}


def sweep(
    scene: Any,
    keys: Mapping[str, Sequence[Any]],
    seeds: Iterable[int],
    measure: Measure,
    *,
    every: int = 20,
    model: Any = None,
    batch: int | None = None,
) -> list[dict[str, Any]]:
    """Every combination of the values of ``keys`` by every seed.

    ``keys`` are those of the scene, such as ``{"rcp.gain": [0.0, 0.7]}``. ``measure`` gets the rows
    and the decisions of one run, as ``run_many`` returns them, and returns its figures; it is a
    function of a module. Returns a row for each run, with its keys, its seed and its figures, the
    last key changing first: ``pandas.DataFrame(rows)`` is a table of them. ``batch`` seeds go in a
    task, by default as many as take a second.

    A script that calls it has ``if __name__ == "__main__":`` about what it does.
    """
    where = os.environ.get("WHISKER_SWEEP", "processes")
    if where not in BACKENDS:
        raise ValueError(f"WHISKER_SWEEP: found {where!r}, allowed: {', '.join(BACKENDS)}")
    seeds = list(seeds)
    if len(set(seeds)) < len(seeds):
        raise ValueError("seeds: found one twice, allowed: each once")
    if "seed" in keys:
        raise ValueError("keys: found seed, which has a column of its own; allowed: seeds")
    for key, values in keys.items():
        if len(set(map(str, values))) < len(values):
            raise ValueError(f"keys: {key} has a value twice, allowed: each once")
    if batch is not None and batch < 1:
        raise ValueError(f"batch: found {batch}, allowed: above 0")
    settings = [dict(zip(keys, values)) for values in itertools.product(*keys.values())]
    if not seeds or not settings:
        return []
    if batch is None:
        begun = time.perf_counter()
        # Tells, too, what is wrong with the scene before workers are started.
        run_many(scene, seeds[:1], every=every, model=model, set=settings[0])
        batch = max(1, round(TASK_S / (time.perf_counter() - begun)))
    batches = [seeds[n : n + batch] for n in range(0, len(seeds), batch)]
    tasks = [
        (scene, setting, part, every, model, measure)
        for setting, part in itertools.product(settings, batches)
    ]
    return list(itertools.chain.from_iterable(BACKENDS[where](tasks)))
