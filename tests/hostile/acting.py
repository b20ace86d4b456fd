"""Doors of things that there are: bodies, batches, environments alone and in lanes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np

import dq_marine
from hostile.keywords import ID, OPTIONS, one_of, quaternion, vector3, vector6
from hostile.values import Rng, arguments, spoilt


@dataclass(frozen=True)
class Target:
    """An object that a door acts on.

    Attributes:
        renew: brings it to its usual state.
        state: what must be the same after a refusal.
        go_on: ten steps; returns all numbers that they gave.
        restore: goes back to a state.
    """

    renew: Callable[[], Any]
    state: Callable[[], Any]
    go_on: Callable[[], list[Any]]
    restore: Callable[[Any], Any]


@functools.cache
def body_target() -> Target:
    body = dq_marine.Scene("bluerov2_heavy", current=(0.1, 0.0, 0.0)).stepper()

    def renew() -> None:
        body.reset((1.0, 2.0, 3.0), (0.6, 0.0, 0.8, 0.0), (0.5, 0.1, 0.0, 0.1, 0.2, 0.3))
        body.step((5.0, 0.0, 1.0, 0.0, 0.0, 1.0), 3)

    def go_on() -> list[Any]:
        for _ in range(10):
            body.step((1.0, 0.0, 0.0, 0.0, 0.0, 0.1))
        return [body.position_ned, body.quaternion_body_to_ned, body.velocity_body]

    body_target.body = body  # type: ignore[attr-defined]
    return Target(renew, body.get_state, go_on, body.set_state)


def drawn_body_call(rng: Rng) -> Callable[[], Any]:
    body_target()
    body = body_target.body  # type: ignore[attr-defined]
    kind = rng.integers(4)
    if kind == 0:
        given = arguments(
            rng, {"position_ned": vector3, "quaternion_body_to_ned": quaternion, "velocity_body": vector6}
        )
        return lambda: body.reset(**given)
    if kind == 1:
        given = arguments(rng, {"wrench_body": vector6, "steps": one_of(1, 5)})
        return lambda: body.step(**given)
    if kind == 2:
        state = spoilt(rng, body.get_state())
        return lambda: body.set_state(state)
    given = {"command": spoilt(rng, vector6(rng))}
    return lambda: body.actuate(**given)


@functools.cache
def batch_target() -> Target:
    batch = dq_marine.Scene("bluerov2_heavy").batch(5, threads=1)

    def renew() -> None:
        batch.reset((1.0, 2.0, 3.0), (0.6, 0.0, 0.8, 0.0), (0.5, 0.1, 0.0, 0.1, 0.2, 0.3))
        batch.step((5.0, 0.0, 1.0, 0.0, 0.0, 1.0), 3)

    def go_on() -> list[Any]:
        for _ in range(10):
            batch.step((1.0, 0.0, 0.0, 0.0, 0.0, 0.1))
        return [batch.position_ned, batch.quaternion_body_to_ned, batch.velocity_body]

    batch_target.batch = batch  # type: ignore[attr-defined]
    return Target(renew, batch.get_state, go_on, batch.set_state)


def drawn_batch_call(rng: Rng) -> Callable[[], Any]:
    batch_target()
    batch = batch_target.batch  # type: ignore[attr-defined]
    rows = lambda draw: lambda rng: np.array([draw(rng) for _ in range(5)])  # noqa: E731
    kind = rng.integers(3)
    if kind == 0:
        given = arguments(
            rng,
            {
                "position_ned": rows(vector3),
                "quaternion_body_to_ned": rows(quaternion),
                "velocity_body": rows(vector6),
            },
        )
        return lambda: batch.reset(**given)
    if kind == 1:
        given = arguments(rng, {"wrench_body": rows(vector6), "steps": one_of(1, 5)})
        return lambda: batch.step(**given)
    state = spoilt(rng, batch.get_state())
    return lambda: batch.set_state(state)


@functools.cache
def env_target() -> Target:
    env = gym.make(ID, disable_env_checker=True).unwrapped

    def renew() -> None:
        env.reset(seed=1)
        env.step(np.full(6, 0.3, np.float32))

    def go_on() -> list[Any]:
        told = []
        for _ in range(10):
            observation, reward, terminated, _, info = env.step(np.full(6, 0.1, np.float32))
            told += [observation, reward, terminated, *(np.asarray(info[name]) for name in sorted(info))]
            assert env.observation_space.contains(observation), "observation beyond its space"
        return told

    env_target.env = env  # type: ignore[attr-defined]
    return Target(renew, env.get_state, go_on, env.set_state)


def drawn_env_call(rng: Rng) -> Callable[[], Any]:
    env_target()
    env = env_target.env  # type: ignore[attr-defined]
    kind = rng.integers(3)
    if kind == 0:
        seed, options = spoilt(rng, 3), spoilt(rng, arguments(rng, OPTIONS))
        return lambda: env.reset(seed=seed, options=options)
    if kind == 1:
        action = spoilt(rng, rng.uniform(-1.0, 1.0, 6).astype(np.float32))
        return lambda: env.step(action)
    state = spoilt(rng, env.get_state())
    return lambda: env.set_state(state)


@functools.cache
def vector_target() -> Target:
    envs = gym.make_vec(ID, num_envs=3).unwrapped

    def renew() -> None:
        envs.reset(seed=1)
        envs.step(np.full((3, 6), 0.3, np.float32))

    def go_on() -> list[Any]:
        told = []
        for _ in range(10):
            observation, reward, terminated, truncated, info = envs.step(np.full((3, 6), 0.1, np.float32))
            told += [
                observation,
                reward,
                terminated,
                truncated,
                *(np.asarray(info[name]) for name in sorted(info)),
            ]
            assert envs.observation_space.contains(observation), "observation beyond its space"
        return told

    def restore(states: Any) -> None:
        for index, state in enumerate(states):
            envs.call_at(index, "set_state", state)

    vector_target.envs = envs  # type: ignore[attr-defined]
    return Target(renew, lambda: envs.call("get_state"), go_on, restore)


def drawn_vector_call(rng: Rng) -> Callable[[], Any]:
    vector_target()
    envs = vector_target.envs  # type: ignore[attr-defined]
    kind = rng.integers(4)
    if kind == 0:
        seed = spoilt(rng, [3, None, 5])
        mask = {"reset_mask": lambda rng: np.array([True, False, True])}
        options = spoilt(rng, arguments(rng, OPTIONS | mask))
        return lambda: envs.reset(seed=seed, options=options)
    if kind == 1:
        actions = spoilt(rng, rng.uniform(-1.0, 1.0, (3, 6)))
        return lambda: envs.step(actions)
    if kind == 2:
        name, values = spoilt(rng, "start_radius"), spoilt(rng, [0.5, 1.0, 2.0])
        return lambda: envs.set_attr(name, values)
    index = spoilt(rng, 1)
    return lambda: envs.watch(hostile_index(index))


def hostile_index(index: Any) -> Any:
    """An index at which there is no environment: no page is to be opened."""
    return index if not isinstance(index, int | np.integer) or not 0 <= index < 3 else -1
