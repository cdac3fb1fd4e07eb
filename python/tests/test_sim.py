"""Runs: rows, decisions and posteriors, and the same bytes as host-sim's."""

import copy
import csv
import hashlib
import io
import os
import pathlib
import pickle
import re
import signal
import threading

import numpy as np
import pandas
import pytest

import vibrissa

TEXTURES = vibrissa.SCENES["textures"]
SHORT = {"duration_s": 4.0}
#: Some seconds of a scene without much in it.
TICKS = 1_000_000
STILL = {
    "name": "still",
    "tick_hz": 2000,
    "duration_s": 1,
    "seed": 1,
    "head": {"whiskers_per_side": 1},
    "plant": {"kind": "ideal"},
}


def test_rows_are_those_of_the_file():
    for name in ("textures", "both", "whisker"):
        sim = vibrissa.Sim(vibrissa.SCENES[name], set=SHORT)
        rows = sim.run()
        sim.reset()
        table = list(csv.reader(io.StringIO(sim.trace_csv().decode())))
        assert list(rows.dtype.names) == table[0]
        assert len(rows) == len(table) - 1 == sim.ticks
        for row, cells in zip(rows.tolist()[::37], table[1::37]):
            for value, cell in zip(row, cells):
                if isinstance(value, str):
                    assert value == cell
                elif cell:
                    decimals = len(cell.partition(".")[2])
                    assert abs(value - float(cell)) <= 0.51 * 10.0**-decimals
                else:
                    assert np.isnan(value)


def test_traces_have_the_hashes_of_host_sim():
    folder = os.environ.get("WHISKER_TRACES")
    if folder is None:
        pytest.skip("cargo xtask python writes the traces")
    wanted = {path.stem: path.read_text().strip() for path in pathlib.Path(folder).glob("*.sha256")}
    assert len(wanted) >= 3
    for name, hashed in wanted.items():
        trace = vibrissa.Sim(vibrissa.SCENES[name]).trace_csv()
        assert hashlib.sha256(trace).hexdigest() == hashed


def test_rows_are_not_copied_and_aligned():
    rows = vibrissa.Sim(TEXTURES).step(10)
    assert rows.base is not None and rows.flags.aligned and rows.flags.writeable
    assert np.shares_memory(rows["t_s"], rows)


def test_steps_add_up_and_a_reset_run_is_a_new_one():
    sim = vibrissa.Sim(TEXTURES, seed=5)
    parts = np.concatenate([sim.step(700), sim.step(), sim.step(1299)])
    assert sim.ticks_done == 2000
    sim.reset()
    assert sim.ticks_done == 0 and len(sim.decisions) == 0
    assert np.array_equal(sim.step(2000)["angle_left_deg"], parts["angle_left_deg"])
    sim.reset(6)
    assert sim.seed == 6
    other = sim.step(2000)["x_left"]
    assert not np.array_equal(other, parts["x_left"])
    assert np.array_equal(vibrissa.Sim(TEXTURES, seed=6).step(2000)["x_left"], other)


def test_decisions_and_posteriors():
    sim = vibrissa.Sim(TEXTURES)
    rows = sim.run()
    decisions, posteriors = sim.decisions, sim.posteriors
    names = list(vibrissa.columns("decisions"))
    assert list(decisions.dtype.names) == names[:7] + names[9:11]
    fell = rows["decision"] != ""
    assert np.array_equal(rows["decision"][fell], decisions["decision"])
    assert np.array_equal(rows["t_s"][fell], decisions["t_s"])
    assert list(posteriors.dtype.names) == ["t_s", *sim.classes]
    assert np.allclose(sum(posteriors[name] for name in sim.classes), 1.0, atol=1e-6)
    assert set(decisions["trial"]) <= set(rows["trial"])
    for name in ("label", "trial"):
        assert np.array_equal(rows[name][fell], decisions[name])
    # A block is 40 samples.
    assert np.diff(posteriors["t_s"]).min() > 39.5 / 2000
    named = decisions[decisions["decision"] != "unknown"]
    assert np.mean(named["decision"] == named["label"]) > 0.9
    assert all(vibrissa.why(decision) == (None, None) for decision in named)


def test_what_is_named_stands_as_it_was_presented():
    scene = vibrissa.SCENES["bench-textures"]
    poses = {"classifier.pose": True}
    heard = vibrissa.record(scene, seed=2, set={"duration_s": 40.0})
    table = {name: heard[name] for name in heard.dtype.names}
    columns = ("label", "trial", "tilt_deg")
    truth = {(str(a), str(b)): c for a, b, c in zip(*(table[name] for name in columns))}
    sim = vibrissa.Sim(scene, seed=2, set={"duration_s": 40.0, **poses})
    sim.run(every=1000)
    named = sim.decisions[sim.decisions["decision"] == "smooth"]
    errors = [row["tilt_deg"] - truth[row["label"], row["trial"]] for row in named]
    assert len(errors) > 10 and max(map(abs, errors)) < 0.6
    assert np.all(named["tilt_error_deg"] < 0.3)
    refused = sim.decisions[sim.decisions["decision"] == "unknown"]
    assert np.all(np.isnan(refused["depth_deg"]))
    # A table of columns teaches as a file does; too few poses do not.
    assert vibrissa.train(table).classes == sim.classes
    with pytest.raises(ValueError, match="classifier.pose: found true"):
        vibrissa.Sim(scene, set=poses, model=vibrissa.train(heard[list(columns[:2]) + ["x", "y"]]))


def test_a_decision_that_names_no_class_says_why():
    decisions = vibrissa.Sim(vibrissa.SCENES["unknown"], set={"duration_s": 60.0})
    decisions.run(every=1000)
    decisions = decisions.decisions
    silent = decisions["decision"] == "unknown"
    assert silent.sum() > 10
    assert np.array_equal(silent, decisions["reason"] != "")
    kept = {"unknown", "pose", "between"}
    assert {vibrissa.why(decision).reason for decision in decisions[silent]} <= kept
    between = decisions["reason"] == "between"
    assert np.array_equal(between, decisions["among"] != "")
    # Rows as the columns have them, for each reason.
    for reason, among, why in [
        ("", "", (None, None)),
        ("unknown", "", ("unknown", None)),
        ("pose", "", ("pose", None)),
        ("between", "p600|p240", ("between", ("p600", "p240"))),
    ]:
        row = np.array([(reason, among)], dtype=[("reason", "U8"), ("among", "U10")])[0]
        assert vibrissa.why(row) == why


def test_setpoint_and_gain_move_the_whisker():
    sim = vibrissa.Sim(TEXTURES)
    sim.setpoint(80.0)
    assert abs(sim.step(2000)["angle_left_deg"][-1] - 80.0) < 1.0
    sim.setpoint(None)
    assert np.ptp(sim.step(2000)["angle_left_deg"]) > 20.0
    sim.reset()
    sim.gain(0.0)
    assert np.ptp(sim.step(4000)["angle_left_deg"][2000:]) < 5.0
    with pytest.raises(ValueError, match="whisker 3, counted from 0, left side first"):
        sim.gain(1.0, whisker=3)


def test_a_texture_is_laid():
    sim = vibrissa.Sim(TEXTURES)
    sim.lay("carpet")
    assert set(sim.step(8000)["label"]) == {"carpet"}
    # Without an elastic shaft few are described, and none of the scene's own.
    for other in ("silk", "rough-carpet", "own-1"):
        with pytest.raises(ValueError, match="allowed: smooth, p600, p240, carpet$"):
            sim.lay(other)
    vibrissa.Sim("whisker").lay("rough-carpet")
    with pytest.raises(ValueError, match='"still" has none'):
        vibrissa.Sim(STILL).lay("carpet")


def test_an_elastic_whisker_has_a_bent_shaft_and_a_point_of_contact():
    sim = vibrissa.Sim(vibrissa.SCENES["whisker"])
    straight = sim.shaft()
    assert straight.shape == (13, 3)
    assert np.ptp(np.diff(straight[:, 2])) < 1e-9 and not straight[:, :2].any()
    row = next(row for row in (sim.step()[-1] for _ in range(4000)) if row["contact_left"] > 0.3)
    arc_m, place_m = sim.touch_at()
    assert (arc_m, place_m) == (row["touch_at_left_m"], row["place_left_m"])
    assert sim.touches_at() == [(arc_m, place_m)]
    assert 0.5 < arc_m / straight[-1, 2] < 1.0 + 1e-9
    bent = sim.shaft()
    # As long as before, and pushed against protraction.
    lengths = [np.linalg.norm(np.diff(shaft, axis=0), axis=1).sum() for shaft in (straight, bent)]
    assert abs(lengths[1] / lengths[0] - 1.0) < 0.01
    assert bent[-1, 0] > 0.005
    along = {"plant.slant_deg": 0.0, "plant.tilt_deg": 0.0, "whisking.frequency_hz": 8.0}
    sim = vibrissa.Sim(vibrissa.SCENES["whisker"], set=along)
    touches = []
    while not sim.done and len(touches) < 2:
        sim.step()
        touches = sim.touches_at()
    assert abs(touches[0][0] - touches[1][0]) > 0.005
    with pytest.raises(ValueError, match='whisker 1, counted from 0, left side first: scene "whisker" has none'):
        sim.shaft(1)
    with pytest.raises(ValueError, match='scene "still" has none that bends'):
        vibrissa.Sim(STILL).touch_at()


def test_a_scene_is_a_path_a_text_or_a_dictionary():
    text = vibrissa.SCENES["free"].read_text()
    rows = [vibrissa.Sim(scene).step(5)["theta_left_deg"] for scene in (vibrissa.SCENES["free"], text)]
    assert np.array_equal(*rows)
    assert len(vibrissa.Sim(STILL).run()) == 2000
    nested = {**STILL, "head": {"whiskers_per_side": np.int64(2), "sides": "left"}}
    assert "x_left_2" in vibrissa.Sim(nested).step().dtype.names


def test_problems_are_reported_with_line_or_place():
    with pytest.raises(vibrissa.SceneError) as caught:
        vibrissa.Sim({**STILL, "head": {"whiskers_per_side": 13}})
    (problem,) = caught.value.problems
    assert (problem.file, problem.key) == ('scene["head"]["whiskers_per_side"]', "head.whiskers_per_side")
    assert (problem.found, problem.line) == ("found 13", None)
    text = vibrissa.SCENES["free"].read_text().replace("2000", "20")
    with pytest.raises(vibrissa.SceneError, match=r"^scene:\d+: tick_hz: found 20; ") as caught:
        vibrissa.Sim(text)
    assert text.splitlines()[caught.value.problems[0].line - 1].startswith("tick_hz")
    with pytest.raises(vibrissa.SceneError, match=r'set\["rcp.gain"\]: rcp.gain: found -1'):
        vibrissa.Sim(TEXTURES, set={"rcp.gain": -1})
    with pytest.raises(TypeError, match=r'set\["rcp"\]: found .*dict'):
        vibrissa.Sim(TEXTURES, set={"rcp": {"gain": 1}})
    with pytest.raises(FileNotFoundError, match="nowhere.toml"):
        vibrissa.Sim("nowhere.toml")
    with pytest.raises(TypeError, match="allowed: a name, a path, TOML text or a dict"):
        vibrissa.Sim(7)
    with pytest.raises(vibrissa.SceneError, match="classifier.model"):
        vibrissa.Sim(TEXTURES, set={"classifier.model": "nowhere.model"})


def test_a_wrong_model_is_not_the_scene_s_fault(tmp_path):
    for model in (b"no model", b""):
        with pytest.raises(ValueError, match="^model: ") as caught:
            vibrissa.Sim("textures", model=model)
        assert "textures" not in str(caught.value)
    file = tmp_path / "mine.model"
    file.write_bytes(b"no model")
    with pytest.raises(ValueError, match=r"^model: .*mine\.model: "):
        vibrissa.Sim("textures", model=file)
    with pytest.raises(TypeError, match="^model: found .*int.*allowed: a Model, its bytes or a path"):
        vibrissa.Sim("textures", model=7)


def test_a_scene_has_a_name(tmp_path, monkeypatch):
    named, path = vibrissa.Sim("textures", seed=2), vibrissa.Sim(TEXTURES, seed=2)
    assert named.name == "textures" and named.step(500).tobytes() == path.step(500).tobytes()
    with pytest.raises(FileNotFoundError, match='scene: found "texture", allowed: .*nearest: textures'):
        vibrissa.Sim("texture")
    with pytest.raises(FileNotFoundError, match="a name: active, .*, whisker"):
        vibrissa.Sim("0123456789")
    # One's own, beside the project's.
    (tmp_path / "scenes").mkdir()
    own = vibrissa.SCENES["free"].read_text()
    (tmp_path / "scenes" / "mine.toml").write_text(own)
    monkeypatch.chdir(tmp_path)
    assert vibrissa.Sim("mine").name == "free"
    with pytest.raises(FileNotFoundError, match="nearest: mine"):
        vibrissa.Sim("mines")


def test_a_loop_until_it_is_done_ends():
    sim = vibrissa.Sim(STILL)
    steps = 0
    assert sim.done is False
    while not sim.done:
        sim.step(300)
        steps += 1
    assert (steps, sim.ticks_done, sim.ticks, sim.done) == (7, 2100, 2000, True)
    sim.reset()
    assert not sim.done


def test_tables_are_tables_of_pandas():
    sim = vibrissa.Sim("textures", set=SHORT)
    rows = pandas.DataFrame(sim.run())
    posteriors = pandas.DataFrame(sim.posteriors)
    assert list(posteriors.columns) == ["t_s", *sim.classes]
    both = pandas.DataFrame(sim.decisions).merge(rows, on=["t_s", "trial", "label"])
    assert len(both) == len(sim.decisions) > 0
    recording = pandas.DataFrame(vibrissa.record("textures", set=SHORT))
    assert recording["trial"].dtype == rows["trial"].dtype


def test_problems_and_models_reach_other_processes():
    with pytest.raises(vibrissa.SceneError) as caught:
        vibrissa.Sim({**STILL, "tick_hz": 20})
    copy = pickle.loads(pickle.dumps(caught.value))
    assert str(copy) == str(caught.value) and repr(copy.problems) == repr(caught.value.problems)
    shipped = vibrissa.Model(TEXTURES.parent / "models" / "textures.model")
    assert bytes(pickle.loads(pickle.dumps(shipped))) == bytes(shipped)


def test_more_rows_than_there_is_memory_are_refused():
    with pytest.raises(MemoryError, match="no room"):
        vibrissa.Sim(STILL).step(10**15)
    with pytest.raises(MemoryError, match="no room"):
        vibrissa.run_many(STILL, range(10), every=1, set={"duration_s": 80_000})
    # A row for each of a billion ticks is none of them.
    assert len(vibrissa.Sim(STILL).step(10, every=2**62)) == 0


def test_an_interrupt_ends_a_long_run():
    # A handler of one's own, as an interrupt would end the test.
    def handler(*_):
        raise TimeoutError("enough")

    before = signal.signal(signal.SIGALRM, handler)
    try:
        for work in (lambda: vibrissa.Sim(STILL).step(10**12, every=10**9),
                     lambda: vibrissa.run_many(STILL, range(10**6), every=0, set={"duration_s": 500})):
            signal.setitimer(signal.ITIMER_REAL, 0.3)
            with pytest.raises(TimeoutError, match="enough"):
                work()
    finally:
        signal.signal(signal.SIGALRM, before)


def test_many_seeds_are_each_a_run():
    rows, decisions = vibrissa.run_many(TEXTURES, [7, 8, 7], every=100, set=SHORT)
    assert rows.shape == (3, 80)
    assert rows[0].tobytes() == rows[2].tobytes() != rows[1].tobytes()
    one = vibrissa.Sim(TEXTURES, seed=8, set=SHORT)
    assert np.array_equal(one.run(every=100)["x_left"], rows[1]["x_left"])
    of_one = decisions[decisions["seed"] == 8]
    assert np.array_equal(of_one["t_s"], one.decisions["t_s"])
    none, _ = vibrissa.run_many(TEXTURES, range(2), every=0, set=SHORT)
    assert none.shape == (2, 0)
    _, decisions = vibrissa.run_many(TEXTURES, [2**64 - 1], every=0, set=SHORT)
    assert set(decisions["seed"].tolist()) == {2**64 - 1}


def test_rows_that_are_passed_over_change_nothing():
    for name in ("textures", "cia"):
        scene = vibrissa.SCENES[name]
        every = vibrissa.Sim(scene, set=SHORT)
        tenth = vibrissa.Sim(scene, set=SHORT)
        rows = every.run()[9::10]
        assert tenth.run(every=10).tobytes() == rows.tobytes()
        assert tenth.decisions.tobytes() == every.decisions.tobytes()
        assert tenth.posteriors.tobytes() == every.posteriors.tobytes()


def test_every_column_is_described():
    known = set(vibrissa.columns("trace"))
    assert set(vibrissa.Sim(TEXTURES).step().dtype.names) <= known
    unit, meaning = vibrissa.columns("trace")["angle_left_deg"]
    assert unit == "degrees" and "angle" in meaning


def test_the_readme_s_lines_decide(capsys):
    readme = pathlib.Path(__file__).parents[1] / "README.md"
    (lines,) = re.findall(r"```python\n(.*?)```", readme.read_text(), re.S)
    exec(lines, {})
    assert "smooth" in capsys.readouterr().out


def test_handlers_of_signals_and_other_threads_see_a_run_go_on():
    sim = vibrissa.Sim(STILL)
    seen, polled = [], []

    def look(*_):
        seen.append((sim.ticks_done, sim.ticks, sim.seed, len(sim.decisions), len(sim.posteriors)))

    def poll():
        while sim.ticks_done < TICKS:
            polled.append(sim.ticks_done)

    ticks_before = signal.signal(signal.SIGALRM, look)
    signal.setitimer(signal.ITIMER_REAL, 0.05, 0.05)
    other = threading.Thread(target=poll)
    other.start()
    try:
        sim.step(TICKS, every=TICKS)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, ticks_before)
    other.join()
    assert len(seen) > 1 and seen[0][0] < TICKS
    assert len(set(polled)) > 3


def test_values_of_numpy_and_paths_are_python_s_own(tmp_path):
    own = {"whisking.coupling": np.bool_(False), "seed": None, "plant.stiffness": np.float32(0.5)}
    sim = vibrissa.Sim(TEXTURES, set=own)
    assert sim.seed == vibrissa.Sim(TEXTURES).seed
    folder = tmp_path / "motor.kp=0.1"
    folder.mkdir()
    scene = folder / "scene.toml"
    text = pathlib.Path(vibrissa.SCENES["free"]).read_text()
    scene.write_text(text)
    assert vibrissa.Sim(str(scene)).name == "free"
    with pytest.raises(FileNotFoundError):
        vibrissa.Sim(str(folder / "missing.toml"))
    model = pathlib.Path(TEXTURES).parent / "models" / "textures.model"
    assert vibrissa.Sim(TEXTURES, set={"classifier.model": model.resolve()}).classes


def test_what_the_bench_refuses_is_refused():
    sim = vibrissa.Sim(TEXTURES)
    for wrong in (3, -0.1, float("nan")):
        with pytest.raises(ValueError, match="gain: found .* allowed: 0 to 2"):
            sim.gain(wrong)
    for wrong in (1e9, float("nan")):
        with pytest.raises(ValueError, match="setpoint: found"):
            sim.setpoint(wrong)


def driven(sim):
    sim.step(700)
    sim.setpoint(95.0)
    sim.gain(1.5)
    sim.step(100)
    sim.setpoint(None)
    sim.lay("carpet")
    sim.step(300)
    return sim


@pytest.mark.parametrize(
    "again", [copy.deepcopy, copy.copy, lambda sim: pickle.loads(pickle.dumps(sim))]
)
def test_copies_go_on_apart_to_the_same_bits(again):
    sim = driven(vibrissa.Sim(vibrissa.SCENES["textures"], seed=7, set={"duration_s": 4.0}))
    other = again(sim)
    assert (other.ticks_done, other.seed, other.name) == (sim.ticks_done, sim.seed, sim.name)
    assert np.array_equal(other.decisions, sim.decisions)
    assert np.array_equal(other.posteriors, sim.posteriors)
    assert other.step(2000).tobytes() == sim.step(2000).tobytes()
    other.step(10)
    assert other.ticks_done == sim.ticks_done + 10
    sim.reset(9)
    assert again(sim).step(100).tobytes() == sim.step(100).tobytes()


def test_a_copy_needs_no_file(tmp_path):
    text = vibrissa.SCENES["textures"].read_text()
    (tmp_path / "models").mkdir()
    model = vibrissa.SCENES["textures"].parent / "models" / "textures.model"
    (tmp_path / "models" / "textures.model").write_bytes(model.read_bytes())
    (tmp_path / "s.toml").write_text(text)
    sim = driven(vibrissa.Sim(tmp_path / "s.toml"))
    for path in tmp_path.rglob("*.*"):
        path.unlink()
    assert copy.deepcopy(sim).step(500).tobytes() == sim.step(500).tobytes()
