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
        subject: the object.
        renew: brings it to its usual state.
        state: what must be the same after a refusal.
        go_on: ten steps; returns all numbers that they gave.
        restore: goes back to a state.
    """

    subject: Any
    renew: Callable[[], Any]
    state: Callable[[], Any]
    go_on: Callable[[], list[Any]]
    restore: Callable[[Any], Any]


def bodies_target(bodies: Any) -> Target:
    """One body or a batch of them: they are moved by the same calls."""

    def renew() -> None:
        bodies.reset((1.0, 2.0, 3.0), (0.6, 0.0, 0.8, 0.0), (0.5, 0.1, 0.0, 0.1, 0.2, 0.3))
        bodies.step((5.0, 0.0, 1.0, 0.0, 0.0, 1.0), 3)

    def go_on() -> list[Any]:
        for _ in range(10):
            bodies.step((1.0, 0.0, 0.0, 0.0, 0.0, 0.1))
        return [bodies.position_ned, bodies.quaternion_body_to_ned, bodies.velocity_body]

    return Target(bodies, renew, bodies.get_state, go_on, bodies.set_state)


@functools.cache
def body_target() -> Target:
    return bodies_target(dq_marine.Scene("bluerov2_heavy", current=(0.1, 0.0, 0.0)).stepper())


@functools.cache
def batch_target() -> Target:
    return bodies_target(dq_marine.Scene("bluerov2_heavy").batch(5, threads=1))


def drawn_body_call(rng: Rng) -> Callable[[], Any]:
    body = body_target().subject
    if rng.integers(4) == 0:
        given = {"command": spoilt(rng, vector6(rng))}
        return lambda: body.actuate(**given)
    return drawn_bodies_call(rng, body, lambda draw: draw)


def drawn_batch_call(rng: Rng) -> Callable[[], Any]:
    def rows(draw: Callable[[Rng], Any]) -> Callable[[Rng], Any]:
        return lambda rng: np.array([draw(rng) for _ in range(5)])

    return drawn_bodies_call(rng, batch_target().subject, rows)


def drawn_bodies_call(rng: Rng, bodies: Any, for_each: Callable[..., Any]) -> Callable[[], Any]:
    """A call of one body or of a batch; `for_each` makes draws for all bodies of a draw for one."""
    kind = rng.integers(3)
    if kind == 0:
        start = {"position_ned": vector3, "quaternion_body_to_ned": quaternion, "velocity_body": vector6}
        given = arguments(rng, {name: for_each(draw) for name, draw in start.items()})
        return lambda: bodies.reset(**given)
    if kind == 1:
        given = arguments(rng, {"wrench_body": for_each(vector6), "steps": one_of(1, 5)})
        return lambda: bodies.step(**given)
    state = spoilt(rng, bodies.get_state())
    return lambda: bodies.set_state(state)


def environment_target(env: Any, state: Callable[[], Any], restore: Callable[[Any], Any]) -> Target:
    """One environment or a vector of them: they are stepped by the same calls."""
    shape = env.action_space.shape

    def renew() -> None:
        env.reset(seed=1)
        env.step(np.full(shape, 0.3, np.float32))

    def go_on() -> list[Any]:
        told = []
        for _ in range(10):
            observation, reward, terminated, truncated, info = env.step(np.full(shape, 0.1, np.float32))
            told += [observation, reward, terminated, truncated]
            told += [np.asarray(info[name]) for name in sorted(info)]
            assert env.observation_space.contains(observation), "observation beyond its space"
        return told

    return Target(env, renew, state, go_on, restore)


@functools.cache
def env_target() -> Target:
    env = gym.make(ID, disable_env_checker=True).unwrapped
    return environment_target(env, env.get_state, env.set_state)


@functools.cache
def vector_target() -> Target:
    envs = gym.make_vec(ID, num_envs=3).unwrapped

    def restore(states: Any) -> None:
        for index, state in enumerate(states):
            envs.call_at(index, "set_state", state)

    return environment_target(envs, lambda: envs.call("get_state"), restore)


def drawn_env_call(rng: Rng) -> Callable[[], Any]:
    env = env_target().subject
    kind = rng.integers(3)
    if kind == 0:
        seed, options = spoilt(rng, 3), spoilt(rng, arguments(rng, OPTIONS))
        return lambda: env.reset(seed=seed, options=options)
    if kind == 1:
        action = spoilt(rng, rng.uniform(-1.0, 1.0, 6).astype(np.float32))
        return lambda: env.step(action)
    state = spoilt(rng, env.get_state())
    return lambda: env.set_state(state)


def drawn_vector_call(rng: Rng) -> Callable[[], Any]:
    envs = vector_target().subject
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
