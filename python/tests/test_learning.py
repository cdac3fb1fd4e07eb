"""Models: the same bytes as host-sim's, from arrays of any kind."""

import csv

import numpy as np
import pytest

import vibrissa

TEXTURES = vibrissa.SCENES["textures"]
SHIPPED = (TEXTURES.parent / "models" / "textures.model").read_bytes()


@pytest.fixture(scope="module")
def heard():
    return vibrissa.record(TEXTURES, seed=3)


def test_a_model_has_the_bytes_that_the_board_runs(heard):
    model = vibrissa.train(heard, expect="same")
    assert bytes(model) == SHIPPED
    assert model.classes == ["smooth", "p600", "p240", "carpet"]
    assert bytes(vibrissa.Model(SHIPPED)) == SHIPPED
    calibration = model.calibration
    assert np.all(calibration["low"] <= calibration["high"])
    assert vibrissa.Model(SHIPPED).calibration is None


def test_any_columns_do(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    renamed = {"u": columns.pop("x"), "v": columns.pop("y"), **columns}
    assert bytes(vibrissa.train(renamed, channels=("u", "v"), expect="same")) == SHIPPED
    half = len(heard) // 2
    two = vibrissa.train({"first": heard[:half], "second": heard[half:]})
    assert bytes(two) == bytes(vibrissa.train([heard[:half], heard[half:]])) != SHIPPED


def test_the_papers_tables(heard):
    model = vibrissa.train(heard, tables="single")
    windows = vibrissa.classify(model, heard, window=200)
    assert set(windows["samples"]) == {200}
    with pytest.raises(ValueError, match="gap: single tables"):
        vibrissa.train(heard, tables="single", gap=0.1)


def test_a_model_is_worth_something_and_a_placebo_nothing(heard):
    model = vibrissa.train(heard)
    other = vibrissa.record(TEXTURES, seed=4)
    found = vibrissa.evaluate(model, other)
    assert found.hits > 0.9
    decisions = vibrissa.classify(model, other)
    right = decisions["decision"] == decisions["label"]
    named = decisions["decision"] != "unknown"
    assert found.found.of == named.sum()
    assert found.found.share == pytest.approx(right[named].mean())
    # The same under other labels.
    names = {name: model.classes[n - 1] for n, name in enumerate(model.classes)}
    placebo = other.copy()
    placebo["label"] = [names[label] for label in other["label"]]
    assert vibrissa.evaluate(model, placebo).hits < 0.1


def test_a_model_decides_in_a_scene(heard):
    model = vibrissa.train(heard, expect="same")
    own, given = vibrissa.Sim(TEXTURES), vibrissa.Sim(TEXTURES, model=model)
    assert own.trace_csv() == given.trace_csv()
    bench = vibrissa.Sim(vibrissa.SCENES["bench"], model=bytes(model))
    assert bench.classes == model.classes


def test_what_is_wrong_is_said(heard):
    with pytest.raises(ValueError, match="no column 'x'"):
        vibrissa.train({"label": heard["label"], "trial": heard["trial"], "y": heard["y"]})
    broken = heard.copy()
    broken["x"][5] = np.nan
    with pytest.raises(ValueError, match="row 5: x or y"):
        vibrissa.train(broken)
    with pytest.raises(ValueError, match="threshold"):
        vibrissa.classify(SHIPPED, heard, threshold=1.5)
    with pytest.raises(ValueError, match="model: "):
        vibrissa.classify(b"", heard)
    with pytest.raises(ValueError, match="gate: found 2"):
        vibrissa.train(heard, gate=2.0)


def test_a_negative_number_is_refused_by_name(heard):
    sim = vibrissa.Sim("textures")
    for name, call in {
        "seed": lambda: vibrissa.Sim("textures", seed=-1),
        "n": lambda: sim.step(-1),
        "whisker": lambda: sim.shaft(-1),
        "seeds": lambda: vibrissa.run_many("textures", [1, -1]),
        "bins": lambda: vibrissa.train(heard, bins=-1),
        "window": lambda: vibrissa.classify(SHIPPED, heard, window=-1),
        "count": lambda: vibrissa._core.Envs("textures", -1),
    }.items():
        with pytest.raises(ValueError, match=f"^{name}: found -1, allowed: 0 to"):
            call()


def test_posteriors_of_a_class_that_is_called_as_their_time(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    label = np.where(heard["label"] == "smooth", "t_s", heard["label"])
    model = vibrissa.train({**columns, "label": label}, expect="same", rate=2000)
    sim = vibrissa.Sim("textures", model=model)
    assert list(sim.posteriors.dtype.names) == ["t_s", "t_s_", "p600", "p240", "carpet"]


def test_labels_may_be_bytes(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    of_bytes = {**columns, "label": np.char.encode(columns["label"])}
    assert vibrissa.train(of_bytes).classes == ["smooth", "p600", "p240", "carpet"]


def test_a_label_cannot_forge_a_line(heard):
    label = heard["label"].astype(object)
    label[label == "smooth"] = "a\nok stop"
    columns = {name: heard[name] for name in heard.dtype.names}
    with pytest.raises(ValueError, match="label .* has the character"):
        vibrissa.train({**columns, "label": label})


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
            vibrissa.train(data, tables="single")
    # NumPy makes text of it.
    data = usual() | {"label": ["low", "high", float("nan")] + ["low"] * 2397}
    with pytest.raises(ValueError, match="row 2: the label is missing"):
        vibrissa.train(data, tables="single")
    masked = np.ma.MaskedArray(usual()["label"], mask=np.arange(2400) == 5)
    with pytest.raises(ValueError, match="row 5: the label is missing"):
        vibrissa.train(usual() | {"label": masked}, tables="single")


def test_what_is_odd_is_warned_of_by_row():
    data = usual()
    whole = vibrissa.evaluate(vibrissa.train(data, tables="single"), usual())
    data["x"][7] = 1e9
    with pytest.warns(UserWarning, match="row 7: x is 1000000000, far from"):
        model = vibrissa.train(data, tables="single")
    assert vibrissa.evaluate(model, usual()).hits == whole.hits
    other = usual() | {"x": 3.0 * usual()["x"] + 50000.0}
    for judge in (vibrissa.evaluate, vibrissa.classify):
        with pytest.warns(UserWarning, match="row 0: x is .* 100 % of samples lie outside"):
            judge(model, other)
    overlapping = joined(usual(), plain("low", 9, 1000 + repeated(400, 100)))
    with pytest.warns(UserWarning, match="trials must not overlap"):
        vibrissa.train(overlapping, tables="single")
    with pytest.warns(UserWarning, match="in again too"):
        vibrissa.train({"once": usual(), "again": usual()}, tables="single")
    order = np.random.default_rng(1).permutation(2400)
    shuffled = {name: values[order] for name, values in usual().items()}
    with pytest.warns(UserWarning, match="must follow each other"):
        with pytest.raises(ValueError, match="rows in the mean"):
            vibrissa.train(shuffled)


def test_each_rise_of_a_column_of_truths_begins_a_touch(heard):
    truths = {name: heard[name] for name in heard.dtype.names} | {"touch": heard["touch"] > 0}
    model = vibrissa.train(heard)
    numbered = vibrissa.classify(model, truths)
    assert len(set(numbered["touch"])) > 10
    assert np.array_equal(numbered["decision"], vibrissa.classify(model, heard)["decision"])
    broken = truths | {"touch": np.where(np.arange(len(heard)) == 9, np.nan, heard["touch"])}
    with pytest.raises(ValueError, match="row 9: touch: found"):
        vibrissa.classify(model, broken)


def test_trials_of_one_number_in_two_poses_are_two(heard):
    pose = np.where(np.arange(len(heard)) % 2000 < 1000, "near", "far")
    apart = {name: heard[name] for name in heard.dtype.names} | {"pose": pose}
    named = apart | {"trial": np.char.add(heard["trial"].astype(str), pose)}
    models = [bytes(vibrissa.train(columns)) for columns in (apart, named)]
    assert models[0] == models[1]
    without = {name: heard[name] for name in heard.dtype.names}
    assert models[0] != bytes(vibrissa.train(without))


class Table(dict):
    """Columns with attributes, as a table of pandas has."""


def test_a_recording_knows_its_rate_and_another_is_refused(heard):
    slow = vibrissa.record(TEXTURES, set={"tick_hz": 1000, "duration_s": 8.0})
    model = vibrissa.train(slow, tables="single")
    assert bytes(model) == bytes(vibrissa.train(slow[:], tables="single", rate=1000))
    columns = {name: slow[name] for name in slow.dtype.names}
    assert bytes(vibrissa.train(columns, tables="single")) != bytes(model)
    table = Table(columns)
    table.attrs = {"tick_hz": 1000}
    assert bytes(vibrissa.train(table, tables="single")) == bytes(model)
    with pytest.raises(ValueError, match="rate: found 2000, recording: tick_hz has 1000"):
        vibrissa.train(slow, tables="single", rate=2000)
    with pytest.raises(ValueError, match="rate: found 0, allowed: above 0"):
        vibrissa.train(columns, rate=0)
    both = "recording 1: tick_hz: found 2000, recording 2: tick_hz has 1000"
    with pytest.raises(ValueError, match=both):
        vibrissa.train([heard, slow], tables="single")


def test_a_recording_of_another_rate_is_not_judged(heard):
    model = vibrissa.train(heard)
    slow = vibrissa.record(TEXTURES, set={"tick_hz": 1000, "duration_s": 4.0})
    for judge in (vibrissa.classify, vibrissa.evaluate):
        with pytest.raises(ValueError, match="model: found 2000, the recording: tick_hz has 1000"):
            judge(model, slow)
    silent = {name: heard[name] for name in heard.dtype.names}
    with pytest.raises(ValueError, match="recording 2: tick_hz is not said"):
        vibrissa.train([slow, silent])


def test_what_is_no_recording_is_said_by_column_and_row(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    text = np.where(np.arange(len(heard)) == 7, "0,5", heard["x"].astype(str))
    depth = np.full(len(heard), "0,5")
    for changed, says in [
        (columns | {"x": text}, "row 7: x is '0,5'"),
        (columns | {"touch": np.full(len(heard), "yes")}, "row 0: touch: found 'yes'"),
        (columns | {"touch": np.arange(len(heard)) % 9 - 2}, "row 0: touch: found '-2'"),
        (columns | {"touch": np.arange(len(heard)) % 9 / 2}, "row 1: touch: found '0.5'"),
        (columns | {"tilt_deg": depth == "", "depth_deg": depth}, "row 0: depth_deg is '0,5'"),
        (columns | {"x": heard["x"] * 1e300}, "x: its range is too wide"),
        ({"lable": heard["label"], "x": heard["x"]}, "no column 'label'"),
    ]:
        with pytest.raises(ValueError, match=says):
            vibrissa.train(changed)
    with pytest.raises(ValueError, match="channels: both are 'x'"):
        vibrissa.train(columns, channels=("x", "x"))
    with pytest.raises(ValueError, match="channels: found .*, two are needed"):
        vibrissa.train(columns, channels=("x", "y", "contact"))
    for judge in (vibrissa.train, lambda none: vibrissa.evaluate(SHIPPED, none)):
        with pytest.raises(ValueError, match="recordings: found none"):
            judge([])


def test_blanks_about_cells_count_no_more_than_in_a_file(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    names = ("label", "trial")
    blank = {name: np.char.add(np.char.add(" ", heard[name]), " ") for name in names}
    empty = {"tilt_deg": np.full(len(heard), " "), "depth_deg": np.full(len(heard), "")}
    assert bytes(vibrissa.train(columns | blank | empty, expect="same")) == SHIPPED


def test_a_scene_without_a_classifier_has_no_use_for_a_model(heard):
    with pytest.raises(ValueError, match="no use for a model"):
        vibrissa.Sim("free", model=vibrissa.train(heard))


def test_a_model_of_another_rate_is_refused(heard):
    columns = {name: heard[name] for name in heard.dtype.names}
    model = vibrissa.train(columns, tables="single", rate=1000)
    with pytest.raises(vibrissa.SceneError, match="1000 samples a second"):
        vibrissa.Sim(vibrissa.SCENES["bench"], model=model)


def test_hits_say_which_classes_they_leave_out():
    model = vibrissa.train(usual(), tables="single")
    short = joined(plain("low", 0, 1000 + repeated(400)), plain("high", 0, 9000 + repeated(5)))
    assert vibrissa.evaluate(model, short).left_out == ["high"]
    assert vibrissa.evaluate(model, usual()).left_out == []


@pytest.fixture(scope="module")
def files(heard, tmp_path_factory):
    """The recording as files: as others write one, and in two halves."""
    folder = tmp_path_factory.mktemp("recordings")
    half = len(heard) // 2
    parts = {"whole.csv": heard, "first.csv": heard[:half], "second.csv": heard[half:]}
    for name, part in parts.items():
        with (folder / name).open("w", newline="") as file:
            file.write("# tick_hz = 2000\n")
            writer = csv.writer(file)
            writer.writerow(part.dtype.names)
            writer.writerows(part.tolist())
    return folder


def test_files_do(heard, files):
    whole = files / "whole.csv"
    read = vibrissa.read(whole)
    assert read.dtype.names == heard.dtype.names and read.dtype.metadata["tick_hz"] == 2000
    assert np.array_equal(read["trial"], heard["trial"]) and np.allclose(read["x"], heard["x"])
    assert bytes(vibrissa.train(str(whole), expect="same")) == SHIPPED
    halves = [files / "first.csv", str(files / "second.csv")]
    model = vibrissa.train(halves)
    assert bytes(model) == bytes(vibrissa.train([vibrissa.read(half) for half in halves]))
    assert bytes(vibrissa.train(dict(zip("ab", halves)))) == bytes(model)
    decided = vibrissa.classify(model, whole)
    assert np.array_equal(decided, vibrissa.classify(model, heard))
    # A channel may be a column that has a use of its own.
    for channels in (("x", "contact"), ("trial", "y")):
        assert vibrissa.read(whole, channels=channels).dtype.names[2:] != heard.dtype.names[2:]
        both = [bytes(vibrissa.train(one, channels=channels)) for one in (whole, heard)]
        assert both[0] == both[1]
    with pytest.raises(FileNotFoundError, match="nowhere.csv"):
        vibrissa.train("nowhere.csv")
    with pytest.raises(ValueError, match=r"whole\.csv: line 2: no column \"u\""):
        vibrissa.train(whole, channels=("u", "v"))
    with pytest.raises(TypeError, match="recording: found .*int.*allowed: a path"):
        vibrissa.train(7)


def test_columns_of_a_file_keep_their_names(files, tmp_path):
    renamed = tmp_path / "renamed.csv"
    lines = (files / "first.csv").read_text().splitlines()
    header = lines[1].replace(",x,y,contact,touch", ",u,v,pressure,count")
    renamed.write_text("\n".join([*lines[:1], header, *lines[2:]]))
    assert vibrissa.read(renamed, channels=("u", "v")).dtype.names == ("label", "trial", "u", "v")
    model = vibrissa.train(renamed, channels=("u", "v"), tables="single")
    assert model.classes == ["smooth", "p600", "p240", "carpet"]


def test_model_and_recordings_are_told_apart(heard, files, tmp_path):
    model = vibrissa.train(heard)
    path = tmp_path / "mine.model"
    model.save(path)
    wanted = vibrissa.evaluate(model, heard)
    assert wanted.confusion.sum() == len(vibrissa.classify(model, heard))
    for one in (model, bytes(model), str(path)):
        for two in (heard, str(files / "whole.csv")):
            for found in (vibrissa.evaluate(one, two), vibrissa.evaluate(two, one)):
                assert np.array_equal(found.confusion, wanted.confusion)
            assert len(vibrissa.classify(two, one)) == wanted.confusion.sum()
    # Several are one after the other.
    halves = [files / "first.csv", files / "second.csv"]
    apart = [vibrissa.evaluate(model, half).confusion for half in halves]
    assert np.array_equal(vibrissa.evaluate(halves, model).confusion, sum(apart))
    with pytest.raises(TypeError, match="recording: found .*Model"):
        vibrissa.evaluate(model, model)
    with pytest.raises(TypeError, match="model: found .*ndarray.*allowed: a Model"):
        vibrissa.evaluate(heard, heard)


def test_confusion_is_an_array_with_labels(heard):
    model = vibrissa.train(heard[np.isin(heard["label"], ["smooth", "p600", "p240"])])
    found = vibrissa.evaluate(model, heard)
    assert found.labels == ["smooth", "p600", "p240", "carpet", "unknown"]
    decisions = vibrissa.classify(model, heard)
    for row, label in enumerate(found.labels):
        for column, decision in enumerate(found.labels):
            same = (decisions["label"] == label) & (decisions["decision"] == decision)
            assert found.confusion[row, column] == same.sum()
    # Of what is known those that named a class are right as `found` says.
    known = found.confusion[:3, :3]
    assert known.sum() == found.found.of
    assert np.trace(known) / known.sum() == pytest.approx(found.found.share)


def test_low_and_high_are_an_interval_wherever_they_stand(heard):
    model = vibrissa.train(heard)
    found = vibrissa.evaluate(model, vibrissa.record(TEXTURES, seed=4))
    for table in (model.calibration, found.calibration):
        table = table[table["decisions"] > 0]
        assert np.all(table["low"] <= table["found"])
        assert np.all(table["found"] <= table["high"])
    bins = found.calibration[found.calibration["decisions"] > 0]
    assert np.all(bins["stated_from"] <= bins["stated"])
    assert np.all(bins["stated"] <= bins["stated_to"])
    assert found.found.low <= found.found.share <= found.found.high
