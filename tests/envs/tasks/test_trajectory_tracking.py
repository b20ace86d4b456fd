"""Trajectory tracking: the goal moves as it is said to, the reward is for being there, and its baseline is."""

import gymnasium as gym
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.sweeps import sweep

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.reading import parts_reader, shown_names
from dq_marine.agents.controllers.tracking import TrackingController
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.registry import task_called
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.envs.tasks.trajectory_tracking import (
    AHEAD,
    HEADING,
    HELD,
    POSITION,
    ROOM,
    START_TURN,
    STEERED,
)
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.integrator.body import Motion
from dq_marine.task.shapes import SHAPES
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.analysis.sheet import terminal_speed

ID = "dq_marine/TrajectoryTracking-v0"


def made(**keywords):
    return gym.make(ID, **keywords)


def flown(env, seed, periods=40):
    """Parts of the observation, goal and attitude at each instant, while nothing drives the vehicle."""
    inner = env.unwrapped
    read = parts_reader(inner, shown_names(inner))
    observation, _ = env.reset(seed=seed)
    instants = []
    for _ in range(periods):
        snapshot = inner.snapshot()
        to_ned = Rotation.from_quat(snapshot.quaternion_body_to_ned, scalar_first=True)
        instants.append((read(observation), np.array(snapshot.goal_position_ned), to_ned, inner.position_ned))
        observation = env.step(np.zeros(env.action_space.shape, np.float32))[0]
    return instants


@pytest.mark.parametrize("shape", SHAPES)
def test_what_is_shown_of_the_goal_is_how_it_moves(shape):
    env = made(shape=shape)
    period = env.unwrapped.control_period
    instants = flown(env, seed=4)
    goals = np.array([goal for _, goal, *_ in instants])
    for number in range(1, len(instants) - 20):
        parts, goal, to_ned, position = instants[number]
        np.testing.assert_allclose(to_ned.apply(parts["goal_position_body"]), goal - position, atol=1e-5)
        velocity = (goals[number + 1] - goals[number - 1]) / (2.0 * period)
        np.testing.assert_allclose(to_ned.apply(parts["goal_velocity_body"]), velocity, atol=1e-3)
        acceleration = (goals[number + 1] - 2.0 * goal + goals[number - 1]) / period**2
        np.testing.assert_allclose(to_ned.apply(parts["goal_acceleration_body"]), acceleration, atol=1e-3)
        soon = goals[number + round(AHEAD[0] / period)]
        np.testing.assert_allclose(to_ned.apply(parts["goal_position_soon_body"]), soon - position, atol=1e-5)
        later = goals[number + round(AHEAD[1] / period)]
        np.testing.assert_allclose(
            to_ned.apply(parts["goal_position_later_body"]), later - position, atol=1e-5
        )
        level = velocity * (1.0, 1.0, 0.0) / np.hypot(*velocity[:2])
        np.testing.assert_allclose(to_ned.apply(parts["goal_x_axis_body"]), level, atol=2e-3)


def test_the_point_is_never_faster_than_the_speed_asked_for():
    env = made(speed=0.25)
    for seed in range(8):
        for parts, *_ in flown(env, seed, periods=5):
            assert (
                np.hypot(*parts["goal_velocity_body"][:2]) <= 0.25 * 1.6
            )  # a part of it may be along body z
            assert np.linalg.norm(parts["goal_velocity_body"]) <= 0.25 * 1.2


@pytest.mark.parametrize("shape", SHAPES)
def test_the_baseline_stays_with_the_point_in_a_current(shape):
    env = made(shape=shape, level="medium")
    episode = fly_episode(env, controller_for(env), seed=11)
    assert episode.success
    assert episode.measured["position_error"][episode.last_third].max() < POSITION
    assert episode.measured["heading_error"][episode.last_third].max() < HEADING


def test_success_takes_some_time_on_track():
    env = made(level="easy")
    controller = controller_for(env)
    observation, info = env.reset(seed=2)
    controller.reset(env)
    on_track = 0.0
    for _ in range(300):
        assert bool(info["is_success"]) == (on_track > HELD)
        observation, *_, info = env.step(controller.act(observation))
        near = info["position_error"] < POSITION and info["heading_error"] < HEADING
        on_track = on_track + env.unwrapped.control_period if near else 0.0
    assert info["is_success"]


def test_an_episode_ends_where_the_point_is_lost():
    env = made(level="easy")
    env.reset(seed=0)
    terminated = False
    for _ in range(600):
        *_, terminated, truncated, info = env.step(np.zeros(env.action_space.shape, np.float32))
        if terminated or truncated:
            break
    assert terminated
    assert info["position_error"] > 5.0


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"shape": "square"}, "shape = 'square' is unknown; give one of"),
        ({"speed": 0.0}, "speed = 0"),
        ({"speed": float("nan")}, "speed"),
        ({"radius": 0.5}, "radius = 0.5"),
        ({"height": 9.0}, "height = 9"),
    ],
)
def test_wrong_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        made(**keywords)


def test_a_vehicle_that_cannot_keep_up_is_named():
    with pytest.warns(
        UnsuitableVehicleWarning, match=r"TrajectoryTracking-v0 cannot be done with .* propeller"
    ):
        made(vehicle="mariner")


@pytest.mark.parametrize(
    "vehicle",
    sweep(
        ["kvlcc2", "kvlcc2_l7", "npsauv", "osv83", "otter", "remus100", "supply_vessel", "tanker"],
        plain=["otter"],
    ),
)
def test_the_baseline_steers_along_with_the_point(vehicle):
    env = made(vehicle=vehicle, level="medium")
    controller = controller_for(env)
    assert isinstance(controller, TrackingController)
    for seed in range(3):
        episode = fly_episode(env, controller, seed=seed)
        assert episode.success, f"seed {seed}"


def own_parameters(vehicle, **keywords):
    """The numbers of an episode, of a vehicle of the catalogue."""
    loaded, definition = load_vehicle(vehicle), task_called(ID)
    settings = definition.checked_settings(keywords, loaded)
    return definition.parameters(settings, EpisodeContext(loaded, definition.period_for(loaded), {}))


@pytest.mark.parametrize("vehicle", ["otter", "remus100", "kvlcc2", "tanker"])
def test_vehicles_that_only_steer_start_on_their_way_beside_the_point(vehicle):
    own, task = own_parameters(vehicle), task_called(ID).task
    for seed in range(20):
        uniforms = tuple(np.random.default_rng(seed).uniform(size=task.draws))
        begun = task.start(own, uniforms)
        point = task.initial_memory(own, begun, uniforms)
        velocity = np.multiply(point.rate, point.point.slope_ned)[:2]
        off = task.measure(own, point, Motion(*begun))
        assert off.position_error <= own.size
        assert off.heading_error <= START_TURN + 1e-9
        assert begun.velocity.linear[0] == pytest.approx(np.hypot(*velocity))


@pytest.mark.parametrize("vehicle", ["otter", "osv83", "kvlcc2", "tanker", "remus100"])
def test_curves_leave_room_for_the_turns_of_a_vehicle_that_only_steers(vehicle):
    loaded, own = load_vehicle(vehicle), own_parameters(vehicle)
    assert own.radius >= ROOM * own.speed / terminal_speed(loaded, 5) * (1.0 - 1e-12)
    assert own.radius >= 8.0 * loaded.dimensions.length * (1.0 - 1e-12)
    assert own_parameters(vehicle, radius=3.0).radius == pytest.approx(3.0 * loaded.dimensions.length)


def test_vehicles_that_hold_a_pose_have_the_numbers_that_they_had():
    rov, ship = own_parameters("rexrov"), own_parameters("kvlcc2")
    assert (rov.exact.position, rov.exact.heading, rov.exact.held) == (POSITION * 2.6, HEADING, HELD)
    assert (rov.exact.stretch, rov.exact.under_way, rov.radius) == (1.0, 0.0, 8.0 * 2.6)
    assert (ship.exact.position, ship.exact.under_way) == (STEERED[0] * 320.0, 1.0)
    assert ship.exact.held == pytest.approx(50.0 * 3.0)  # 50 control periods, as of the ROV
    assert task_called(ID).at_level("medium", {"vehicle": "rexrov"})["current"] == 0.3
    slow = task_called(ID).at_level("medium", {"vehicle": "kvlcc2"})["current"]
    assert slow == pytest.approx(0.05 * cruising_speed(load_vehicle("kvlcc2")))
