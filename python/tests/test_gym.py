"""Environments."""

import copy
import multiprocessing
import pickle
import runpy
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import vibrissa
from vibrissa.gym import CONTACT, WhiskerEnv, WhiskerVectorEnv, find_the_edge, touch_gently

SHORT = {"duration_s": 0.5}


@pytest.mark.parametrize("action", ["setpoint", "gain"])
@pytest.mark.parametrize("scene", ["textures", "both"])
def test_gymnasium_finds_nothing_wrong(action, scene):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        check_env(WhiskerEnv(scene, action=action, set=SHORT, render_mode="rgb_array"))


def test_made_by_name():
    env = gymnasium.make("vibrissa.gym:Whisker-v0", set=SHORT, ticks=100)
    observation, info = env.reset(seed=3)
    assert observation.shape == (4,) and info["seed"] == 3
    ended = [env.step(env.action_space.sample())[3] for _ in range(10)]
    assert ended == [False] * 9 + [True]


def test_it_draws_the_whiskers_at_their_angles_and_marks_a_touch():
    env = gymnasium.make("vibrissa.gym:Whisker-v0", render_mode="rgb_array", ticks=200)
    assert env.unwrapped.metadata["render_fps"] == 10
    env.reset(seed=1)
    pictures = {}
    for setpoint in (75.0, 96.0, 110.0):
        for _ in range(4):
            observation, *_ = env.step(np.array([setpoint], np.float32))
        drawn = env.render()
        assert drawn.shape == (160, 240, 3) and drawn.dtype == np.uint8
        pictures[setpoint] = drawn, observation[CONTACT][0]
    # Row of the whisker's tip: the leftmost dark pixel; a larger angle is further up, to the front.
    tips = []
    for setpoint in (75.0, 96.0):
        rows, columns = np.nonzero((pictures[setpoint][0] < 80).all(axis=2))
        tips.append(rows[np.argmin(columns)])
    assert tips[0] > 96 > tips[1]
    orange = {s: (drawn == (200, 70, 0)).all(axis=2).any() for s, (drawn, _) in pictures.items()}
    assert orange == {s: contact >= 0.05 for s, (_, contact) in pictures.items()}
    assert orange[110.0] and not orange[75.0]
    with pytest.raises(ValueError, match="render_mode: found 'human', allowed: None, rgb_array"):
        WhiskerEnv(render_mode="human")


def test_many_draw_one_picture_each():
    many = gymnasium.make_vec(
        "vibrissa.gym:Whisker-v0",
        3,
        vectorization_mode="vector_entry_point",
        scene="both",
        set=SHORT,
        render_mode="rgb_array",
    )
    many.reset(seed=1)
    pictures = many.render()
    assert len(pictures) == 3 and all(one.shape == (160, 240, 3) for one in pictures)
    dark = (pictures[0] < 80).all(axis=2)
    assert dark[:, :100].any() and dark[:, 140:].any()


def test_an_observation_is_the_trace_s():
    env = WhiskerEnv(ticks=200)
    env.reset(seed=9)
    observation, *_ = env.step(np.array([90.0], np.float32))
    sim = vibrissa.Sim(vibrissa.SCENES["textures"], seed=9)
    sim.setpoint(90.0)
    row = sim.step(200)[-1]
    names = ["angle_left_deg", "x_left", "y_left", "contact_left"]
    assert np.allclose(observation, [row[name] for name in names], rtol=1e-6)


def test_environments_side_by_side_are_single_ones_and_restart():
    many = WhiskerVectorEnv(3, set=SHORT, ticks=300, reward=find_the_edge)
    first, _ = many.reset(seed=np.int64(5))
    one = WhiskerEnv(set=SHORT, ticks=300)
    one.reset(seed=6)
    action = np.full((3, 1), 105.0)
    for n in range(4):
        seen, rewards, ended, cut, _ = many.step(action)
        assert np.array_equal(seen[1], one.step(action[0])[0])
        assert seen.shape == (3, 4) and rewards.shape == (3,) and not ended.any()
        assert cut.all() == (n == 3)
    seen, rewards, _, cut, _ = many.step(action)
    assert np.array_equal(seen[:, 0], first[:, 0]) and not rewards.any() and not cut.any()


def test_rewards():
    def at(contact):
        return np.array([100.0, 8192.0, 8192.0, contact])

    gentle = [float(touch_gently(at(c), None, at(0.0))) for c in (0.0, 0.2, 0.3, 0.9)]
    assert gentle[0] == 0.0 and gentle[1] == 1.0 and 0.0 < gentle[2] < 1.0 and gentle[3] == -1.0
    assert float(find_the_edge(at(0.2), None, at(0.0))) == 1.0
    assert float(find_the_edge(at(0.2), None, at(0.2))) == 0.0
    assert at(0.4)[CONTACT] == [0.4]


def test_an_observation_is_the_callers():
    def episode(env, share):
        total, observation = 0.0, env.reset(seed=1)[0]
        observation *= share
        for _ in range(60):
            observation, reward, *_ = env.step(np.full(env.action_space.shape, 110.0))
            observation *= share
            total += np.sum(reward)
        return total

    options = {"set": {"duration_s": 2.0}, "ticks": 20, "reward": find_the_edge}
    for make in (lambda: WhiskerEnv(**options), lambda: WhiskerVectorEnv(2, **options)):
        assert episode(make(), 0.001) == episode(make(), 1.0)


def test_actions_have_a_place_for_each_whisker():
    env = WhiskerVectorEnv(3, "both", set=SHORT)
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"actions: found the shape \(2, 3\), allowed: \(3, 2\)"):
        env.step(np.zeros((2, 3)))
    with pytest.raises(ValueError, match="armed by a command"):
        WhiskerEnv("bench")


def test_the_example_learns():
    example = runpy.run_path(str(Path(__file__).parents[1] / "examples" / "learn_to_touch.py"))
    before, after = example["main"]()
    assert after > before + 0.5


def test_what_is_wrong_is_said():
    with pytest.raises(ValueError, match="passive"):
        WhiskerEnv(vibrissa.SCENES["passive"])
    with pytest.raises(ValueError, match="allowed: setpoint, gain"):
        WhiskerEnv(action="force")
    with pytest.raises(gymnasium.error.ResetNeeded):
        WhiskerEnv().step(np.zeros(1))


def _steps(env, count):
    return [env.step(np.full((env.num_envs, 1), 105.0))[0] for _ in range(count)]


def test_the_same_seeds_are_the_same_past_a_restart():
    runs = []
    for _ in range(2):
        env = WhiskerVectorEnv(2, set=SHORT, ticks=500)
        env.reset(seed=[5, 9])
        runs.append(_steps(env, 6))
    assert np.array_equal(*runs) and not np.array_equal(runs[0][0], runs[0][2])


@pytest.mark.parametrize("seed", [[None, 1], [1], [1, 2, 3], [1.5, 2], [True, 2], [2**64, 1], 2**64 - 1, -1, "1"])
def test_a_wrong_seed_is_called_one(seed):
    with pytest.raises(ValueError, match="seed"):
        WhiskerVectorEnv(2, set=SHORT).reset(seed=seed)


def test_a_mask_resets_some():
    env = WhiskerVectorEnv(3, set=SHORT, ticks=100)
    first, _ = env.reset(seed=1)
    (moved,) = _steps(env, 1)
    seen, info = env.reset(seed=1, options={"reset_mask": np.array([True, False, False])})
    assert np.array_equal(seen[0], first[0]) and np.array_equal(seen[1:], moved[1:])
    # The others have as much of their scene left as before.
    ended = [env.step(np.full((3, 1), 105.0))[3].tolist() for _ in range(9)]
    assert ended[8] == [False, True, True] and not any(map(any, ended[:8]))
    for wrong in ([True], [1, 0, 0], [False] * 3):
        with pytest.raises(ValueError, match="reset_mask"):
            env.reset(options={"reset_mask": wrong})


def test_an_action_that_is_no_number_moves_none():
    env, other = (WhiskerVectorEnv(3, set=SHORT, ticks=100) for _ in range(2))
    for each in (env, other):
        each.reset(seed=1)
    with pytest.raises(ValueError, match="found NaN"):
        env.step(np.array([[72.0], [np.nan], [72.0]]))
    assert np.array_equal(_steps(env, 1), _steps(other, 1))


def test_environments_go_on_in_a_process_that_was_forked_off():
    env = WhiskerVectorEnv(64, set=SHORT, ticks=20)
    env.reset(seed=1)
    env.step(np.full((64, 1), 90.0))
    child = multiprocessing.get_context("fork").Process(target=env.step, args=(np.full((64, 1), 90.0),))
    child.start()
    child.join(60)
    assert child.exitcode == 0


@pytest.mark.parametrize("again", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_of_environments_go_on_apart_to_the_same_bits(again):
    env = WhiskerEnv(ticks=50, set=SHORT)
    env.reset(seed=3)
    for setpoint in [80.0, 110.0]:
        env.step(np.array([setpoint], np.float32))
    other = again(env)
    action = np.array([100.0], np.float32)
    assert np.array_equal(env.step(action)[0], other.step(action)[0])
    assert np.array_equal(env.reset()[0], other.reset()[0])

    many = WhiskerVectorEnv(3, ticks=100, set=SHORT, action="gain")
    many.reset(seed=[5, 6, 7])
    actions = np.array([[0.5], [1.0], [1.5]], np.float32)
    # Past an autoreset.
    for _ in range(12):
        many.step(actions)
    other = again(many)
    for _ in range(12):
        one, two = many.step(actions), other.step(actions)
        assert all(np.array_equal(a, b) for a, b in zip(one[:4], two[:4]))
    fresh = again(WhiskerVectorEnv(2, set=SHORT))
    assert fresh.reset(seed=1)[0].shape == (2, 4)


def test_the_example_of_stable_baselines_has_what_it_needs():
    example = runpy.run_path(str(Path(__file__).parents[1] / "examples" / "stable_baselines.py"))
    env = example["make"]()
    assert env.action_space == gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)
    env.reset(seed=1)
    steps = [env.step(env.action_space.sample()) for _ in range(100)]
    assert [step[3] for step in steps] == [False] * 99 + [True]


def test_the_example_of_stable_baselines_learns():
    # Half a gigabyte: where it is there.
    example = runpy.run_path(str(Path(__file__).parents[1] / "examples" / "stable_baselines.py"))
    pytest.importorskip("stable_baselines3")
    before, after = example["main"](20_000)
    assert after > before
