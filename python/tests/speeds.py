"""How fast it is: `cargo xtask desk` runs it. Prints figures as JSON, each the median of some runs
with the least and the largest."""

import json
import resource
import statistics
import subprocess
import sys
import time

import numpy as np

import vibrissa
from vibrissa.gym import WhiskerVectorEnv

RUNS = 7
SCENE = vibrissa.SCENES["textures"]
FIRST = """
import time
begun = time.perf_counter()
import vibrissa
vibrissa.Sim("textures").run()
print(time.perf_counter() - begun)
"""


def spread(values: list[float]) -> list[float]:
    return [statistics.median(values), min(values), max(values)]


def timed(work) -> float:
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def fresh() -> float:
    done = subprocess.run([sys.executable, "-c", FIRST], check=True, capture_output=True, text=True)
    return float(done.stdout)


def steps_a_second() -> float:
    steps = 2000
    envs = WhiskerVectorEnv(128, SCENE)
    envs.reset(seed=1)
    actions = np.full((128, 1), 95.0)

    def work():
        for _ in range(steps):
            envs.step(actions)

    return 128 * steps / timed(work)


def main() -> None:
    sim = vibrissa.Sim(SCENE)

    def one() -> float:
        sim.reset()
        return timed(sim.run)

    figures = {
        "first_trace_s": spread([fresh() for _ in range(RUNS)]),
        "run_s": spread([one() for _ in range(RUNS)]),
        "hundred_s": spread([timed(lambda: vibrissa.run_many(SCENE, range(100))) for _ in range(RUNS)]),
        # Of this process, whose largest work so far the hundred are; before the environments.
        "peak_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "env_steps_s": spread([steps_a_second() for _ in range(RUNS)]),
        "python": sys.version.split()[0],
    }
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
