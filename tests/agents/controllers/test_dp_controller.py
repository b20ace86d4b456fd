"""The dynamic positioning controller: it holds station, does not wind up, and scales and turns as physics does."""

from __future__ import annotations

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from dq_marine.agents.controllers.dp_controller import DPController, Reading, place_poles
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import ControllerSettings
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import Vehicle, load_vehicle

Array = NDArray[np.float64]
GOAL = np.array([0.0, 0.0, 5.0])
PERIOD = 0.1


def about(axis: str, degrees: float) -> Array:
    """Attitude turned about a body axis, scalar first."""
    half = math.radians(degrees) / 2.0
    q = np.array([math.cos(half), 0.0, 0.0, 0.0])
    q["xyz".index(axis) + 1] = math.sin(half)
    return q


def horizontal(length: float, degrees: float) -> Array:
    return length * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), 0.0])


def start(bearing: float, attitude: Array, current: float) -> dict[str, Any]:
    """2 m away at a bearing, at rest, in 0.3 m/s towards a direction [degrees]."""
    return {
        "position": GOAL + horizontal(2.0, bearing),
        "quaternion": attitude,
        "velocity": np.zeros(6),
        "current": horizontal(0.3, current),
    }


def fly(options: dict[str, Any]) -> Episode:
    env = make_environment(DEFAULT_ENVIRONMENT)
    return fly_episode(env, DPController.for_env(env), seed=0, options=options)


def changed(**tables: dict[str, Any]) -> Vehicle:
    """The BlueROV2 Heavy with some numbers changed."""
    content = load_vehicle("bluerov2_heavy").model_dump()
    for table, values in tables.items():
        content[table].update(values)
    return Vehicle.model_validate(content)


@pytest.mark.parametrize("current", [0, 135, 270])
@pytest.mark.parametrize(("bearing", "heading"), [(0, 0), (120, 180), (200, 90), (315, -135)])
def test_settles_and_stays(current: float, bearing: float, heading: float) -> None:
    """From 2 m away in 0.3 m/s: within 5 cm and 2 degrees well before the episode ends, to the end."""
    episode = fly(start(bearing, about("z", heading), current))
    assert episode.settling_time is not None
    assert episode.settling_time < 15.0
    assert episode.measured["position_error"][-1] < 0.01
    assert episode.success


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_half_turn_about_any_axis(axis: str) -> None:
    episode = fly(start(90, about(axis, 180.0), 0))
    assert episode.settling_time is not None
    assert episode.settling_time < 15.0


def test_tilted_goal() -> None:
    """Weight and buoyancy are made up for along the true vertical, not along the goal's."""
    episode = fly({**start(0, about("z", 0.0), 90), "goal_quaternion": about("y", 60.0)})
    assert episode.settling_time is not None
    assert episode.settling_time < 15.0


def test_poles_are_where_the_preset_puts_them() -> None:
    preset = read_settings("dp_controller", ControllerSettings)
    gains = place_poles(preset)
    for axis, loop in enumerate([preset.position] * 3 + [preset.attitude] * 3):
        w, zeta = loop.bandwidth, loop.damping_ratio
        polynomial = [1.0, gains.derivative[axis], gains.proportional[axis], gains.integral[axis]]
        wanted = np.polymul([1.0, 2.0 * zeta * w, w * w], [1.0, loop.integral_rate])
        np.testing.assert_allclose(polynomial, wanted, rtol=1e-12)


@settings(max_examples=25)
@given(st.lists(st.floats(-6.0, 6.0), min_size=3, max_size=3), st.floats(-3.1, 3.1))
@example([0.5, 0.5, 0.0], 0.75)  # cut off at zero in the goal's axes, back-calculation let these two go
@example([0.78, -0.55, 0.0], 2.06)  # 1.01 and 1.9 times as far
def test_integral_does_not_wind_up(goal_body: list[float], turn: float) -> None:
    """Held fast for two minutes, it wants at most T_t k_i reach more acceleration than the actuators give.

    Or than it wants without an integral, of a goal that is far away: its integral must not be wound up against that.
    """
    vehicle = load_vehicle("bluerov2_heavy")
    controller = DPController(vehicle, PERIOD)
    preset = read_settings("dp_controller", ControllerSettings)
    rotation = np.array(
        [[math.cos(turn), -math.sin(turn), 0.0], [math.sin(turn), math.cos(turn), 0.0], [0.0, 0.0, 1.0]]
    )
    observation = np.concatenate([goal_body, rotation[:, 0], rotation[:, 1], np.zeros(9)]).astype(np.float32)
    for _ in range(1200):
        controller.act(observation)
    error = np.array([*goal_body, 0.0, 0.0, turn])
    reading = Reading(error, np.zeros(6), rotation)
    excess, without = (beyond_limits(one, reading) for one in (controller, DPController(vehicle, PERIOD)))
    for part, alone, loop in zip(
        np.split(excess, 2), np.split(without, 2), (preset.position, preset.attitude), strict=True
    ):
        allowed = preset.anti_windup_time * loop.bandwidth**2 * loop.integral_rate * loop.integral_reach
        assert np.linalg.norm(part) <= np.linalg.norm(alone) + 1.01 * allowed


def beyond_limits(controller: DPController, reading: Reading) -> Array:
    """The acceleration that a controller wants beyond what the actuators give, shape (6,)."""
    wanted, limits = controller.wrench(reading), controller.vehicle.wrench_limits
    return np.linalg.solve(controller.vehicle.mass_matrix, wanted - np.clip(wanted, -limits, limits))


def test_a_turn_that_saturates_leaves_no_integral_against_it_behind() -> None:
    """RexROV, turned away by 172 degrees, crept back at 1.3 degrees a second: back-calculation had cancelled k_p e."""
    env = gym.make("dq_marine/StationKeeping-v0", vehicle="rexrov")
    episode = fly_episode(env, DPController.for_env(env), seed=0, options=start(100, about("z", 172.0), 0))
    assert episode.success


@pytest.mark.parametrize("yaw", [37.0, 180.0])
def test_turning_the_world_turns_the_flight(yaw: float) -> None:
    """Start, goal and current turned about the goal's vertical: errors and actions are the same."""
    straight = start(30, about("z", 100.0), 250)
    turned = start(30 + yaw, about("z", 100.0 + yaw), 250 + yaw)
    flown = fly(straight)
    flown_turned = fly({**turned, "goal_quaternion": about("z", yaw)})
    # The observation is float32, hence no closer.
    np.testing.assert_allclose(
        flown_turned.measured["position_error"], flown.measured["position_error"], atol=2e-5
    )
    np.testing.assert_allclose(
        flown_turned.measured["attitude_error"], flown.measured["attitude_error"], atol=2e-5
    )
    np.testing.assert_allclose(flown_turned.actions, flown.actions, atol=2e-4)


def test_wrench_scales_with_mass() -> None:
    """Twice the body and twice the water it moves: twice the wrench, and no other pole."""
    light = load_vehicle("bluerov2_heavy")
    inertia = np.array(light.rigid_body.inertia)
    heavy = light.model_copy(
        update={
            "rigid_body": light.rigid_body.model_copy(
                update={
                    "mass": 2.0 * light.rigid_body.mass,
                    "inertia": tuple(map(tuple, (2.0 * inertia).tolist())),
                }
            ),
            "added_mass": tuple(map(tuple, (2.0 * np.array(light.added_mass)).tolist())),
            "buoyancy": light.buoyancy.model_copy(update={"volume": 2.0 * light.buoyancy.volume}),
        }
    )
    random = np.random.default_rng(1)
    reading = Reading(random.normal(size=6), random.normal(size=6), np.eye(3))
    np.testing.assert_allclose(
        DPController(heavy, PERIOD).wrench(reading),
        2.0 * DPController(light, PERIOD).wrench(reading),
        rtol=1e-12,
    )


def test_weak_thrusters_still_settle() -> None:
    """With a third of the thrust it saturates for long, and still does not overshoot out of the workspace."""
    weak = changed(limits={"wrench": [40.0, 40.0, 50.0, 12.0, 7.0, 10.0]})
    env = make_environment(DEFAULT_ENVIRONMENT, vehicle=weak, max_episode_steps=500)
    episode = fly_episode(env, DPController.for_env(env), seed=0, options=start(120, about("z", 180.0), 135))
    assert episode.settling_time is not None
    assert episode.measured["position_error"].max() < 3.0


def test_axes_without_actuator_are_left_alone() -> None:
    """A vehicle without sway gets five actions, all finite, and nothing winds up."""
    crippled = changed(limits={"wrench": [113.0, 0.0, 160.0, 34.9, 19.2, 30.2]})
    env = make_environment(DEFAULT_ENVIRONMENT, vehicle=crippled)
    controller = DPController.for_env(env)
    episode = fly_episode(env, controller, seed=3, options={"current": (0.0, 0.1, 0.0)})
    assert episode.actions.shape[1] == 5
    assert np.isfinite(episode.actions).all()
    assert np.abs(controller.integral_in_goal).max() < 2.0


def test_reset_forgets_the_integral() -> None:
    env = make_environment(DEFAULT_ENVIRONMENT)
    controller = DPController.for_env(env)
    fly_episode(env, controller, seed=5)
    assert controller.integral_in_goal.any()
    controller.reset(env)
    assert not controller.integral_in_goal.any()


def test_too_long_a_control_period_is_refused() -> None:
    with pytest.raises(InvalidInputError, match=r"control_period = 0\.5 s is too long .* below 0\.\d+ s"):
        DPController(load_vehicle("bluerov2_heavy"), 0.5)


def test_an_environment_that_shows_something_else_is_refused() -> None:
    with pytest.raises(InvalidInputError, match=r"WaypointTracking-v0 does not show goal_position_body"):
        DPController.for_env(gym.make("dq_marine/WaypointTracking-v0"))
    with pytest.raises(InvalidInputError, match="not an environment of dq_marine"):
        DPController.for_env(gym.make("CartPole-v1"))
