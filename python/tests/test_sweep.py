"""Sweeps: the same rows wherever they run."""

import importlib.util
import math
import os
from pathlib import Path

import numpy as np
import pytest

import vibrissa
from vibrissa.sweep import sweep

KEYS = {"rcp.gain": [0.0, 0.7]}


def figures(rows, decisions):
    return {"deepest": float(rows["contact_left"].max()), "decisions": len(decisions)}


def swept(monkeypatch, where):
    monkeypatch.setenv("WHISKER_SWEEP", where)
    # Workers find this module by its name.
    here = str(Path(__file__).parent)
    paths = [here, *filter(None, [os.environ.get("PYTHONPATH")])]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))
    monkeypatch.syspath_prepend(here)
    scene = str(vibrissa.SCENES["textures"])
    return sweep(scene, {**KEYS, "duration_s": [5.0]}, range(4), figures, batch=3)


@pytest.mark.parametrize("where", ["processes", "dask", "ray"])
def test_rows_are_those_of_single_runs(monkeypatch, where):
    if where != "processes" and importlib.util.find_spec(where) is None:
        assert "WHISKER_WHOLE" not in os.environ, f"{where} is not installed"
        pytest.skip(f"{where} is not installed")
    rows = swept(monkeypatch, where)
    assert [(row["rcp.gain"], row["seed"]) for row in rows] == [
        (gain, seed) for gain in (0.0, 0.7) for seed in range(4)
    ]
    for row in rows[::3]:
        sim = vibrissa.Sim(
            vibrissa.SCENES["textures"],
            seed=row["seed"],
            set={"rcp.gain": row["rcp.gain"], "duration_s": 5.0},
        )
        assert math.isclose(row["deepest"], sim.run(every=20)["contact_left"].max())
        assert row["decisions"] == len(sim.decisions)
    # RCP keeps a touch gentle.
    deepest = np.array([row["deepest"] for row in rows])
    assert deepest[4:].mean() < deepest[:4].mean()


def test_a_model_and_what_is_wrong_come_through(monkeypatch):
    monkeypatch.setenv("WHISKER_SWEEP", "processes")
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    scene = vibrissa.SCENES["textures"]
    model = vibrissa.Model(scene.parent / "models" / "textures.model")
    keys = {"duration_s": [2.0]}
    assert sweep(scene, keys, [1], figures, model=model) == sweep(scene, keys, [1], figures)
    with pytest.raises(vibrissa.SceneError, match="rcp.gain: found -1"):
        sweep(scene, {"rcp.gain": [0.7, -1.0]}, [1], figures, batch=1)


def test_an_unknown_place_is_refused(monkeypatch):
    monkeypatch.setenv("WHISKER_SWEEP", "abacus")
    with pytest.raises(ValueError, match="allowed: processes, dask, ray"):
        sweep(vibrissa.SCENES["textures"], KEYS, [1], figures)


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ({"seeds": [1, 1]}, "seeds: found one twice"),
        ({"keys": {"seed": [5]}}, "keys: found seed"),
        ({"keys": {"rcp.gain": [0.5, 0.5]}}, "rcp.gain has a value twice"),
        ({"batch": 0}, "batch: found 0"),
    ],
)
def test_what_would_mix_its_rows_is_refused(asked, says):
    wanted = {"keys": {"duration_s": [0.1]}, "seeds": [1, 2]} | asked
    with pytest.raises(ValueError, match=says):
        sweep("textures", wanted.pop("keys"), wanted.pop("seeds"), len, **wanted)
