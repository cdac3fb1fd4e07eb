"""Environments of Gymnasium: an agent moves the whisker.

An observation has four numbers of each whisker, left side first, as the trace has them: angle
(degrees), x and y (14-bit codes) and contact, so that ``observation[..., CONTACT]`` is the contact
of all whiskers. An action is a setpoint in degrees or a gain for each whisker. What is worth
something is the user's to say, by a function of the observation, the action and the observation
before, whose arrays have one more axis in front where there are several environments.

``gymnasium.make("vibrissa.gym:Whisker-v0")`` makes one, and ``make_vec`` many. With
``render_mode="rgb_array"``, ``render()`` draws the whiskers as they are.

Needs ``gymnasium``.
"""

import operator
from collections.abc import Callable, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from vibrissa import SCENES
from vibrissa._core import Envs
from vibrissa._picture import picture

ANGLE = slice(0, None, 4)
X = slice(1, None, 4)
Y = slice(2, None, 4)
CONTACT = slice(3, None, 4)

#: Contact from which a whisker is taken as touching.
TOUCHING = 0.05
#: Contact of a gentle touch.
GENTLE = 0.2

Reward = Callable[[np.ndarray, np.ndarray, np.ndarray], Any]


def touch_gently(observation: np.ndarray, action: np.ndarray, before: np.ndarray) -> np.ndarray:
    """Up to 1 a step for a touch as light as ``GENTLE``, nothing for the air, -1 for a hard one."""
    contact = observation[..., CONTACT]
    light = 1.0 - ((contact - GENTLE) / GENTLE) ** 2
    return np.maximum(np.where(contact < TOUCHING, 0.0, light), -1.0).mean(axis=-1)


def find_the_edge(observation: np.ndarray, action: np.ndarray, before: np.ndarray) -> np.ndarray:
    """1 whenever a touch begins or ends: an agent that knows where the edge is stays about it."""
    touches = observation[..., CONTACT] >= TOUCHING
    touched = before[..., CONTACT] >= TOUCHING
    return (touches != touched).astype(np.float64).mean(axis=-1)


def _rendering(mode: str | None, envs: Envs, metadata: dict[str, Any]) -> dict[str, Any]:
    """The metadata of an environment: as many pictures a second as actions."""
    if mode not in (None, *metadata["render_modes"]):
        allowed = ", ".join(metadata["render_modes"])
        raise ValueError(f"render_mode: found {mode!r}, allowed: None, {allowed}")
    return {**metadata, "render_fps": envs.rate_hz}


def _spaces(envs: Envs) -> tuple[gymnasium.spaces.Box, gymnasium.spaces.Box]:
    low = np.tile(np.array([-360.0, 0.0, 0.0, 0.0], np.float32), envs.whiskers)
    high = np.tile(np.array([360.0, 16383.0, 16383.0, np.inf], np.float32), envs.whiskers)
    least, most = envs.limits
    return (
        gymnasium.spaces.Box(low, high),
        gymnasium.spaces.Box(least, most, (envs.whiskers,), np.float32),
    )


def _whole(name: str, seed: Any) -> int:
    """A seed, which must be a whole number of 64 bits."""
    try:
        whole = operator.index(seed)
    except TypeError:
        whole = -1
    if isinstance(seed, (bool, np.bool_)) or not 0 <= whole < 2**64:
        raise ValueError(f"{name}: found {seed!r}, allowed: a whole number from 0 to 2**64 - 1")
    return whole


def _acts(name: str, given: Any, shape: tuple[int, ...]) -> np.ndarray:
    """What is to be done, by whisker; of a single one it may stand alone."""
    acts = np.ascontiguousarray(given, dtype=np.float64)
    found = np.shape(given)
    if found != shape and not (shape[-1] == 1 and found == shape[:-1]):
        raise ValueError(f"{name}: found the shape {found}, allowed: {shape}")
    return acts.reshape(shape)


class WhiskerEnv(gymnasium.Env):
    """A scene in which an agent acts every ``ticks`` ticks until the scene has ended."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 2000}

    def __init__(
        self,
        scene: Any = None,
        *,
        reward: Reward = touch_gently,
        action: str = "setpoint",
        ticks: int = 1,
        model: Any = None,
        set: dict[str, Any] | None = None,
        render_mode: str | None = None,
    ) -> None:
        scene = SCENES["textures"] if scene is None else scene
        self._envs = Envs(scene, 1, action=action, ticks=ticks, model=model, set=set)
        self._reward = reward
        self.metadata = _rendering(render_mode, self._envs, self.metadata)
        self.render_mode = render_mode
        self.observation_space, self.action_space = _spaces(self._envs)
        self._before: np.ndarray | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        one = None if seed is None else _whole("seed", seed)
        super().reset(seed=one)
        number = int(self.np_random.integers(2**32)) if one is None else one
        observation, _ = self._step(np.zeros((1, self._envs.whiskers)), True, number)
        # The caller may change what it gets.
        self._before = observation.copy()
        return observation, {"seed": number}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        if self._before is None:
            raise gymnasium.error.ResetNeeded("step before reset")
        action = _acts("action", action, (self._envs.whiskers,)).reshape(1, -1)
        observation, ended = self._step(action, False, 0)
        reward = float(self._reward(observation, action[0], self._before))
        self._before = observation.copy()
        return observation, reward, False, ended, {}

    def render(self) -> np.ndarray | None:
        """The whiskers from above, as the last observation has them: pixels of red, green, blue."""
        if self.render_mode is None:
            return None
        if self._before is None:
            raise gymnasium.error.ResetNeeded("render before reset")
        return picture(self._before, self._envs.whiskers_per_side, TOUCHING)

    def _step(self, action: np.ndarray, begin: bool, seed: int) -> tuple[np.ndarray, bool]:
        seen, ended = self._envs.step(action, np.array([begin]), np.array([seed], np.uint64))
        return seen[0], bool(ended[0])


class WhiskerVectorEnv(VectorEnv):
    """So many of them on all cores; one that has ended restarts with its next step."""

    metadata = {
        "render_modes": ["rgb_array"],
        "render_fps": 2000,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int,
        scene: Any = None,
        *,
        reward: Reward = touch_gently,
        action: str = "setpoint",
        ticks: int = 1,
        model: Any = None,
        set: dict[str, Any] | None = None,
        render_mode: str | None = None,
    ) -> None:
        scene = SCENES["textures"] if scene is None else scene
        self._envs = Envs(scene, num_envs, action=action, ticks=ticks, model=model, set=set)
        self._reward = reward
        self.metadata = _rendering(render_mode, self._envs, self.metadata)
        self.render_mode = render_mode
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = _spaces(self._envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._ended = np.zeros(num_envs, bool)
        self._seeds = np.zeros(num_envs, np.uint64)
        #: Where each environment's next seeds come from.
        self._randoms: list[np.random.Generator] = []
        self._before: np.ndarray | None = None

    def reset(
        self, *, seed: int | Sequence[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        mask = self._mask(options)
        one = None if seed is None or np.ndim(seed) else _whole("seed", seed)
        super().reset(seed=one)
        if seed is None:
            seeds = [int(n) for n in self.np_random.integers(2**32, size=self.num_envs)]
        elif one is not None:
            seeds = [_whole("seed", one + n) for n in range(self.num_envs)]
        else:
            seeds = [_whole(f"seed[{n}]", value) for n, value in enumerate(seed)]
            if len(seeds) != self.num_envs:
                raise ValueError(f"seed: found {len(seeds)}, allowed: {self.num_envs} of them")
        if not self._randoms:
            mask[:] = True
            self._randoms = [np.random.default_rng()] * self.num_envs
        for n in np.flatnonzero(mask):
            self._randoms[n] = np.random.default_rng(seeds[n])
        self._seeds = np.where(mask, np.array(seeds, np.uint64), self._seeds)
        self._before, _ = self._envs.step(None, mask, self._seeds)
        self._ended &= ~mask
        return self._before.copy(), {"seed": self._seeds.copy()}

    def _mask(self, options: dict[str, Any] | None) -> np.ndarray:
        """Which environments are to be reset: Gymnasium's option ``reset_mask``."""
        if options is None or options.get("reset_mask") is None:
            return np.ones(self.num_envs, bool)
        mask = np.asarray(options["reset_mask"])
        if mask.dtype != bool or mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(
                f"reset_mask: found {mask!r}, allowed: {self.num_envs} truths, one of them at least true"
            )
        return mask.copy()

    def step(
        self, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        if self._before is None:
            raise gymnasium.error.ResetNeeded("step before reset")
        begin = self._ended
        restarts = begin.any()
        if restarts:
            for n in np.flatnonzero(begin):
                self._seeds[n] = self._randoms[n].integers(2**32)
        actions = _acts("actions", actions, (self.num_envs, self._envs.whiskers))
        observations, ended = self._envs.step(actions, begin, self._seeds)
        rewards = np.asarray(self._reward(observations, actions, self._before), np.float64)
        if restarts:
            rewards = np.where(begin, 0.0, rewards)
        self._before, self._ended = observations.copy(), ended
        return observations, rewards, np.zeros(self.num_envs, bool), ended.copy(), {}

    def render(self) -> tuple[np.ndarray, ...] | None:
        """A picture of each environment."""
        if self.render_mode is None:
            return None
        if self._before is None:
            raise gymnasium.error.ResetNeeded("render before reset")
        return tuple(picture(one, self._envs.whiskers_per_side, TOUCHING) for one in self._before)


gymnasium.register(
    "Whisker-v0",
    entry_point="vibrissa.gym:WhiskerEnv",
    vector_entry_point="vibrissa.gym:WhiskerVectorEnv",
)
