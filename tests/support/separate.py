"""Separate environments to compare a vector environment with, to the last bit."""

from __future__ import annotations

from functools import partial

import gymnasium as gym
import numpy as np
from gymnasium.utils.env_checker import data_equivalence

import dq_marine  # noqa: F401 - registers

ID = "dq_marine/StationKeeping-v0"

same = partial(data_equivalence, exact=True)


class Separate:
    """Separate environments made by `gym.make`, each reset in the step after its end."""

    def __init__(self, count, task=ID, **keywords):
        self.envs = [gym.make(task, disable_env_checker=True, **keywords) for _ in range(count)]
        self.ended = [False] * count

    def reset(self, seed=None, rows=None):
        rows = rows or [None] * len(self.envs)
        self.ended = [False] * len(self.envs)
        return [
            env.reset(seed=None if seed is None else seed + i, options=row)
            for i, (env, row) in enumerate(zip(self.envs, rows, strict=True))
        ]

    def step(self, actions):
        results = []
        for i, (env, action) in enumerate(zip(self.envs, actions, strict=True)):
            if self.ended[i]:
                observation, info = env.reset()
                results.append((observation, 0.0, False, False, info))
            else:
                results.append(env.step(action))
            self.ended[i] = results[-1][2] or results[-1][3]
        return results

    def states(self):
        return tuple(env.unwrapped.get_state() for env in self.envs)


def info_of(infos, i):
    """Return what the vector environment's infos say of environment i.

    A dictionary among a single environment's infos may have become an array of dictionaries or a dictionary of arrays.
    """
    own = {}
    for key, value in infos.items():
        if not key.startswith("_") and infos[f"_{key}"][i]:
            own[key] = info_of(value, i) if isinstance(value, dict) else value[i]
    return own


def assert_infos_are(infos, expected):
    for i, info in enumerate(expected):
        own = info_of(infos, i)
        assert own.keys() == info.keys(), f"environment {i}"
        for key, value in info.items():
            assert np.array_equal(own[key], value), f"{key} of environment {i}: {own[key]}, not {value}"


def agreeing_reports(own, expected):
    """Whether two reports of a refusal agree; a residual of None may have become NaN in an array of numbers."""
    residuals = [np.nan if one["residual"] is None else one["residual"] for one in (own, expected)]
    return np.array_equal(*residuals, equal_nan=True) and own | {"residual": 0} == expected | {"residual": 0}


def assert_step_is(result, expected):
    """Whether a step of the vector environment gave what steps of separate environments gave, to the last bit."""
    *values, infos = result
    for name, own, separate in zip(
        ("observation", "reward", "terminated", "truncated"),
        values,
        zip(*expected, strict=True),
        strict=False,
    ):
        own = list(own) if name == "observation" else own.tolist()
        for i, (a, b) in enumerate(zip(own, separate, strict=True)):
            assert same(a, b), f"{name} of environment {i}: {a}, not {b}"
    assert_infos_are(infos, [one[-1] for one in expected])


def assert_flights_agree(envs, separate, periods, seed=0, scale=1.5):
    """Fly both from one seed; actions saturate now and then."""
    observations, infos = envs.reset(seed=seed)
    expected = separate.reset(seed)
    assert same(list(observations), [observation for observation, _ in expected])
    assert_infos_are(infos, [info for _, info in expected])
    random = np.random.default_rng(seed)
    for _ in range(periods):
        actions = random.uniform(-scale, scale, envs.action_space.shape).astype(np.float32)
        assert_step_is(envs.step(actions), separate.step(actions))
    assert same(envs.call("get_state"), separate.states())
