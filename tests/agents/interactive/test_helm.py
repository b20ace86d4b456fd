"""The helm gives what hands say, and holds the rest."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.interactive.controls import HANDS, driven, stick_positions
from dq_marine.agents.interactive.helm import Helm

TASK = "dq_marine/StationKeeping-v0"
LEVEL = {"velocity": [0.0] * 6, "quaternion": [1.0, 0.0, 0.0, 0.0], "current": [0.2, -0.1, 0.0]}


@pytest.fixture
def env():
    made = gym.make(TASK, disable_env_checker=True).unwrapped
    made.reset(seed=0, options=LEVEL)
    return made


def flown(env, helm, seconds):
    for _ in range(round(seconds / env.control_period)):
        env.step(helm.act(env.observation))


def test_the_stick_is_a_share_of_the_limits(env):
    helm = Helm(env)
    helm.hold, helm.power = False, 0.5
    helm.stick = np.array([1.0, -0.5, 0.0, 0.0, 0.0, 0.25])
    np.testing.assert_allclose(helm.act(env.observation), 0.5 * helm.stick, atol=1e-7)


def test_what_is_let_go_is_held_in_a_current(env):
    helm = Helm(env)
    helm.reset(env)
    helm.stick = np.array([0.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    flown(env, helm, 4.0)
    assert env.position_ned[0] > 0.5  # it went ahead, which is north
    depth = env.position_ned[2]
    helm.stick = np.zeros(6)
    let_go = env.position_ned
    flown(env, helm, 30.0)
    held = env.position_ned
    assert np.linalg.norm(held - let_go) < 0.05
    assert held[2] == pytest.approx(depth, abs=0.05)
    flown(env, helm, 10.0)
    assert np.linalg.norm(env.position_ned - held) < 0.01


def test_without_hold_the_current_takes_it_along(env):
    helm = Helm(env)
    helm.reset(env)
    helm.hold = False
    begun = env.position_ned
    flown(env, helm, 40.0)
    north, east, _ = env.position_ned - begun
    assert north > 3.0
    assert east < -1.5


def test_turning_by_hand_turns_what_is_held(env):
    helm = Helm(env)
    helm.reset(env)
    helm.stick = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.3])
    flown(env, helm, 2.0)
    helm.stick = np.zeros(6)
    turned = env.quaternion_body_to_ned
    flown(env, helm, 20.0)
    w, x, y, z = env.quaternion_body_to_ned
    assert 2.0 * np.arctan2(z, w) == pytest.approx(2.0 * np.arctan2(turned[3], turned[0]), abs=0.05)
    assert abs(turned[3]) > 0.1
    assert np.hypot(x, y) < 0.01  # level


def test_a_stick_has_the_axes_that_the_vehicle_has():
    env = gym.make("dq_marine/WaypointTracking-v0", vehicle="otter", disable_env_checker=True).unwrapped
    env.reset(seed=0)
    assert driven(env).tolist() == [0, 5]
    assert stick_positions(env, (0.5, -1.0)).tolist() == [0.5, 0.0, 0.0, 0.0, 0.0, -1.0]
    keys = [key for axis in HANDS.values() for key in (axis.minus, axis.plus)]
    assert len(set(keys)) == len(keys)
