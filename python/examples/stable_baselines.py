"""PPO of Stable-Baselines3 learns to touch gently.

    pip install stable-baselines3        # brings PyTorch: half a gigabyte and more
    python stable_baselines.py [STEPS]

Actions are from -1 to 1, as PPO expects them, and observations are normalised as they come. Prints
the mean reward of an episode of 100 steps before and after.
"""

import sys

import gymnasium
import numpy as np
from gymnasium.wrappers import RescaleAction

ENVS, STEPS, EPISODES = 8, 40_000, 16


def make() -> gymnasium.Env:
    """A whisker that gets a setpoint 50 times a second, for two seconds."""
    env = gymnasium.make("vibrissa.gym:Whisker-v0", ticks=40, set={"duration_s": 2.0})
    return RescaleAction(env, np.float32(-1.0), np.float32(1.0))


def main(steps: int = STEPS) -> tuple[float, float]:
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env
    from stable_baselines3.common.evaluation import evaluate_policy
    from stable_baselines3.common.vec_env import VecNormalize

    envs = VecNormalize(make_vec_env(make, n_envs=ENVS, seed=1), norm_reward=False)
    agent = PPO("MlpPolicy", envs, n_steps=100, batch_size=200, gamma=0.9, seed=1, device="cpu")

    def worth() -> float:
        envs.training = False
        mean, _ = evaluate_policy(agent, envs, n_eval_episodes=EPISODES)
        envs.training = True
        return mean

    before = worth()
    agent.learn(steps)
    after = worth()
    print(f"mean reward of an episode: {before:.1f} before, {after:.1f} after {steps} steps")
    return before, after


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else STEPS)
