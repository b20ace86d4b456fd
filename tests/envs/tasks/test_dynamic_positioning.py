"""Dynamic positioning: what is drawn, what counts as on station, and a ship that keeps its place in weather."""

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.dp_controller import within_authority
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import ControllerSettings
from dq_marine.envs.tasks.dynamic_positioning import HEADING, HELD, POSITION
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/DynamicPositioning-v0"


def made(**keywords):
    return gym.make(ID, **keywords)


def test_starts_and_headings_are_drawn_within_what_is_said():
    env = made(start_radius=12.0, heading=0.5, heading_spread=0.2)
    starts, headings = [], []
    for seed in range(60):
        _, info = env.reset(seed=seed)
        starts.append(float(info["position_error"]))
        w, *_, z = env.unwrapped.snapshot().goal_quaternion_body_to_ned
        headings.append(2.0 * np.arctan2(z, w))
    assert max(starts) <= 12.0
    assert min(starts) < 4.0
    assert 0.3 <= min(headings) < 0.4
    assert 0.6 < max(headings) <= 0.7


@pytest.mark.sweep  # whole episodes
@pytest.mark.parametrize("level", ["easy", "medium"])
def test_a_ship_keeps_its_place_by_its_thrusters(level):
    env = made(level=level)
    episode = fly_episode(env, controller_for(env), seed=1)
    assert episode.success
    assert episode.measured["position_error"][episode.last_third].max() < 1.0
    assert np.degrees(episode.measured["heading_error"][episode.last_third]).max() < 2.0


@pytest.mark.sweep
def test_on_station_means_a_minute_within_both_limits():
    env = made(level="easy")
    controller = controller_for(env)
    observation, info = env.reset(seed=0)
    controller.reset(env)
    on_station = 0.0
    seen = set()
    for _ in range(400):
        assert bool(info["is_success"]) == (on_station > HELD)
        seen.add(bool(info["is_success"]))
        observation, *_, info = env.step(controller.act(observation))
        there = info["position_error"] < POSITION and info["heading_error"] < HEADING
        on_station = on_station + env.unwrapped.control_period if there else 0.0
    assert seen == {False, True}


@pytest.mark.sweep
def test_a_ship_that_does_nothing_drifts_out_of_its_watch_circle():
    env = made(level="easy", current=0.75, watch_radius=20.0)
    env.reset(seed=2)
    for _ in range(1200):
        *_, terminated, truncated, info = env.step(np.zeros(env.action_space.shape, np.float32))
        if terminated or truncated:
            break
    assert terminated
    assert info["position_error"] > 20.0


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"watch_radius": 5.0}, "watch_radius = 5"),
        ({"start_radius": 49.0}, "start_radius = 49"),
        ({"heading": float("inf")}, "heading"),
        ({"heading_spread": -0.1}, "heading_spread = -0.1"),
    ],
)
def test_wrong_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        made(**keywords)


def test_a_vessel_without_thrusters_across_is_named():
    with pytest.warns(UnsuitableVehicleWarning, match="none that push sideways"):
        made(vehicle="tanker")


def test_the_controller_is_as_quick_as_the_actuators_allow():
    """An error of a tenth of the length asks for no more than the weakest actuated axis gives; ROVs stay alike."""
    preset = read_settings("dp_controller", ControllerSettings)
    assert within_authority(preset, load_vehicle("bluerov2_heavy")) == preset
    ship = load_vehicle("osv83")
    slowed = within_authority(preset, ship)
    wanted = slowed.position.bandwidth**2 * 0.1 * ship.dimensions.length
    given = min(one for one in ship.wrench_limits[:3] / np.diag(ship.mass_matrix)[:3] if one)
    assert wanted == pytest.approx(given)
    assert slowed.attitude.damping_ratio == preset.attitude.damping_ratio
