"""Several agents by PettingZoo's interface: its own tests, and that each sees and is judged by where others are."""

import itertools
import math
import warnings

import numpy as np
import pytest

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.controllers.reading import parts_reader, shown_names
from dq_marine.errors import InvalidInputError, UnsuitableVehicleWarning

pytest.importorskip("pettingzoo", reason="needs the extra `multi`")

from pettingzoo.test import parallel_api_test, parallel_seed_test

from dq_marine.envs import parallel_env
from dq_marine.envs.core.shared_memory import task_memory
from dq_marine.envs.multi.watch import seen_from_above

pytestmark = pytest.mark.sweep
OTTERS = ("otter", "otter", "otter")


def begun(count=3, seed=0, **keywords):
    env = parallel_env(("otter",) * count, **keywords)
    env.reset(seed=seed)
    return env


def where(env, agent):
    return seen_from_above(env.env_of(agent).motion, env.origins[agent])


def test_pettingzoos_tests_pass():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(parallel_env(OTTERS), num_cycles=300)
        parallel_seed_test(lambda: parallel_env(OTTERS), num_cycles=50)


def test_an_episode_follows_from_its_seed_and_the_next_from_it():
    flights = []
    for _ in range(2):
        env, random, told = parallel_env(OTTERS), np.random.default_rng(0), []
        for seed in (7, None):
            observations, _ = env.reset(seed=seed)
            for _ in range(40):
                told += [observations[agent].tobytes() for agent in env.agents]
                actions = {agent: random.uniform(-1.0, 1.0, 2).astype(np.float32) for agent in env.agents}
                observations, rewards, *_ = env.step(actions)
                told += list(rewards.values())
        flights.append(told)
    assert flights[0] == flights[1]
    assert flights[0][0] != flights[0][len(flights[0]) // 2]


@pytest.mark.parametrize("count", [2, 3, 5, 8])
def test_all_start_apart_in_one_current_and_meet_in_the_middle(count):
    for seed in range(5):
        env = begun(count, seed, current=0.3)
        length = env.env_of("vessel_1").vehicle.dimensions.length
        currents = {tuple(env.env_of(agent).episode.current_ned.tolist()) for agent in env.agents}
        assert len(currents) == 1
        for one, other in itertools.combinations(env.agents, 2):
            assert math.dist(where(env, one).place, where(env, other).place) > 5.0 * length
        for agent in env.agents:
            place, _, bow = where(env, agent)
            assert abs(place[0] * bow[1] - place[1] * bow[0]) < length  # the way leads past the middle


def test_each_sees_the_others_where_they_are_after_every_step():
    env, random = begun(3), np.random.default_rng(1)
    read = parts_reader(env.env_of("vessel_1"), shown_names(env.env_of("vessel_1")))
    observations = {agent: env.env_of(agent).observation for agent in env.agents}
    for _ in range(60):
        for agent in env.agents:
            here = where(env, agent)
            parts = read(observations[agent])
            expected = set()
            for other in env.agents:
                if other != agent:
                    north, east = np.subtract(where(env, other).place, here.place)
                    ahead = north * here.bow[0] + east * here.bow[1]
                    expected.add((round(ahead, 3), round(here.bow[0] * east - here.bow[1] * north, 3)))
            slots = [k for k in (1, 2, 3) if parts[f"vessel_{k}_rules"][0]]
            found = [parts[f"vessel_{k}_position_level"] for k in slots]
            assert np.sort(np.array(found), axis=0) == pytest.approx(
                np.sort(np.array(list(expected)), axis=0), abs=2e-3
            )
        actions = {agent: random.uniform(-1.0, 1.0, 2).astype(np.float32) for agent in env.agents}
        observations, *_ = env.step(actions)


def test_the_least_distance_is_that_of_the_two_bodies_and_a_collision_ends_both():
    """Two that go on at full thrust, whoever comes: their episodes differ in how near they come."""
    env = parallel_env(("otter", "otter"))
    safe = 1.5 * env.env_of("vessel_1").vehicle.dimensions.length
    ends = set()
    for seed in range(12):
        env.reset(seed=seed)
        least = math.dist(where(env, "vessel_1").place, where(env, "vessel_2").place)
        while len(env.agents) == 2:
            _, _, terminated, _, infos = env.step(
                {agent: np.array([0.36, 0.0], np.float32) for agent in env.agents}
            )
            least = min(least, math.dist(where(env, "vessel_1").place, where(env, "vessel_2").place))
            for info in infos.values():
                assert info["least_distance"] == pytest.approx(least, abs=1e-6)
        if least < safe:
            assert all(terminated.values())
            assert env.agents == []
            assert not any(info["is_success"] for info in infos.values())
        ends.add(least < safe)
    assert True in ends


def test_who_is_done_leaves_and_the_others_no_longer_see_it():
    env = begun(3, seed=3)
    agents = {agent: controller_for(env.env_of(agent)) for agent in env.agents}
    observations, _ = env.reset(seed=3)
    for agent, controller in agents.items():
        controller.reset(env.env_of(agent))
    gone = []
    while env.agents:
        live = list(env.agents)
        results = env.step({agent: agents[agent].act(observations[agent]) for agent in live})
        assert all(set(result) == set(live) for result in results)
        observations = results[0]
        gone += [agent for agent in live if agent not in env.agents]
        for agent in env.agents:
            there = sum(one.present for one in task_memory(env.env_of(agent)).lookout.vessels)
            assert there >= len(env.agents) - 1
            if env.agents == live:
                assert there == len(env.agents) - 1
    assert sorted(gone) == sorted(env.possible_agents)
    assert env.step({}) == ({}, {}, {}, {}, {})


def test_the_baseline_steers_all_clear_of_one_another():
    env = parallel_env(OTTERS)
    agents = {agent: controller_for(env.env_of(agent)) for agent in env.possible_agents}
    safe = 1.5 * env.env_of("vessel_1").vehicle.dimensions.length
    for seed in range(4):
        observations, last = env.reset(seed=seed)
        for agent, controller in agents.items():
            controller.reset(env.env_of(agent))
        while env.agents:
            actions = {agent: agents[agent].act(observations[agent]) for agent in env.agents}
            observations, _, _, _, infos = env.step(actions)
            last = last | infos
        assert all(info["least_distance"] > safe for info in last.values())
        assert sum(bool(info["is_success"]) for info in last.values()) >= 2


def test_episodes_are_truncated_after_max_cycles():
    env = begun(2, max_cycles=3)
    still = np.zeros(2, np.float32)
    for cycle in range(1, 4):
        _, _, _, truncated, _ = env.step(dict.fromkeys(env.agents, still))
        assert set(truncated.values()) == {cycle == 3}
    assert env.agents == []


def test_what_cannot_be_is_refused():
    with pytest.raises(InvalidInputError, match="vehicles has 1 entries; give 2 to 8"):
        parallel_env(("otter",))
    with pytest.raises(
        InvalidInputError, match=r"no vessels that meet; give one of \['dq_marine/Encounter-v0'\]"
    ):
        parallel_env(OTTERS, "dq_marine/PathFollowing-v0")
    with pytest.raises(InvalidInputError, match="max_cycles"):
        parallel_env(OTTERS, max_cycles=0)
    with pytest.raises(InvalidInputError, match="times as long as another"):
        parallel_env(("otter", "tanker"), control_period=0.5).reset(seed=0)
    with pytest.raises(InvalidInputError, match="agent = 'vessel_9'"):
        begun(2).env_of("vessel_9")
    env = begun(2)
    with pytest.raises(InvalidInputError, match="give one of each of"):
        env.step({"vessel_1": np.zeros(2, np.float32)})
    before = env.env_of("vessel_1").get_state()["state"]
    with pytest.raises(InvalidInputError, match="not finite"):
        env.step({"vessel_1": np.zeros(2, np.float32), "vessel_2": np.full(2, np.nan, np.float32)})
    assert (env.env_of("vessel_1").get_state()["state"] == before).all()
    with pytest.warns(UnsuitableVehicleWarning):
        parallel_env(("remus100", "remus100"))
