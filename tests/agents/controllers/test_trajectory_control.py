"""Tracking by LQR and by MPC: they stay with the point, without an offset, by wrench and by thrusters, repeatably."""

from __future__ import annotations

import sys
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from support.sweeps import sweep

import dq_marine  # noqa: F401 - registers
from dq_marine.agents import LQRController, MPCController
from dq_marine.agents.controllers.baselines import MODEL_BASED, make_baseline
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.agents.interactive.flights import offered_agents
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrajectorySettings
from dq_marine.errors import InvalidInputError, MissingDependencyError
from dq_marine.vehicles import Vehicle, load_vehicle

ID = "dq_marine/TrajectoryTracking-v0"

each_by_lqr_and_in_ci_by_mpc = pytest.mark.parametrize("name", sweep(MODEL_BASED, plain=["lqr"]))
"""Whole episodes, which MPC takes ten times as long for; `test_mpc_keeps_to_the_limits...` is its plain one."""


def made(**keywords: Any) -> gym.Env[Any, Any]:
    return gym.make(ID, disable_env_checker=True, **{"level": "medium", **keywords})


def flown(env, controller, periods=200, seed=3):
    """Observations and actions."""
    observation, _ = env.reset(seed=seed)
    controller.reset(env)
    seen, actions = [], []
    for _ in range(periods):
        action = controller.act(observation)
        seen.append(observation)
        actions.append(action)
        observation, *_ = env.step(action)
    return np.array(seen), np.array(actions)


STAYS_WITHIN = {"bluerov2_heavy": 0.01, "bluerov2": 0.06, "rexrov": 0.01}
"""Distance from the point [m] in the last third of an episode; a BlueROV2 cannot drive its pitch."""


@each_by_lqr_and_in_ci_by_mpc
@pytest.mark.parametrize("vehicle", sweep(STAYS_WITHIN, plain=["bluerov2_heavy"]))
def test_it_stays_with_the_point_in_a_current(name, vehicle):
    env = made(vehicle=vehicle)
    controller = make_baseline(name, env)
    for seed in range(3):
        episode = fly_episode(env, controller, seed=seed)
        assert episode.success, f"seed {seed}"
        assert episode.measured["position_error"][episode.last_third].max() < STAYS_WITHIN[vehicle]
        assert np.degrees(episode.measured["heading_error"][episode.last_third]).max() < 2.0


@each_by_lqr_and_in_ci_by_mpc
def test_no_offset_is_left_by_a_steady_current(name):
    """On a circle so wide that it is all but straight, where the estimate has time to settle."""
    env = made(shape="circle", radius=400.0, level=None, current=(0.2, 0.15, 0.0))
    episode = fly_episode(env, make_baseline(name, env), seed=0)
    assert episode.measured["position_error"][-20:].max() < 2e-4
    assert episode.measured["heading_error"][-20:].max() < 2e-4


@pytest.mark.sweep  # wrenches go to thrusters as those of test_thruster_control.py do
@pytest.mark.parametrize("name", MODEL_BASED)
def test_it_drives_thrusters_too(name):
    env = made(actuation="thrusters", max_episode_steps=150)
    episode = fly_episode(env, make_baseline(name, env), seed=1)
    assert episode.success
    assert (np.abs(episode.actions) <= 1.0).all()


def test_where_nothing_is_at_its_limit_mpc_does_what_lqr_does():
    """Handed the same observations; what differs is the model along a bend, and the solver's tolerance."""
    env = made()
    lqr, mpc = LQRController.for_env(env), MPCController.for_env(env)
    observations, actions = flown(env, lqr, periods=110)
    mpc.reset(env)
    other = np.array([mpc.act(one) for one in observations])
    settled = slice(60, None)
    assert np.abs(actions[settled]).max() < 0.5
    np.testing.assert_allclose(other[settled], actions[settled], atol=5e-3)


def test_mpc_keeps_to_the_limits_and_solves_every_period():
    env = made()
    mpc = MPCController.for_env(env)
    episode = fly_episode(env, mpc, seed=7)
    assert 0.99 < np.abs(episode.actions).max() <= 1.0  # far from the point all is asked for
    assert mpc.unsolved == 0


def test_without_a_plan_lqr_flies_and_it_is_counted():
    env = made()
    hasty = read_settings("trajectory", TrajectorySettings).model_copy(update={"iterations": 1})
    mpc, lqr = MPCController.for_env(env, hasty), LQRController.for_env(env, hasty)
    observations, actions = flown(env, mpc, periods=20)
    assert mpc.unsolved == 20
    lqr.reset(env)
    first = lqr.act(observations[0])
    np.testing.assert_array_equal(first, actions[0])
    assert np.array_equal(flown(env, mpc, periods=80)[1], flown(env, lqr, periods=80)[1])


@pytest.mark.sweep  # the flight above is LQR's, which arrives in a plain run
def test_without_a_plan_it_arrives_all_the_same():
    env = made()
    hasty = read_settings("trajectory", TrajectorySettings).model_copy(update={"iterations": 1})
    assert fly_episode(env, MPCController.for_env(env, hasty), seed=0).success


def test_without_a_plan_the_one_before_goes_on():
    env = made()
    mpc = MPCController.for_env(env)
    observations, _ = flown(env, mpc, periods=10)
    left = mpc._shares_left.copy()
    mpc._problem._iterations, mpc._problem._solver = 1, None
    action = mpc.act(observations[-1])
    assert mpc.unsolved == 1
    np.testing.assert_allclose(action, left[0], atol=1e-6)
    np.testing.assert_array_equal(mpc._shares_left, left[1:])


@pytest.mark.parametrize("name", MODEL_BASED)
def test_the_same_seed_is_the_same_flight(name):
    """By the same controller after another flight, and by a new one."""
    env = made()
    controller = make_baseline(name, env)
    first = flown(env, controller, periods=40)
    flown(env, controller, periods=15, seed=9)
    for again in (flown(env, controller, periods=40), flown(env, make_baseline(name, env), periods=40)):
        np.testing.assert_array_equal(again[1], first[1])


@pytest.mark.parametrize("name", MODEL_BASED)
def test_what_it_cannot_fly_is_refused(name):
    with pytest.raises(InvalidInputError, match="does not show goal_velocity_body"):
        make_baseline(name, gym.make("dq_marine/StationKeeping-v0", disable_env_checker=True))
    with pytest.raises(
        InvalidInputError, match=r"tracks a point by steering.*fly it by the agent 'controller'"
    ):
        make_baseline(name, made(vehicle="otter"))
    ship = load_vehicle("osv83")
    quick = Vehicle.model_validate(
        ship.model_dump() | {"limits": {"wrench": (50.0 * ship.wrench_limits).tolist()}}
    )
    with pytest.raises(
        InvalidInputError, match=r"floats, and this controller's model .* the agent 'controller'"
    ):
        make_baseline(name, made(vehicle=quick, speed=5.0))


@pytest.mark.parametrize("name", MODEL_BASED)
def test_an_observation_that_is_not_finite_is_refused(name):
    env = made()
    controller = make_baseline(name, env)
    observation, _ = env.reset(seed=0)
    controller.reset(env)
    observation[1] = np.nan
    with pytest.raises(InvalidInputError, match=r"goal_position_body = \[.*nan.*\] is not finite; give what"):
        controller.act(observation)


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("position", 0.0, "greater than 0"),
        ("horizon", 3.0, "less than or equal to 2"),
        ("iterations", 0, "1"),
    ],
)
def test_wrong_settings_are_refused(tmp_path, field, value, message):
    own = read_settings("trajectory", TrajectorySettings).model_dump() | {field: value}
    file = tmp_path / "own.toml"
    file.write_text("".join(f"{name} = {number}\n" for name, number in own.items()))
    with pytest.raises(InvalidInputError, match=rf"{field} = {value}: .*{message}"):
        read_settings(file, TrajectorySettings)


@pytest.mark.parametrize(("name", "library"), [("lqr", "scipy.linalg"), ("mpc", "osqp")])
def test_without_its_library_the_message_names_the_extra(monkeypatch, name, library):
    env = made()
    for module in ("deviation", "lqr", "trajectory_control", "horizon_problem", "mpc"):
        monkeypatch.delitem(sys.modules, f"dq_marine.agents.controllers.{module}", raising=False)
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingDependencyError, match=r'pip install "dq-marine\[mpc\]"'):
        make_baseline(name, env)
    offered = offered_agents(env, baselines=["zero"], runs=[], seed=0)
    assert name not in offered
    assert "controller" in offered


def test_a_panel_offers_both_where_they_can_fly():
    offered = offered_agents(made(), baselines=[], runs=[], seed=0)
    assert list(offered) == ["controller", "zero", "random", "lqr", "mpc"]
