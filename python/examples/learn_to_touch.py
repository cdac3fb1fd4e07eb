"""An agent learns to touch gently, in less than a minute.

Its setpoint is a line of the contact it feels: two numbers, which the cross-entropy method finds.
Each environment tries its own pair; the best tenth tells where the next ones are drawn. Prints
the mean reward a step, with its standard error, over fresh seeds before and after.
"""

import time

import numpy as np

from vibrissa.gym import CONTACT, WhiskerVectorEnv

ENVS, ROUNDS, STEPS = 128, 15, 100
SECONDS = {"duration_s": 2.0}


def play(envs: WhiskerVectorEnv, lines: np.ndarray, seed: int) -> np.ndarray:
    """The mean reward a step of each environment, by its own line."""
    observation, _ = envs.reset(seed=seed)
    total = np.zeros(envs.num_envs)
    for _ in range(STEPS):
        contact = observation[:, CONTACT]
        observation, reward, _, _, _ = envs.step(lines[:, :1] + lines[:, 1:] * contact)
        total += reward
    return total / STEPS


def with_error(rewards: np.ndarray) -> str:
    return f"{rewards.mean():.3f} ± {rewards.std(ddof=1) / np.sqrt(len(rewards)):.3f}"


def main() -> tuple[float, float]:
    begun = time.perf_counter()
    envs = WhiskerVectorEnv(ENVS, ticks=40, set=SECONDS)
    rng = np.random.default_rng(1)
    # Degrees, and degrees a unit of contact.
    mean, spread = np.array([80.0, 0.0]), np.array([20.0, 20.0])
    first = play(envs, np.tile(mean, (ENVS, 1)), seed=10_000)
    for n in range(ROUNDS):
        lines = rng.normal(mean, spread, (ENVS, 2))
        rewards = play(envs, lines, seed=1000 * n)
        best = lines[np.argsort(rewards)[-ENVS // 10 :]]
        mean, spread = best.mean(axis=0), best.std(axis=0) + 0.2
    last = play(envs, np.tile(mean, (ENVS, 1)), seed=20_000)
    print(f"before: {with_error(first)} a step; after: {with_error(last)}")
    print(f"setpoint = {mean[0]:.1f}° {mean[1]:+.1f}° × contact; {time.perf_counter() - begun:.1f} s")
    return first.mean(), last.mean()


if __name__ == "__main__":
    main()
