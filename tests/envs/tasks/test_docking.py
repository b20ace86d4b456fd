"""Docking: who comes in straight and slowly is docked, who comes otherwise strikes the dock; the baseline docks."""

import math

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from support.sweeps import sweep

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.docking import DockingController
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.algebra.spatial import Spatial
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.registry import task_called
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.integrator.body import Motion
from dq_marine.task.docks import Approach, Dock, Funnel, Limits, approach, contact, heave_of, later
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/Docking-v0"
FUNNEL, LIMITS = Funnel(throat=0.1, length=0.5, flare=0.4), Limits(ahead=0.3, across=0.15, angle=0.2)
COORDINATE = st.floats(-20.0, 20.0)
ANGLE = st.floats(-math.pi, math.pi)


def vectors(of):
    return st.tuples(of, of, of)


def bow(ahead=0.01, starboard=0.0, below=0.0, speed=0.2, sideways=0.0, angle=0.0):
    return Approach((ahead, starboard, below), (speed, sideways, 0.0), angle)


@given(vectors(COORDINATE), vectors(ANGLE), vectors(COORDINATE), vectors(COORDINATE), ANGLE, ANGLE)
def test_a_bow_is_seen_from_the_dock_as_rotation_matrices_say(place, turned, linear, angular, course, phase):
    attitude = Rotation.from_euler("ZYX", turned)
    dock = Dock(math.cos(course), math.sin(course), 15.0, 0.4, phase, 0.8)
    to_dock = Rotation.from_euler("Z", course).inv()
    throat, sinking = (0.0, 0.0, 15.0 + 0.4 * math.sin(phase)), (0.0, 0.0, 0.32 * math.cos(phase))
    arm = np.array([1.3, 0.0, 0.0])
    seen = approach(
        dock, Motion(place, tuple(attitude.as_quat(scalar_first=True)), Spatial(angular, linear)), 1.3
    )
    np.testing.assert_allclose(
        seen.place, to_dock.apply(place + attitude.apply(arm) - throat), rtol=0.0, atol=1e-12 * 50.0
    )
    np.testing.assert_allclose(
        seen.velocity,
        to_dock.apply(attitude.apply(linear + np.cross(angular, arm)) - sinking),
        rtol=0.0,
        atol=1e-12 * 50.0,
    )
    axis = to_dock.inv().apply([1.0, 0.0, 0.0])
    assert math.cos(seen.angle) == pytest.approx(attitude.apply([1.0, 0.0, 0.0]) @ axis, abs=1e-9)


@given(ANGLE)
def test_a_dock_moves_as_it_says(phase):
    dock, step = Dock(1.0, 0.0, 15.0, 0.4, phase, 0.8), 1e-3
    before, now, after = (heave_of(later(dock, time)) for time in (-step, 0.0, step))
    assert now[1] == pytest.approx((after[0] - before[0]) / (2.0 * step), abs=1e-6)
    assert now[2] == pytest.approx((after[1] - before[1]) / (2.0 * step), abs=1e-6)


def test_a_bow_that_comes_in_straight_and_slowly_is_docked():
    done = contact(FUNNEL, LIMITS, -0.01, bow())
    assert (done.docked, done.struck) == (1.0, 0.0)
    assert done.speed == pytest.approx(0.2)


@pytest.mark.parametrize(
    "wrong",
    [
        {"speed": 0.31},
        {"sideways": 0.16},
        {"angle": 0.21},
        {"starboard": 0.11},
        {"below": -0.11},
        {"starboard": 0.08, "below": 0.08},
        {"ahead": -0.2, "starboard": 0.19},
        {"ahead": -0.4, "below": 0.27},
    ],
)
def test_a_bow_that_comes_in_otherwise_strikes_the_dock(wrong):
    done = contact(FUNNEL, LIMITS, -0.45, bow(**wrong))
    assert (done.docked, done.struck) == (0.0, 1.0)
    assert done.speed == pytest.approx(math.hypot(wrong.get("speed", 0.2), wrong.get("sideways", 0.0)))


@pytest.mark.parametrize(
    "elsewhere",
    [
        {"ahead": -0.2, "starboard": 0.17},
        {"ahead": -0.6, "below": 0.35},
        {"ahead": 0.01, "starboard": 0.5},
        {"ahead": -0.2, "starboard": 0.8},
    ],
)
def test_a_bow_in_the_funnel_before_it_or_beside_the_dock_meets_nothing(elsewhere):
    done = contact(FUNNEL, LIMITS, -0.45, bow(**elsewhere))
    assert (done.docked, done.struck, done.speed) == (0.0, 0.0, 0.0)


def test_a_bow_that_leaves_the_dock_backwards_is_not_docked():
    assert contact(FUNNEL, LIMITS, 0.02, bow()).docked == 0.0


@pytest.mark.parametrize("vehicle", sweep(["bluerov2_heavy", "remus100"], plain=["remus100"]))
def test_the_baseline_docks_in_a_current(vehicle):
    env = gym.make(ID, vehicle=vehicle, level="medium")
    controller = controller_for(env)
    assert isinstance(controller, DockingController)
    for seed in range(4):
        episode = fly_episode(env, controller, seed=seed)
        assert episode.success, f"seed {seed}"
        assert episode.measured["impact_speed"][-1] > 0.0


def test_who_goes_straight_for_the_goal_often_strikes_the_dock():
    """From beside the mouth the straight way leads through the wall; the baseline comes round to the axis."""
    env = gym.make(ID, angle=80.0)
    straight, baseline = DPController.for_env(env), controller_for(env)
    assert sum(fly_episode(env, straight, seed=seed).success for seed in range(12)) <= 8
    assert all(fly_episode(env, baseline, seed=seed).success for seed in range(12))


def test_coming_nearer_earns_what_it_changed_and_waiting_nothing():
    """However the vehicle goes about it, the shaped terms add up to potentials at the end less those at the start."""
    env = gym.make(ID)
    definition, vehicle = task_called(ID), load_vehicle("bluerov2_heavy")
    own = definition.parameters(definition.checked_settings({}, vehicle), EpisodeContext(vehicle, 0.1, {}))

    def potentials(info):
        wide = info["cross_error"] / (own.funnel.throat + own.funnel.flare * info["distance"])
        turned = math.degrees(info["angle_error"]) / 15.0
        near = math.exp(-2.0 * info["distance"] / own.distance)
        return np.array([30.0 * near, 10.0 * math.exp(-(wide**2)), 5.0 * math.exp(-(turned**2))])

    rng, (_, info) = np.random.default_rng(0), env.reset(seed=3)
    begun, earned = potentials(info), np.zeros(3)
    for _ in range(150):
        _, _, ended, _, info = env.step(rng.uniform(-1.0, 1.0, 6).astype(np.float32))
        earned += [info[f"reward/{term}"] for term in ("nearness", "cone", "angle")]
        assert not ended
    np.testing.assert_allclose(earned, potentials(info) - begun, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"distance": 1.0}, "distance = 1"),
        ({"angle": 90.0}, "angle = 90"),
        ({"heave": -1.0}, "heave = -1"),
        ({"heave_period": 0.0}, "heave_period = 0"),
        ({"contact_speed": 0.0}, "contact_speed = 0"),
        ({"contact_speed": float("nan")}, "contact_speed"),
    ],
)
def test_wrong_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        gym.make(ID, **keywords)


def test_a_vehicle_that_floats_is_named():
    with pytest.warns(UnsuitableVehicleWarning, match="floats"):
        gym.make(ID, vehicle="otter")
