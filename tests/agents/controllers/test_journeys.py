"""Guidance and autopilot: the laws, and that they do what the tasks ask, at the medium level, in currents."""

import itertools
import math

import gymnasium as gym
import numpy as np
import pytest
from support.sweeps import sweep

from dq_marine.agents.controllers.autopilot import RateLoop
from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.guidance import (
    AdaptiveSight,
    level_angles,
    levelled,
    no_turn_leads_to,
    wrapped,
)
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.envs.core.suitability import cruising_speed, paced, speed_ahead
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.analysis.sheet import drag_of, terminal_speed

ANGLES = list(itertools.product((-0.4, 0.0, 0.7), (-0.9, 0.0, 0.5), (0.0, 2.0)))


@pytest.mark.parametrize(
    ("task", "name"),
    sweep(
        [
            ("PathFollowing", "PathController"),
            ("DepthHeading", "DepthHeadingController"),
            ("WaypointTracking", "WaypointController"),
        ],
        plain=[("WaypointTracking", "WaypointController")],
    ),
)
def test_the_baseline_does_the_task_in_currents(task, name):
    env = gym.make(f"dq_marine/{task}-v0", level="medium")
    controller = controller_for(env)
    assert type(controller).__name__ == name
    for seed in range(5):
        episode = fly_episode(env, controller, seed=seed)
        assert episode.success, f"seed {seed}: {episode.measured}"


@pytest.mark.parametrize("seed", sweep([5_000_021, 5_000_037, 5_000_048], plain=[5_000_021]))
def test_orders_are_obeyed_by_vehicles_that_could_not_stop_a_fast_turn(seed):
    """These are up to 20 % off the file of theirs, and swung to and fro for a minute."""
    env = gym.make("dq_marine/DepthHeading-v0", level="medium", randomise="within_20_percent")
    assert fly_episode(env, controller_for(env), seed=seed).success


@pytest.mark.sweep
def test_an_agent_that_drifts_does_none_of_them():
    """The tasks are not done by themselves."""
    for task in ("PathFollowing", "DepthHeading", "WaypointTracking"):
        env = gym.make(f"dq_marine/{task}-v0", level="medium")
        env.reset(seed=0)
        done, still = False, np.zeros(env.action_space.shape, np.float32)
        while not done:
            _, _, terminated, truncated, info = env.step(still)
            done = terminated or truncated
        assert not info["is_success"]


def followed(sight, crab, speed, error, period, seconds):
    """Cross-track error of a vehicle whose course is what the law says but for a crab angle that nobody tells it."""
    for _ in range(round(seconds / period)):
        error += period * speed * math.sin(sight.correction(error, speed) + crab)
    return error


@pytest.mark.parametrize("crab", [-0.2, 0.0, 0.15])
def test_adaptation_finds_a_crab_angle_and_plain_line_of_sight_keeps_its_offset(crab):
    adaptive = followed(AdaptiveSight(10.0, 1.0, 0.5, 0.1), crab, 1.5, 8.0, 0.1, 300.0)
    plain = followed(AdaptiveSight(10.0, 0.0, 0.5, 0.1), crab, 1.5, 8.0, 0.1, 300.0)
    assert adaptive == pytest.approx(0.0, abs=1e-3)
    assert plain == pytest.approx(10.0 * math.tan(crab), abs=1e-3)


def test_what_adaptation_finds_is_bounded_and_forgotten():
    sight = AdaptiveSight(10.0, 50.0, 0.3, 0.1)
    for _ in range(2000):
        correction = sight.correction(10.0, 1.5)
    assert correction == pytest.approx(-math.pi / 4.0 - 0.3)
    sight.reset()
    assert sight.correction(10.0, 1.5) == pytest.approx(-math.pi / 4.0)


@pytest.mark.parametrize(("roll", "pitch", "heading"), ANGLES)
def test_down_tells_roll_and_pitch_and_levels_vectors(roll, pitch, heading):
    attitude = quaternion_from_euler(roll, pitch, heading)
    level = quaternion_from_euler(0.0, 0.0, heading)
    vector_ned = (0.3, -1.2, 0.8)
    assert level_angles(rotate_inverse(attitude, (0.0, 0.0, 1.0))) == pytest.approx((roll, pitch))
    found = levelled(rotate_inverse(attitude, vector_ned), roll, pitch)
    assert rotate(level, found) == pytest.approx(vector_ned)


@pytest.mark.parametrize("radius", [0.5, 3.0])
def test_no_turn_leads_to_a_place_that_lies_to_one_side_of_all_that_leave_the_circle(radius):
    """Whoever leaves a turn goes straight on from there: where that may lead, some place on the turn points to."""
    turned = np.linspace(0.0, 2.0 * math.pi, 2001)
    left = radius * np.array([np.sin(turned), 1.0 - np.cos(turned)])
    rng = np.random.default_rng(3)
    found = set()
    for ahead, starboard in rng.uniform(-3.0 * radius, 3.0 * radius, (200, 2)):
        to_place = np.array([[ahead], [abs(starboard)]]) - left
        beside = np.cos(turned) * to_place[1] - np.sin(turned) * to_place[0]
        if abs(beside).min() > 1e-3 * radius or (beside < 0.0).any():
            found.add(no_turn_leads_to(ahead, starboard, radius))
            assert no_turn_leads_to(ahead, starboard, radius) == (beside > 0.0).all()
    assert found == {True, False}


def test_angles_are_wrapped():
    for turns in (-2, 0, 3):
        assert wrapped(0.4 + 2.0 * math.pi * turns) == pytest.approx(0.4)


def test_a_rate_loop_removes_a_steady_load_and_does_not_wind_up_beyond_its_limit():
    loop, inertia, period, rate = RateLoop(2.0, 1.0, 3.0, 1.0, 0.05), 2.0, 0.05, 0.0
    for _ in range(2000):
        rate += period * (loop.force(0.1 - rate) - 0.5) / inertia
    assert rate == pytest.approx(0.1, abs=1e-6)
    for _ in range(2000):  # nothing can reach this rate
        assert abs(loop.force(10.0)) == 1.0
    assert loop.force(-0.5) < 0.0  # and it gives way at once


@pytest.mark.parametrize("name", ["remus100", "otter", "mariner", "osv83", "kvlcc2"])
def test_drag_at_the_terminal_speed_is_the_limit(name):
    vehicle = load_vehicle(name)
    for axis in (0, 5):
        limit = vehicle.wrench_limits[axis]
        assert drag_of(vehicle, axis)(terminal_speed(vehicle, axis)) == pytest.approx(limit, rel=1e-9)


def test_control_periods_of_journeys_grow_with_the_time_for_a_length():
    found = {name: paced(load_vehicle(name)) for name in ("remus100", "kvlcc2_l7", "mariner", "kvlcc2")}
    assert found == {"remus100": 0.1, "kvlcc2_l7": 0.4, "mariner": 1.0, "kvlcc2": 3.0}


def test_a_vehicle_whose_pitch_nothing_drives_cruises_where_its_righting_moment_holds_it():
    free, driven = load_vehicle("bluerov2"), load_vehicle("bluerov2_heavy")
    added = free.added_mass_matrix
    critical = math.sqrt(free.restoring_arm[2] / (added[2, 2] - added[0, 0]))
    assert cruising_speed(free) == pytest.approx(0.6 * critical)
    assert cruising_speed(driven) == pytest.approx(0.6 * speed_ahead(driven))


def test_the_period_of_a_task_that_goes_far_is_the_vehicles_unless_it_is_given():
    env = gym.make("dq_marine/WaypointTracking-v0", control_period=0.2).unwrapped
    assert env.control_period == 0.2
    assert gym.make("dq_marine/WaypointTracking-v0").unwrapped.control_period == 0.1
