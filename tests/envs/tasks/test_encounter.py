"""Encounters: what is drawn and shown, what counts as success, and that the baseline keeps clear by the rules."""

import math

import gymnasium as gym
import numpy as np
import pytest
from support.separate import Separate, assert_flights_agree
from support.sweeps import sweep

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.encounters import EncounterController
from dq_marine.agents.controllers.reading import parts_reader, shown_names
from dq_marine.errors import InvalidInputError
from dq_marine.task.imazu import IMAZU_CASES

ENCOUNTER = "dq_marine/Encounter-v0"
SHIPS = ("otter", "osv83", "supply_vessel", "tanker", "kvlcc2", "kvlcc2_l7", "mariner")


def env_of(**keywords):
    return gym.make(ENCOUNTER, **keywords).unwrapped


def flown(env, seed=0, agent=None):
    """The infos of an episode."""
    agent = agent or controller_for(env)
    observation, info = env.reset(seed=seed)
    agent.reset(env)
    infos, done = [info], False
    while not done and len(infos) < 4000:
        observation, _, done, _, info = env.step(agent.act(observation))
        infos.append(info)
    return infos


class Straight(EncounterController):
    """Goes along the route, whoever comes."""

    def act(self, observation):
        self._until_choice = 1
        return super().act(observation)


def test_a_case_shows_its_vessels_and_leaves_the_other_slots_empty():
    env = env_of()
    length = env.vehicle.dimensions.length
    read = parts_reader(env, shown_names(env))
    for case, others in enumerate(IMAZU_CASES, start=1):
        env.case = case
        observation, info = env.reset(seed=case)
        parts = read(observation)
        assert info["cpa_distance"] == pytest.approx(0.0, abs=1e-9 * length)
        assert info["goal_distance"] == pytest.approx(60.0 * length)
        for slot in range(3):
            there, *_ = parts[f"vessel_{slot + 1}_rules"]
            assert there == (slot < len(others))
            if there:
                heading = math.radians(others[slot][0])
                course = parts[f"vessel_{slot + 1}_course_level"]
                assert course == pytest.approx([math.cos(heading), math.sin(heading)], abs=1e-6)


def test_two_that_meet_head_on_and_keep_their_course_collide():
    env = env_of(case=1)
    infos = flown(env, agent=Straight(env))
    last = infos[-1]
    assert last["least_distance"] < 1.5 * env.vehicle.dimensions.length <= infos[-2]["least_distance"]
    assert last["reward/collision"] == -50.0
    assert not last["is_success"]
    assert infos[0]["cpa_time"] == pytest.approx((len(infos) + 15) * env.control_period, rel=0.05)


def test_the_least_distance_never_grows_and_success_is_the_end_of_the_route():
    infos = flown(env_of(case=5))
    assert (np.diff([info["least_distance"] for info in infos]) <= 0.0).all()
    assert infos[-1]["is_success"]
    assert infos[-1]["sides_kept"] == 1.0
    assert infos[-1]["reward/finish"] == 20.0
    assert not any(info["is_success"] for info in infos[:-1])


def test_who_is_passed_to_starboard_where_the_rules_say_port_is_no_success():
    """A controller that mistakes its left for its right: the mirrored flight, with the same distances."""
    env = env_of(case=1)
    read, names = EncounterController(env), shown_names(env)
    sizes = {one.name: one.size for one in env.observations}
    flip = np.ones(sum(sizes.values()))
    at = 0
    for name in names:
        odd = {"starboard_of_route": [0], "linear_velocity_body": [1], "angular_velocity_body": [0, 2]}
        places = odd.get(name, [1] if name.endswith("_level") or name == "down_body" else [])
        flip[[at + place for place in places]] = -1.0
        at += sizes[name]
    observation, _ = env.reset(seed=0)
    done = False
    while not done:
        action = read.act(observation * flip) * np.array([1.0, -1.0], np.float32)
        observation, _, done, _, info = env.step(action)
    assert info["sides_kept"] == 0.0
    assert info["least_distance"] > 1.5 * env.vehicle.dimensions.length
    assert not info["is_success"]


@pytest.mark.sweep
def test_lanes_with_a_case_are_single_environments_bit_for_bit():
    given = {"case": 12, "max_episode_steps": 90}
    assert_flights_agree(
        gym.make_vec(ENCOUNTER, num_envs=3, **given), Separate(3, ENCOUNTER, **given), 200, seed=1
    )


@pytest.mark.parametrize("case", sweep(range(1, 23), plain=(2, 12)))
def test_the_baseline_passes_imazus_cases(case):
    last = flown(env_of(case=case))[-1]
    assert last["is_success"], last


@pytest.mark.parametrize("vehicle", sweep(SHIPS, plain=("otter",)))
def test_the_baseline_keeps_clear_by_the_rules(vehicle):
    env = env_of(vehicle=vehicle, level="medium")
    ends = [flown(env, seed)[-1] for seed in range(6)]
    assert all(end["least_distance"] >= env.safe_distance * env.vehicle.dimensions.length for end in ends)
    assert all(end["sides_kept"] for end in ends)
    assert sum(bool(end["is_success"]) for end in ends) >= 5


@pytest.mark.parametrize("name", ["case", "vessels", "approach", "safe_distance"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), 1e300, "far", 2.5e4])
def test_wrong_keywords_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        env_of(**{name: value})
