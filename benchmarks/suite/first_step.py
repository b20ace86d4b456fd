"""One process that makes something and steps it for the first time; run by `compile_times`, in a process of its own.

Run, in the folder `benchmarks`: python -m suite.first_step NAME
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable

ID = "dq_marine/StationKeeping-v0"
MANY = 64
"""Bodies or environments, where there are many."""


def one_body() -> None:
    """Step a body."""
    from suite.bodies import full_scene

    body = full_scene().stepper()
    body.reset()
    body.step()


def batch() -> None:
    """Step a batch of bodies."""
    from suite.bodies import full_scene

    bodies = full_scene().batch(MANY)
    bodies.reset()
    bodies.step()


def environment() -> None:
    """Step a single environment."""
    import gymnasium as gym

    env = gym.make(ID)
    env.reset(seed=0)
    env.step(env.action_space.sample())


def environments() -> None:
    """Step a vector environment."""
    import gymnasium as gym

    envs = gym.make_vec(ID, num_envs=MANY)
    envs.reset(seed=0)
    envs.step(envs.action_space.sample())


FIRST_STEPS: dict[str, Callable[[], None]] = {
    "`Scene.stepper`": one_body,
    "`Scene.batch`": batch,
    "`gym.make`": environment,
    "`gym.make_vec`": environments,
}


def main() -> None:
    """Time the first step of what is named, and how long `import dq_marine` takes before it."""
    start = time.perf_counter()
    import dq_marine  # noqa: F401

    imported = time.perf_counter()
    FIRST_STEPS[sys.argv[1]]()
    done = time.perf_counter()
    print(json.dumps({"import_s": imported - start, "first_s": done - imported}))


if __name__ == "__main__":
    main()
