"""Berthing: the baseline comes alongside unharmed, who goes straight for the berth does not; whom it suits."""

import math

import gymnasium as gym
import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.berthing import BerthingController
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.registry import task_called
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning
from dq_marine.integrator.body import Motion
from dq_marine.task.berths import before_berth
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/Berthing-v0"
SUITED = ("kvlcc2", "kvlcc2_l7", "osv83", "otter", "supply_vessel", "tanker")


@pytest.mark.sweep  # whole episodes
@pytest.mark.parametrize("vehicle", SUITED)
def test_the_baseline_comes_alongside_in_current_and_wind(vehicle):
    env = gym.make(ID, vehicle=vehicle, level="medium")
    controller = controller_for(env)
    assert isinstance(controller, BerthingController)
    for seed in range(3):
        episode = fly_episode(env, controller, seed=seed)
        assert episode.success, f"seed {seed}"
        assert episode.measured["heading_error"][-1] < math.radians(5.0)
        assert max(episode.measured["impact_speed"]) <= env.unwrapped.task_settings.contact_speed


@pytest.mark.sweep
def test_the_baseline_comes_alongside_by_differential_thrust():
    env = gym.make(ID, vehicle="otter", level="medium", actuation="thrusters")
    controller = controller_for(env)
    assert all(fly_episode(env, controller, seed=seed).success for seed in range(3))


@pytest.mark.sweep
def test_who_goes_straight_for_the_berth_strikes_a_pier():
    env = gym.make(ID, pier=1.0)
    straight = DPController.for_env(env)
    struck = [fly_episode(env, straight, seed=seed).measured["impact_speed"][-1] > 0.2 for seed in range(4)]
    assert all(struck)


def test_coming_nearer_earns_what_it_changed_and_waiting_nothing():
    """However the vessel goes about it, the shaped terms add up to potentials at the end less those at the start."""
    env = gym.make(ID, vehicle="otter")
    length = load_vehicle("otter").dimensions.length
    far = 0.5 * 12.0 * length

    def potentials(info):
        near, turned = info["distance"], math.degrees(info["heading_error"]) / 5.0
        merits = (math.exp(-near / far), math.exp(-2.0 * near / length), math.exp(-(turned**2)))
        return np.array([30.0, 10.0, 5.0]) * merits

    rng, (_, info) = np.random.default_rng(0), env.reset(seed=3)
    begun, earned = potentials(info), np.zeros(3)
    for _ in range(100):
        action = rng.uniform(-1.0, 1.0, env.action_space.shape).astype(np.float32)
        _, _, ended, _, info = env.step(action)
        earned += [info[f"reward/{term}"] for term in ("nearness", "precision", "heading")]
        assert not ended
    np.testing.assert_allclose(earned, potentials(info) - begun, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("uniforms", [(0.3, 0.2, 0.0, 0.0, 0.0, 0.0), (0.8, 0.7, 0.999, 0.999, 0.999, 0.999)])
def test_starts_are_seven_to_twelve_lengths_astern_and_two_to_five_off(uniforms):
    definition, vehicle = task_called(ID), load_vehicle("osv83")
    settings = definition.checked_settings({}, vehicle)
    own = definition.parameters(settings, EpisodeContext(vehicle, 1.0, {}))
    begun = definition.task.start(own, uniforms)
    memory = definition.task.initial_memory(own, begun, uniforms)
    here = before_berth(own.harbour, memory.berth, Motion(*begun))
    first = uniforms[2] == 0.0
    assert here.place[0] / 83.0 == pytest.approx(-12.0 * 0.58 if first else -12.0, rel=1e-3)
    assert here.place[1] / 83.0 == pytest.approx(2.0 if first else 5.0, rel=1e-3)
    assert abs(here.off_parallel) == pytest.approx(math.radians(15.0), rel=3e-3)
    assert here.speed == pytest.approx(cruising_speed(vehicle) * (0.5 if first else 1.0), rel=1e-3)


def test_it_suits_vessels_that_can_be_stopped():
    unsuitable = task_called(ID).unsuitable
    assert [name for name in SUITED if unsuitable(load_vehicle(name)) is not None] == []
    assert "propeller" in unsuitable(load_vehicle("mariner"))
    with pytest.warns(UnsuitableVehicleWarning, match="float"):
        gym.make(ID, vehicle="bluerov2_heavy")


def test_current_and_wind_of_a_level_follow_the_vehicle():
    definition = task_called(ID)
    small, large = (definition.at_level("medium", {"vehicle": name}) for name in ("kvlcc2_l7", "kvlcc2"))
    ratio = cruising_speed(load_vehicle("kvlcc2")) / cruising_speed(load_vehicle("kvlcc2_l7"))
    assert large["current"] / small["current"] == pytest.approx(ratio)
    assert large["weather"][0]["speed"] / small["weather"][0]["speed"] == pytest.approx(ratio)
    osv = definition.at_level("medium", {"vehicle": "osv83"})
    assert definition.at_level("medium", {}) == {name: osv[name] for name in ("current", "weather")}
    assert definition.at_level("medium", {"vehicle": "kvlcc2", "current": 0.0})["current"] == 0.0


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"distance": 1.0}, "distance = 1"),
        ({"offing": 1.0}, "offing = 1"),
        ({"pier": 1.5}, "pier = 1.5"),
        ({"basin": 0.5}, "basin = 0.5"),
        ({"contact_speed": 0.0}, "contact_speed = 0"),
    ],
)
def test_wrong_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        gym.make(ID, **keywords)
