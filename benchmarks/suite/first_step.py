"""One process that makes something and steps it for the first time; sections run it in a process of its own.

Run, in the folder `benchmarks`: python -m suite.first_step NAME
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dq_marine import Scene

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


def paired_scene(pair: str, *, has: bool) -> Scene:
    """Return a scene with lift or with radiation memory, or the same without."""
    from dq_marine import Scene, load_vehicle
    from suite.bodies import STEP

    if pair == "memory":
        return Scene("supply_vessel", step=STEP, radiation="memory" if has else "constant")
    vehicle = load_vehicle("bluerov2_heavy")
    bare = vehicle.damping.model_copy(update={"couplings": ()})
    return Scene(vehicle if has else vehicle.model_copy(update={"damping": bare}), step=STEP)


def paired_step(pair: str, *, has: bool, bodies: int) -> None:
    """Step a body, or a batch of them."""
    scene = paired_scene(pair, has=has)
    body = scene.stepper() if bodies == 1 else scene.batch(bodies)
    body.reset()
    body.step()


PAIRED_STEPS: dict[str, Callable[[], None]] = {
    f"{pair} {'with' if has else 'without'} {name}": partial(paired_step, pair, has=has, bodies=bodies)
    for pair in ("lift", "memory")
    for has in (False, True)
    for name, bodies in (("one body", 1), ("batch", MANY))
}


def main() -> None:
    """Time the first step of what is named, and how long `import dq_marine` takes before it."""
    start = time.perf_counter()
    import dq_marine  # noqa: F401

    imported = time.perf_counter()
    {**FIRST_STEPS, **PAIRED_STEPS}[sys.argv[1]]()
    done = time.perf_counter()
    print(json.dumps({"import_s": imported - start, "first_s": done - imported}))


if __name__ == "__main__":
    main()
