"""Station keeping driven by thrusters: actions scaled to unequal limits, lags that belong to the episode."""

from __future__ import annotations

import copy
import pickle
from functools import partial

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from gymnasium.vector import AutoresetMode
from support.actuated import actuator_wrench
from support.environments import StationKeepingEnv
from support.fleet import everything, twin_screw, vehicle_with

import dq_marine  # noqa: F401 - registers
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.actuation import NO_ACTUATION
from dq_marine.simulation.scene import Scene

ID = "dq_marine/StationKeeping-v0"

same = partial(data_equivalence, exact=True)


def made(vehicle=None, **keywords):
    return StationKeepingEnv(vehicle or everything(), actuation="thrusters", current=0.0, **keywords)


@pytest.mark.sweep
def test_the_environment_checkers_pass():
    env = gym.make(ID, actuation="thrusters", vehicle=twin_screw(time_constant=0.1), current=0.0)
    check_env(env.unwrapped, skip_render_check=True)
    assert env.action_space.shape == (2,)
    assert env.unwrapped.action_names == ("port", "starboard")


@pytest.mark.sweep
def test_an_action_is_a_share_of_the_limit_on_its_side():
    env = made(twin_screw())
    env.reset(seed=0)
    for action, speeds in (
        ((1.0, -1.0), (60.0, -50.0)),
        ((0.5, -0.5), (30.0, -25.0)),
        ((9.0, 0.0), (60.0, 0.0)),
    ):
        env.step(np.array(action, dtype=np.float32))
        assert env.get_state()["memory"][-2:].tolist() == list(speeds)


def test_an_episode_is_a_body_under_its_commands():
    """The environment moves as a scene's body does, and its arrows show what the actuators do."""
    env = made()
    env.reset(seed=1)
    body = Scene(env.vehicle, step=0.025, actuation="thrusters").stepper()
    state = body.get_state()
    state[1:15] = env.get_state()["state"]
    body.set_state(state)
    low, high = np.array([[channel.low, channel.high] for channel in env.vehicle.channels]).T
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (5, len(low))).astype(np.float32):
        env.step(action)
        body.actuate(np.where(action < 0.0, -low, high) * action, 4)
        assert np.array_equal(env.get_state()["state"], body.get_state()[1:15])
        assert env.get_state()["memory"][-len(low) :] == pytest.approx(body.actuator_values, rel=1e-14)
    expected = actuator_wrench(env.vehicle, body.actuator_values, body.relative_velocity_body)
    shown = env.snapshot()
    assert shown.wrench_body == pytest.approx(expected, rel=1e-9)
    places, forces = np.array(
        [(thrust.position_body, thrust.force_body) for thrust in shown.thrusts]
    ).swapaxes(0, 1)
    assert len(forces) == 6
    assert forces.sum(axis=0) == pytest.approx(expected[:3], rel=1e-9)
    torque = -0.08 * forces[0]  # of the one propeller that has one
    moment = np.cross(places, forces).sum(axis=0) + torque
    assert moment == pytest.approx(expected[3:], rel=1e-9)


def test_lags_are_part_of_the_state_and_gone_after_reset():
    env, other = made(), made()
    env.reset(seed=2)
    action = np.full(env.action_space.shape, 0.7, np.float32)
    for _ in range(3):
        env.step(action)
    other.set_state(env.get_state())
    for _ in range(4):
        own, theirs = env.step(-action), other.step(-action)
        assert same(own, theirs)
    env.reset()
    assert not env.get_state()["memory"].any()


@pytest.mark.parametrize("twin", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_go_on_alike(twin):
    env = made()
    env.reset(seed=3)
    env.step(np.full(env.action_space.shape, 0.5, np.float32))
    other = twin(env)
    for _ in range(3):
        action = env.action_space.sample()
        assert same(env.step(action), other.step(action))


def test_effort_is_the_mean_square_of_all_channels():
    reward = {"position": 0.0, "precision": 0.0, "attitude": 0.0, "effort": 1.0}
    env = made(reward=reward)
    env.reset(seed=0)
    action = np.linspace(-1.0, 1.0, env.action_space.shape[0]).astype(np.float32)
    assert env.step(action)[1] == pytest.approx(-float(np.mean(action.astype(float) ** 2)), rel=1e-12)


@pytest.mark.sweep  # tests/agents/training has those that are moved by wrenches
def test_the_learning_librarys_environments_are_the_same():
    from stable_baselines3.common.vec_env import DummyVecEnv

    from dq_marine.agents.training.vec_env import MarineVecEnv

    keywords = {"actuation": "thrusters", "vehicle": twin_screw(time_constant=0.2), "current": 0.0}
    keywords["max_episode_steps"] = 5
    ours = MarineVecEnv(gym.make_vec(ID, num_envs=3, autoreset_mode=AutoresetMode.SAME_STEP, **keywords))
    theirs = DummyVecEnv([partial(gym.make, ID, disable_env_checker=True, **keywords)] * 3)
    for envs in (ours, theirs):
        envs.seed(0)
    assert same(ours.reset(), theirs.reset())
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (12, 3, 2)).astype(np.float32):
        for own, expected in zip(ours.step(action)[:3], theirs.step(action)[:3], strict=True):
            assert same(own, expected)


def test_driven_by_wrenches_nothing_of_actuators_is_composed():
    for vehicle in ("bluerov2_heavy", "remus100"):
        scene = Scene(vehicle)
        assert scene.composition.actuation is NO_ACTUATION
        assert "actuators" not in scene.terms
        assert scene.composition == Scene(vehicle, actuation="wrench").composition
        assert scene.composition != Scene(vehicle, actuation="thrusters").composition


def test_what_drives_it_is_checked():
    with pytest.raises(InvalidInputError, match="'oars' is unknown; give one of"):
        StationKeepingEnv(actuation="oars")
    with pytest.raises(InvalidInputError, match="no actuators whose force is known"):
        StationKeepingEnv(vehicle_with(), actuation="thrusters")
    env = made()
    env.reset(seed=0)
    with pytest.raises(InvalidInputError, match=r"give shape \(8,\)"):
        env.step(np.zeros(6, np.float32))
