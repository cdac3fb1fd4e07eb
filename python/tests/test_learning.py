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


def repeated(count, start=0):
    """Samples that never repeat."""
    return (np.arange(start, start + count, dtype=np.uint64) * 0x9E3779B9 >> 22) % 1024


def plain(label, trial, samples):
    """A recording of one trial."""
    count = len(samples)
    return {
        "label": np.full(count, label),
        "trial": np.full(count, trial),
        "x": samples.astype(float),
        "y": samples / 3.0,
    }


def joined(*parts):
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def usual():
    levels = {"low": 1000, "high": 9000}
    return joined(
        *(
            plain(label, trial, level + repeated(400, 1000 * trial))
            for trial in range(3)
            for label, level in levels.items()
        )
    )


def test_missing_labels_are_refused_by_row():
    for missing in [None, float("nan"), "", " "]:
        data = usual()
        data["label"] = data["label"].astype(object)
        data["label"][3] = missing
        with pytest.raises(ValueError, match="row 3: the label is"):
            whisker.train(data, tables="single")
    # NumPy makes text of it.
    data = usual() | {"label": ["low", "high", float("nan")] + ["low"] * 2397}
    with pytest.raises(ValueError, match="row 2: the label is missing"):
        whisker.train(data, tables="single")
    masked = np.ma.MaskedArray(usual()["label"], mask=np.arange(2400) == 5)
    with pytest.raises(ValueError, match="row 5: the label is missing"):
        whisker.train(usual() | {"label": masked}, tables="single")


def test_what_is_odd_is_warned_of_by_row():
    data = usual()
    whole = whisker.evaluate(whisker.train(data, tables="single"), usual())
    data["x"][7] = 1e9
    with pytest.warns(UserWarning, match="row 7: x is 1000000000, far from"):
        model = whisker.train(data, tables="single")
    assert whisker.evaluate(model, usual()).hits == whole.hits
    overlapping = joined(usual(), plain("low", 9, 1000 + repeated(400, 100)))
    with pytest.warns(UserWarning, match="trials must not overlap"):
        whisker.train(overlapping, tables="single")
    with pytest.warns(UserWarning, match="in again too"):
        whisker.train({"once": usual(), "again": usual()}, tables="single")
    order = np.random.default_rng(1).permutation(2400)
    shuffled = {name: values[order] for name, values in usual().items()}
    with pytest.warns(UserWarning, match="must follow each other"):
        with pytest.raises(ValueError, match="rows in the mean"):
            whisker.train(shuffled)


def test_each_rise_of_a_column_of_truths_begins_a_touch(heard):
    truths = {name: heard[name] for name in heard.dtype.names} | {"touch": heard["touch"] > 0}
    model = whisker.train(heard)
    told = whisker.classify(model, truths)
    assert len(set(told["touch"])) > 10
    assert np.array_equal(told["decision"], whisker.classify(model, heard)["decision"])
    broken = truths | {"touch": np.where(np.arange(len(heard)) == 9, np.nan, heard["touch"])}
    with pytest.raises(ValueError, match="row 9: touch: found"):
        whisker.classify(model, broken)


class Table(dict):
    """Columns with attributes, as a table of pandas has."""


def test_a_recording_knows_its_rate_and_another_is_refused(heard):
    slow = whisker.record(TEXTURES, set={"tick_hz": 1000, "duration_s": 8.0})
    model = whisker.train(slow, tables="single")
    assert bytes(model) == bytes(whisker.train(slow[:], tables="single", rate=1000))
    columns = {name: slow[name] for name in slow.dtype.names}
    assert bytes(whisker.train(columns, tables="single")) != bytes(model)
    table = Table(columns)
    table.attrs = {"tick_hz": 1000}
    assert bytes(whisker.train(table, tables="single")) == bytes(model)
    with pytest.raises(ValueError, match="rate: found 2000, recording: tick_hz has 1000"):
        whisker.train(slow, tables="single", rate=2000)
    both = "recording 1: tick_hz: found 2000, recording 2: tick_hz has 1000"
    with pytest.raises(ValueError, match=both):
        whisker.train([heard, slow], tables="single")


def test_a_model_of_another_rate_is_refused(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    model = whisker.train(columns, tables="single", rate=1000)
    with pytest.raises(whisker.SceneError, match="1000 samples a second"):
        whisker.Sim(whisker.SCENES["bench"], model=model)


def test_hits_say_which_classes_they_leave_out():
    model = whisker.train(usual(), tables="single")
    short = joined(plain("low", 0, 1000 + repeated(400)), plain("high", 0, 9000 + repeated(5)))
    assert whisker.evaluate(model, short).left_out == ["high"]
    assert whisker.evaluate(model, usual()).left_out == []
