"""Depth and heading: what is ordered when, what counts as settled, and whom it suits."""

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.envs.core.suitability import unable_to_dive_under_way
from dq_marine.envs.tasks.depth_heading import PERIODS, STEPS
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.vehicles import load_vehicle, vehicle_names

DEPTH_HEADING = "dq_marine/DepthHeading-v0"


def env_of(**keywords):
    return gym.make(DEPTH_HEADING, **keywords).unwrapped


def flown(env, seed, act):
    observation, info = env.reset(seed=seed)
    infos, depths = [info], [env.snapshot().goal_position_ned[2]]
    for _ in range(STEPS * PERIODS):
        observation, _, terminated, _, info = env.step(act(observation))
        assert not terminated
        infos.append(info)
        depths.append(env.snapshot().goal_position_ned[2])
    return infos, depths


def test_orders_change_after_their_time_and_each_that_is_obeyed_counts():
    env = env_of()
    controller = controller_for(env)
    env.reset(seed=0)
    controller.reset(env)
    infos, depths = flown(env, 0, controller.act)
    changes = np.flatnonzero(np.diff(depths))
    assert changes.tolist() == [PERIODS - 1, 2 * PERIODS - 1]
    obeyed = [float(info["orders_obeyed"]) for info in infos]
    assert obeyed[0] == 0.0
    assert obeyed[PERIODS] == 1.0
    assert obeyed[2 * PERIODS] == 2.0
    assert obeyed[-1] == STEPS
    assert infos[-1]["is_success"]
    assert not infos[2 * PERIODS]["is_success"]


def test_an_order_is_settled_once_all_errors_were_small_for_five_seconds():
    env = env_of()
    controller = controller_for(env)
    env.reset(seed=3)
    controller.reset(env)
    infos, _ = flown(env, 3, controller.act)
    last = infos[2 * PERIODS + 1 :]
    near = np.array(
        [
            info["depth_error"] < 0.3
            and info["heading_error"] < np.radians(3.0)
            and info["speed_error"] < 0.1 * env.episode_parameters({}).task.speed
            for info in last
        ]
    )
    settled = int(np.argmax([info["orders_obeyed"] == STEPS for info in last]))
    held = round(5.0 / env.control_period)
    assert settled >= held - 1
    assert near[settled - held + 1 : settled + 1].all()
    assert not near[settled - held - 1 : settled].all()


def test_steps_are_as_large_as_asked():
    env = env_of(depth_step=2.0, heading_step=45.0)
    step = 2.0 * max(1.0, env.vehicle.dimensions.length)
    for seed in range(20):
        _, info = env.reset(seed=seed)
        assert info["depth_error"] <= step
        assert info["heading_error"] <= np.radians(45.0) + 1e-9


def test_it_suits_what_dives_goes_ahead_and_turns():
    suited = {name for name in vehicle_names() if unable_to_dive_under_way(load_vehicle(name)) is None}
    assert suited == {"bluerov2", "bluerov2_heavy", "npsauv", "remus100", "rexrov"}
    with pytest.warns(UnsuitableVehicleWarning, match="the vehicle floats"):
        env_of(vehicle="otter")


@pytest.mark.parametrize("name", ["depth_step", "heading_step", "speed_step"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), 1e300, "far"])
def test_wrong_steps_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        env_of(**{name: value})
