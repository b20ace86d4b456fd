"""A push changes the momentum by the impulse of its force and by that of its moment, and nothing else."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from numpy.testing import assert_allclose, assert_array_equal
from support.fleet import vehicle_with

import dq_marine  # noqa: F401 - registers
from dq_marine.algebra.quaternion import rotation_matrix
from dq_marine.envs.core.push import FARTHEST_POINT, LARGEST_FORCE, PUSHED, push
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import spatial_momentum

TURNED = [0.8, 0.36, -0.48, 0.0]


def environment(**keywords: Any) -> Any:
    return gym.make(
        "dq_marine/StationKeeping-v0", disable_env_checker=True, current=0.0, **keywords
    ).unwrapped


@pytest.fixture(scope="module")
def env() -> Any:
    return environment()


def begin(env: Any, **options: Any) -> None:
    env.reset(
        seed=2, options={"position": [0.5, 0.2, 6.0], "quaternion": TURNED, "velocity": [0.1] * 6, **options}
    )


def test_force_and_moment_are_those_at_the_point(env) -> None:
    """By NumPy in the body's axes: M times the change of velocity is h (f, r x f)."""
    begin(env)
    before, force, point = env.velocity_body, np.array([5.0, -8.0, 3.0]), np.array([0.2, -0.1, 0.05])
    push(env, point, force)
    in_body = np.reshape(rotation_matrix(tuple(TURNED)), (3, 3)).T @ force
    wrench = np.concatenate([in_body, np.cross(point, in_body)])
    gained = env.vehicle.mass_matrix @ (env.velocity_body - before)
    assert_allclose(gained, env.control_period * wrench, rtol=1e-9, atol=1e-12)
    assert_allclose(env.position_ned, [0.5, 0.2, 6.0])


def test_what_a_free_body_gains_is_the_impulse() -> None:
    """Neutral, without righting moment, water at rest and undamped: world momentum is h sum (f, p x f) to round-off."""
    free = vehicle_with(
        buoyancy={"volume": 0.0135, "center": (0.0, 0.0, 0.0)},
        damping={"linear": (0.0,) * 6, "quadratic": (0.0,) * 6},
    )
    env = environment(vehicle=free, weather=())
    begin(env)
    rng, point = np.random.default_rng(3), np.array([0.15, 0.1, -0.1])
    begun = spatial_momentum(env.episode.body)
    impulse, moment = np.zeros(3), np.zeros(3)
    for _ in range(20):
        force = rng.normal(0.0, 5.0, 3)
        place = env.position_ned + np.reshape(rotation_matrix(env.motion.attitude), (3, 3)) @ point
        impulse += env.control_period * force
        moment += env.control_period * np.cross(place, force)
        push(env, point, force)
        assert not env.step(np.zeros(env.action_space.shape, np.float32))[4]["refused"]
    ended = spatial_momentum(env.episode.body)
    assert_allclose(np.subtract(ended.linear, begun.linear), impulse, rtol=1e-9, atol=1e-9)
    assert_allclose(np.subtract(ended.angular, begun.angular), moment, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("point", "force", "message"),
    [
        ([np.nan, 0, 0], [1.0, 0, 0], "point_body.*not finite"),
        ([0.0, 0, 0], [1.0, np.inf, 0], "force_ned.*not finite"),
        ([0.0, 0, 0], [1.0, 0], "shape"),
        ([2.0 * FARTHEST_POINT, 0, 0], [1.0, 0, 0], "at most 1000 m"),
        ([0.0, 0, 0], [0.0, 2.0 * LARGEST_FORCE, 0], "at most 1e.09 N"),
    ],
)
def test_what_is_refused_changes_no_bit(env, point, force, message) -> None:
    begin(env)
    before = env.get_state()
    with pytest.raises(InvalidInputError, match=message):
        push(env, point, force)
    assert_array_equal(env.get_state()["state"], before["state"])


def test_before_the_first_reset_nothing_can_be_pushed() -> None:
    with pytest.raises(ResetNeeded):
        push(environment(), [0.0] * 3, [1.0, 0.0, 0.0])


def test_a_push_is_over_after_its_period_and_saved_with_the_state(env) -> None:
    """The steps after it are those of an environment that was put into the state that the push led to."""
    begin(env)
    push(env, [0.1, 0.0, 0.0], [10.0, 5.0, 0.0])
    saved, action = env.get_state(), np.zeros(env.action_space.shape, np.float32)
    flown = [env.step(action)[0] for _ in range(3)]
    env.set_state(saved)
    for observation in flown:
        assert_array_equal(env.step(action)[0], observation)


def test_the_replay_says_that_it_was_pushed(tmp_path) -> None:
    env = environment(record=True)
    for pushed in (True, False):
        begin(env)
        if pushed:
            push(env, [0.0] * 3, [1.0, 0.0, 0.0])
        env.step(np.zeros(env.action_space.shape, np.float32))
        env.save_html(tmp_path / "replay.html")
        assert (f"BlueROV2 Heavy, {PUSHED}" in (tmp_path / "replay.html").read_text()) is pushed
