"""Waypoint tracking: what counts as reached, what it earns, and when an episode ends."""

import itertools

import gymnasium as gym
import numpy as np
import pytest
from support.environments import WAYPOINT_TRACKING

from dq_marine.envs.tasks.waypoint_tracking import WAYPOINTS
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.vehicles import load_vehicle, spheroid


def env_of(**keywords):
    return gym.make(WAYPOINT_TRACKING, **keywords).unwrapped


def goal_of(env):
    return np.array(env.snapshot().goal_position_ned)


def towards(env):
    """An action that drives a vehicle with all axes straight to its waypoint, and holds it upright."""
    seen = env.observation
    return np.concatenate([0.8 * seen[:3] - 0.8 * seen[9:12], -0.3 * seen[12:15]]).astype(np.float32)


def flown_to_the_end(env, seed=0):
    _, info = env.reset(seed=seed)
    steps = [(goal_of(env), env.position_ned, 0.0, info)]
    terminated = False
    while not terminated and len(steps) < 2000:
        _, reward, terminated, _, info = env.step(towards(env))
        steps.append((goal_of(env), env.position_ned, reward, info))
    return steps, terminated


def test_a_pilot_visits_all_waypoints_and_the_episode_ends_in_success():
    env = env_of()
    steps, terminated = flown_to_the_end(env)
    assert terminated
    assert steps[-1][3]["is_success"]
    reached = [float(info["waypoints_reached"]) for *_, info in steps]
    assert reached[0] == 0.0
    assert reached[-1] == WAYPOINTS
    assert set(np.diff(reached)) <= {0.0, 1.0}


def test_a_waypoint_is_reached_within_the_radius_and_then_the_next_is_shown():
    env = env_of(capture_radius=2.0)
    radius = 2.0 * env.vehicle.dimensions.length
    steps, _ = flown_to_the_end(env, seed=1)
    for before, after in itertools.pairwise(steps):
        near = np.linalg.norm(before[0] - after[1]) < radius
        assert near == (after[3]["waypoints_reached"] > before[3]["waypoints_reached"])
        if not near:
            assert np.array_equal(before[0], after[0])
    assert len({tuple(goal) for goal, *_ in steps}) == WAYPOINTS


def test_the_progress_earned_is_the_way_made_good():
    """The sum of it over an episode is the length of the legs, less what is left of each at its capture."""
    env = env_of(reward={"waypoint": 0.0, "effort": 0.0})
    steps, _ = flown_to_the_end(env, seed=2)
    earned = sum(reward for _, _, reward, _ in steps)
    legs = np.array(list(dict.fromkeys(tuple(goal) for goal, *_ in steps)))
    captures = [
        b for a, b in itertools.pairwise(steps) if b[3]["waypoints_reached"] > a[3]["waypoints_reached"]
    ]
    begun = [steps[0][1], *(one[1] for one in captures[:-1])]
    way = sum(np.linalg.norm(leg - where) for leg, where in zip(legs, begun, strict=True))
    left = sum(np.linalg.norm(leg - one[1]) for leg, one in zip(legs, captures, strict=True))
    assert earned == pytest.approx(way - left, abs=1e-9)


def test_a_vehicle_that_leaves_ends_the_episode_without_success():
    env = env_of(spacing=1.0)
    env.reset(seed=0)
    for _ in range(2000):
        *_, terminated, _, info = env.step(np.array([1.0, 0, 0, 0, 0, 0], np.float32))
        if terminated:
            break
    assert terminated
    assert not info["is_success"]
    assert info["waypoint_distance"] > 3.0 * env.vehicle.dimensions.length


def test_waypoints_of_what_floats_are_at_its_depth_and_spread_as_asked():
    env = env_of(vehicle="otter", spacing=5.0)
    spacing = 5.0 * env.vehicle.dimensions.length
    for seed in range(20):
        env.reset(seed=seed)
        step = goal_of(env) - env.position_ned
        assert step[2] == pytest.approx(0.0, abs=1e-9)
        assert np.abs(step).max() <= spacing


def test_a_vehicle_that_nothing_drives_forward_is_not_suited():
    with pytest.warns(UnsuitableVehicleWarning, match="WaypointTracking-v0 cannot be done with"):
        env_of(vehicle=spheroid(1.0, 0.2, wrench_limits=(0.0, 1.0, 1.0, 1.0, 1.0, 1.0)))


@pytest.mark.parametrize("name", ["spacing", "capture_radius"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), 1e300, "far"])
def test_wrong_distances_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        env_of(**{name: value})


def test_distances_are_in_lengths_of_the_vehicle():
    for name in ("bluerov2_heavy", "remus100"):
        env = env_of(vehicle=name)
        numbers = env.episode_parameters({}).task
        assert numbers.capture_radius == load_vehicle(name).dimensions.length
        assert numbers.step[0] == 8.0 * load_vehicle(name).dimensions.length
