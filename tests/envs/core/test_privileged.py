"""The part of an observation that only the simulator knows: it is the truth, and the rest is as it was without."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from support.environments import StationKeepingEnv, StationKeepingVectorEnv

from dq_marine.envs.core.definition import PRIVILEGED
from dq_marine.errors import InvalidInputError

SCENE: dict[str, Any] = {"current": 0.5, "randomise": "default", "vehicle_pool": 4}
BOTH = ("current", "vehicle")
STEPS = 12


def parts_of(env, observation):
    """Return the privileged numbers by their names."""
    sizes = [one.size for one in env.privileged_observations]
    numbers = np.split(observation[PRIVILEGED], np.cumsum(sizes)[:-1])
    return dict(zip((one.name for one in env.privileged_observations), numbers, strict=True))


def flight(env, seed=3, steps=STEPS):
    """Yield the first observation of an episode, and what the steps after it return."""
    yield env.reset(seed=seed)[0], 0.0, {}
    rng = np.random.default_rng(0)
    for _ in range(steps):
        observation, reward, _, _, info = env.step(rng.uniform(-1.0, 1.0, 6).astype(np.float32))
        yield observation, reward, info


def rotation(quaternion):
    """The matrix whose columns are the body's axes in NED."""
    w, v = quaternion[0], quaternion[1:]
    cross = np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    return np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross


def test_the_current_is_that_of_the_water_in_the_vehicles_axes():
    env = StationKeepingEnv(**SCENE, privileged=BOTH)
    for observation, *_ in flight(env):
        current = env.info["current_ned"]
        assert np.linalg.norm(current) > 0.01
        seen = parts_of(env, observation)["current_body"]
        assert seen == pytest.approx(rotation(env.quaternion_body_to_ned).T @ current, abs=1e-6)
    env.set_current([0.0, 0.0, -0.3])
    observation, *_ = env.step(np.zeros(6, np.float32))
    down = rotation(env.quaternion_body_to_ned).T @ [0.0, 0.0, -0.3]
    assert parts_of(env, observation)["current_body"] == pytest.approx(down, abs=1e-6)


def test_the_vehicles_factors_are_those_of_the_vehicle_that_flies():
    env = StationKeepingEnv(**SCENE, privileged=BOTH)
    flown = set()
    for seed in range(8):
        observation, info = env.reset(seed=seed)
        parts, own, nominal = parts_of(env, observation), env.flown_vehicle, env.vehicle
        assert parts["mass_factor"] == pytest.approx(own.rigid_body.mass / nominal.rigid_body.mass)
        ratio = np.diag(own.added_mass_matrix) / np.diag(nominal.added_mass_matrix)
        assert parts["added_mass_factors"] == pytest.approx(ratio, rel=1e-6)
        assert parts["wrench_factors"] == pytest.approx(own.wrench_limits / nominal.wrench_limits, rel=1e-6)
        linear, before = np.diag(own.linear_damping), np.diag(nominal.linear_damping)
        known = before != 0.0
        assert parts["linear_damping_factors"][known] == pytest.approx(
            (linear / np.where(known, before, 1.0))[known]
        )
        assert (parts["linear_damping_factors"][~known] == 1.0).all()
        flown.add(int(info["vehicle"]))
    assert len(flown) > 1


def test_all_else_has_the_bits_of_an_environment_without():
    pairs = zip(
        flight(StationKeepingEnv(**SCENE, privileged=BOTH)), flight(StationKeepingEnv(**SCENE)), strict=True
    )
    for (seen, reward, info), (before, reward_before, info_before) in pairs:
        assert np.array_equal(seen["observation"], before)
        assert reward == reward_before
        assert all(np.array_equal(info[name], value) for name, value in info_before.items())


def test_lanes_have_the_bits_of_single_environments_at_the_end_of_episodes_too():
    n = 3
    envs = StationKeepingVectorEnv(
        n, max_episode_steps=5, autoreset_mode=AutoresetMode.SAME_STEP, **SCENE, privileged=BOTH
    )
    singles = [StationKeepingEnv(**SCENE, privileged=BOTH) for _ in range(n)]
    together, _ = envs.reset(seed=0)
    alone = [env.reset(seed=seed)[0] for seed, env in enumerate(singles)]
    rng = np.random.default_rng(0)
    for step in range(1, STEPS):
        for index, one in enumerate(alone):
            assert all(np.array_equal(together[part][index], one[part]) for part in one)
        actions = rng.uniform(-1.0, 1.0, envs.action_space.shape).astype(np.float32)
        together, *_, infos = envs.step(actions)
        alone = [env.step(action)[0] for env, action in zip(singles, actions, strict=True)]
        if step % 5 == 0:
            for final, one in zip(infos["final_obs"], alone, strict=True):
                assert all(np.array_equal(final[part], one[part]) for part in one)
            alone = [env.reset()[0] for env in singles]
    restored = StationKeepingEnv(**SCENE, privileged=BOTH)
    restored.set_state(envs.call("get_state")[1])
    assert np.array_equal(restored.observation[PRIVILEGED], together[PRIVILEGED][1])


def test_what_sensors_and_delays_hide_is_revealed():
    """The truth is what an environment without either observes of the same flight."""
    hidden = StationKeepingEnv(
        sensors={"dvl": {"noise": 0.3}}, observation_delay=2, current=0.5, privileged="truth"
    )
    open_ = StationKeepingEnv(current=0.5)
    differences = []
    for (seen, *_), (true, *_) in zip(flight(hidden), flight(open_), strict=True):
        parts = parts_of(hidden, seen)
        told = np.concatenate([numbers for name, numbers in parts.items() if name.startswith("true_")])
        assert np.array_equal(told, true)
        differences.append(np.abs(seen["observation"][: true.size] - true).max())
    assert min(differences) > 0.0


def test_actuators_are_told_of_where_they_drive():
    env = StationKeepingEnv(
        actuation="thrusters", randomise="lost_thruster", vehicle_pool=8, privileged=["vehicle"]
    )
    lost = set()
    for seed in range(8):
        thrust = parts_of(env, env.reset(seed=seed)[0])["thrust_factors"]
        assert thrust.shape == (8,)
        assert sorted(np.round(thrust, 4))[:2] == [0.0, 1.0]
        lost.add(int(thrust.argmin()))
    assert len(lost) > 1


def test_the_space_holds_it_and_checkers_accept_it():
    env = StationKeepingEnv(**SCENE, privileged=BOTH)
    assert set(env.observation_space.spaces) == {"observation", PRIVILEGED}
    for observation, *_ in flight(env):
        assert env.observation_space.contains(observation)
    check_env(
        gym.make("dq_marine/StationKeeping-v0", **SCENE, privileged=BOTH).unwrapped, skip_render_check=True
    )


def test_still_water_shows_a_current_of_zero_so_that_levels_are_alike():
    observation, _ = StationKeepingEnv(current=0.0, privileged="current").reset(seed=0)
    assert np.array_equal(observation[PRIVILEGED], np.zeros(3))


def test_the_parts_stand_in_one_order_however_they_are_asked_for():
    asked = StationKeepingEnv(**SCENE, sensors="auv", privileged=["truth", "current", "vehicle", "current"])
    assert asked.privileged == ("current", "vehicle", "truth")
    names = [one.name for one in asked.privileged_observations]
    assert names[:2] == ["current_body", "mass_factor"]
    assert names[-1] == f"true_{asked.definition.observations(asked.task_settings, asked.vehicle)[-1].name}"
    for nothing in (None, [], ()):
        assert StationKeepingEnv(**SCENE, privileged=nothing).observation_space.shape == (18,)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("thrust", r"privileged = 'thrust'"),
        (["current", 3], r"privileged = 3"),
        (True, r"privileged = True; give a name of \['current', 'vehicle', 'truth'\], or a list"),
        (
            "vehicle",
            r"no number of the vehicle differs between episodes; give randomise, or leave 'vehicle' out",
        ),
    ],
)
def test_what_cannot_be_shown_is_refused(given, message):
    with pytest.raises(InvalidInputError, match=message):
        StationKeepingEnv(privileged=given)


def test_pictures_have_no_such_part():
    with pytest.raises(InvalidInputError, match=r"pictures have no such part; leave one of them out"):
        gym.make("dq_marine/StationKeeping-v0", observation="pixels", privileged="current")
