"""Models: the same bytes as host-sim's, from arrays of any kind."""

import numpy as np
import pytest

import whisker

TEXTURES = whisker.SCENES["textures"]
SHIPPED = (TEXTURES.parent / "models" / "textures.model").read_bytes()


@pytest.fixture(scope="module")
def heard():
    return whisker.record(TEXTURES, seed=3)


def test_a_model_has_the_bytes_that_the_board_runs(heard):
    model = whisker.train(heard, expect="same")
    assert bytes(model) == SHIPPED
    assert model.classes == ["smooth", "p600", "p240", "carpet"]
    assert bytes(whisker.Model(SHIPPED)) == SHIPPED
    calibration = model.calibration
    assert np.all(calibration["low"] <= calibration["high"])
    assert whisker.Model(SHIPPED).calibration is None


def test_any_columns_do(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    renamed = {"u": columns.pop("x"), "v": columns.pop("y"), **columns}
    assert bytes(whisker.train(renamed, channels=("u", "v"), expect="same")) == SHIPPED
    half = len(heard) // 2
    two = whisker.train({"first": heard[:half], "second": heard[half:]})
    assert bytes(two) == bytes(whisker.train([heard[:half], heard[half:]])) != SHIPPED


def test_the_papers_tables(heard):
    model = whisker.train(heard, tables="single")
    windows = whisker.classify(model, heard, window=200)
    assert set(windows["samples"]) == {200}
    with pytest.raises(ValueError, match="gap: single tables"):
        whisker.train(heard, tables="single", gap=0.1)


def test_a_model_is_worth_something_and_a_placebo_nothing(heard):
    model = whisker.train(heard)
    other = whisker.record(TEXTURES, seed=4)
    found = whisker.evaluate(model, other)
    assert found.hits > 0.9
    decisions = whisker.classify(model, other)
    right = decisions["decision"] == decisions["label"]
    named = decisions["decision"] != "unknown"
    assert found.found.of == named.sum()
    assert found.found.share == pytest.approx(right[named].mean())
    # The same under other labels.
    names = {name: model.classes[n - 1] for n, name in enumerate(model.classes)}
    placebo = other.copy()
    placebo["label"] = [names[label] for label in other["label"]]
    assert whisker.evaluate(model, placebo).hits < 0.1


def test_a_model_decides_in_a_scene(heard):
    model = whisker.train(heard, expect="same")
    own, given = whisker.Sim(TEXTURES), whisker.Sim(TEXTURES, model=model)
    assert own.trace_csv() == given.trace_csv()
    bench = whisker.Sim(whisker.SCENES["bench"], model=bytes(model))
    assert bench.classes == model.classes


def test_what_is_wrong_is_said(heard):
    with pytest.raises(ValueError, match="no column 'x'"):
        whisker.train({"label": heard["label"], "trial": heard["trial"], "y": heard["y"]})
    broken = heard.copy()
    broken["x"][5] = np.nan
    with pytest.raises(ValueError, match="row 5: x or y"):
        whisker.train(broken)
    with pytest.raises(ValueError, match="threshold"):
        whisker.classify(SHIPPED, heard, threshold=1.5)
    with pytest.raises(ValueError, match="model: "):
        whisker.classify(b"", heard)
    with pytest.raises(ValueError, match="gate: found 2"):
        whisker.train(heard, gate=2.0)


def test_labels_are_text_and_none_is_missing(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    of_bytes = {**columns, "label": np.char.encode(columns["label"])}
    assert whisker.train(of_bytes).classes == ["smooth", "p600", "p240", "carpet"]
    for missing in (None, float("nan")):
        label = columns["label"].astype(object)
        label[7] = missing
        with pytest.raises(ValueError, match="row 7: the label is missing"):
            whisker.train({**columns, "label": label})


def test_a_label_cannot_forge_a_line(heard):
    label = heard["label"].astype(object)
    label[label == "smooth"] = "a\nok stop"
    columns = {name: heard[name] for name in heard.dtype.names}
    with pytest.raises(ValueError, match="label .* has the character"):
        whisker.train({**columns, "label": label})
