"""An environment with as much as possible in it, and flights that show whether two of them are one.

What an environment is made of has to be found again in other processes: forces and reward terms are functions of this
module.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from dq_marine import ForceTerm, RewardTerm
from dq_marine.algebra.spatial import Spatial


def tether(parameters, pose, twist, time):
    """Return a force against the velocity."""
    (x, y, z) = twist.linear
    return Spatial((0.0, 0.0, 0.0), (-parameters[0] * x, -parameters[0] * y, -parameters[0] * z))


def quiet(situation):
    """Return the square of the rate of turn, as a cost."""
    p, q, r = situation.motion.velocity.angular
    return -(p * p + q * q + r * r)


def everything() -> dict[str, Any]:
    """Return keywords with one of everything that an environment takes."""
    windage = {"frontal_area": 0.1, "lateral_area": 0.2, "length": 0.5, "height": 0.2}
    return {
        "vehicle": "bluerov2_heavy",
        "actuation": "thrusters",
        "current": {"mean": (0.1, 0.0, 0.0), "standard_deviation": 0.1, "correlation_time": 20.0},
        "weather": [
            {"kind": "sea", "height": 0.5, "period": 4.0, "components": 5, "seed": 2},
            {"kind": "wind", "speed": 5.0, "direction_from": 1.0, "windage": windage},
        ],
        "forces": [ForceTerm("tether", tether, (2.0,), uses_velocity=True)],
        "gravity": 9.8,
        "sensors": "auv",
        "randomise": "default",
        "vehicle_pool": 3,
        "extra_rewards": [RewardTerm("quiet", quiet, 0.1)],
        "reward": {"effort": 0.05},
    }


def driven_by_wrenches() -> dict[str, Any]:
    """Return everything but actuators and wind, which take longest to compile."""
    without = everything()
    del without["actuation"]
    return without | {"weather": without["weather"][:1]}


def actions_of(space, steps: int, seed: int = 0) -> np.ndarray:
    """Return random actions of a space, shape (steps, ...)."""
    random = np.random.default_rng(seed)
    return random.uniform(-1.0, 1.0, (steps, *space.shape)).astype(np.float32)


def flown(env, actions) -> list[Any]:
    """Return what an environment, single or vector, gives for actions; a single one is reset where an episode ends."""
    seen: list[Any] = []
    single = not hasattr(env, "num_envs")
    for action in actions:
        result = env.step(action)
        seen.append(result)
        if single and (result[2] or result[3]):
            seen.append(env.reset())
    return seen


def begun(make: Callable[[], Any], actions, *, seed: int = 3):
    """Return an environment in the middle of an episode."""
    env = make()
    env.reset(seed=seed)
    flown(env, actions)
    return env
