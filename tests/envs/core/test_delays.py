"""Actions that arrive late and observations that are old: the same flight as without, shifted by the delays."""

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from support.environments import StationKeepingEnv, StationKeepingVectorEnv
from support.separate import Separate, assert_flights_agree
from support.sweeps import sweep

from dq_marine.errors import InvalidInputError
from dq_marine.simulation.settings import Settings

SENSED = {"sensors": {"dvl": {"noise": 0.02, "rate": 4.0, "dropout": 0.2}, "ahrs": {"noise": 0.01}}}
CASES = {
    "wrench": {},
    "thrusters": {"actuation": "thrusters", "current": 0.0},
    "sensors": SENSED,
    "everything": {"actuation": "thrusters", **SENSED},
}
LATE = {"action_delay": 2, "observation_delay": 3}
PERIODS = 12


def actions_for(env, count=PERIODS):
    return np.random.default_rng(1).uniform(-1.2, 1.2, (count, *env.action_space.shape))


def flight(env, actions):
    """Observations from the start on, and of each period its states, rewards and infos."""
    observations, results = [env.reset(seed=5)[0]], []
    for action in actions:
        observation, reward, _, _, info = env.step(action)
        observations.append(observation)
        results.append((env.get_state()["state"], reward, info))
    return observations, results


@pytest.mark.parametrize("case", sweep(CASES, plain=["wrench"]))
def test_a_flight_is_that_without_delays_with_its_actions_and_observations_shifted(case):
    late, prompt = StationKeepingEnv(**CASES[case], **LATE), StationKeepingEnv(**CASES[case])
    actions = actions_for(late)
    shifted = np.vstack([np.zeros((LATE["action_delay"], *late.action_space.shape)), actions])[:PERIODS]
    shown, flown = flight(late, actions)
    seen, expected = flight(prompt, shifted)
    for period, observation in enumerate(shown):
        assert np.array_equal(observation, seen[max(0, period - LATE["observation_delay"])])
    for (state, _, info), (own_state, _, own_info) in zip(flown, expected, strict=True):
        assert np.array_equal(state, own_state)
        assert info["position_error"] == own_info["position_error"]


def test_effort_is_that_of_the_action_that_was_sent():
    late = StationKeepingEnv(**LATE)
    late.reset(seed=0)
    full = np.ones(late.action_space.shape)
    _, _, _, _, sent = late.step(full)
    _, _, _, _, none = late.step(0.0 * full)
    assert sent["reward/effort"] < 0.0
    assert none["reward/effort"] == 0.0


@pytest.mark.parametrize("delays", sweep([{"action_delay": 1}, {"observation_delay": 1}, LATE], plain=[LATE]))
def test_a_delayed_episode_is_saved_copied_and_carried_with_what_is_under_way(delays):
    env = StationKeepingEnv(**delays)
    actions = actions_for(env, 10)
    flight(env, actions[:5])
    twins = [copy.deepcopy(env), pickle.loads(pickle.dumps(env)), StationKeepingEnv(**delays)]
    twins[2].set_state(env.get_state())
    for action in actions[5:]:
        own = env.step(action)
        for twin in twins:
            observation, reward, *_ = twin.step(action)
            assert np.array_equal(observation, own[0])
            assert reward == own[1]


def test_nothing_that_was_under_way_is_left_in_the_next_episode():
    env = StationKeepingEnv(**LATE)
    actions = actions_for(env)
    first, again = flight(env, actions), flight(env, actions)
    for one, other in zip(first[0], again[0], strict=True):
        assert np.array_equal(one, other)


def test_gymnasiums_checker_passes():
    check_env(StationKeepingEnv(**LATE), skip_render_check=True)


@pytest.mark.sweep
@pytest.mark.parametrize("case", CASES)
def test_lanes_are_late_as_single_environments_are(case):
    keywords = CASES[case] | LATE | {"max_episode_steps": 7}
    count = 5
    envs = gym.make_vec("dq_marine/StationKeeping-v0", num_envs=count, **keywords)
    assert_flights_agree(envs, Separate(count, **keywords), 18, seed=3)


@pytest.mark.sweep
def test_an_episode_renewed_in_the_same_step_begins_with_nothing_under_way():
    envs = StationKeepingVectorEnv(
        3, max_episode_steps=5, autoreset_mode=AutoresetMode.SAME_STEP, action_delay=2, observation_delay=1
    )
    actions = np.ones((3, *envs.single_action_space.shape))
    envs.reset(seed=1)
    for _ in range(4):
        envs.step(actions)
    begun, *_ = envs.step(actions)
    twins = envs.call("get_state")
    shown_again, *_ = envs.step(actions)
    assert np.array_equal(shown_again, begun)
    single = StationKeepingEnv(action_delay=2, observation_delay=1)
    for index, state in enumerate(twins):
        single.set_state(state)
        single.step(np.zeros(single.action_space.shape))
        assert np.array_equal(single.get_state()["state"], envs.call("get_state")[index]["state"])


@pytest.mark.parametrize("actuation", sweep(["wrench", "thrusters"], plain=["wrench"]))
def test_what_is_drawn_of_an_action_is_what_arrives(actuation):
    env = StationKeepingEnv(actuation=actuation, action_delay=1, current=0.0)
    env.reset(seed=0)
    env.step(np.ones(env.action_space.shape))
    arriving = env.snapshot().wrench_body
    if actuation == "wrench":
        expected = np.zeros(6)
        expected[env.action_mapping.places] = env.vehicle.wrench_limits[env.action_mapping.places]
        assert np.array_equal(arriving, expected)
        assert np.array_equal(env.episode.action[env.action_mapping.places], np.ones(env.action_space.shape))
    else:
        assert np.array_equal(arriving, np.zeros(6)), "nothing has arrived"
        env.step(np.zeros(env.action_space.shape))
        assert np.abs(env.snapshot().wrench_body).max() > 1.0


@pytest.mark.sweep
def test_agents_among_others_are_shown_the_first_observation_with_the_others_in_it():
    pytest.importorskip("pettingzoo", reason="needs the extra `multi`")
    from dq_marine.envs import parallel_env

    late, prompt = (
        parallel_env(("otter", "otter"), **keywords) for keywords in ({"observation_delay": 1}, {})
    )
    shown, seen = [late.reset(seed=2)[0]], [prompt.reset(seed=2)[0]]
    for _ in range(4):
        shown.append(late.step({agent: np.full(2, 0.5, np.float32) for agent in late.agents})[0])
        seen.append(prompt.step({agent: np.full(2, 0.5, np.float32) for agent in prompt.agents})[0])
    for period, observations in enumerate(shown):
        for agent, observation in observations.items():
            assert np.array_equal(observation, seen[max(0, period - 1)][agent])


def test_what_cannot_be_late_is_refused():
    with pytest.raises(InvalidInputError, match=r"action_delay = 1\.5"):
        Settings(action_delay=1.5)
    with pytest.raises(InvalidInputError, match=r"pictures are observed.*DelayObservation"):
        gym.make("dq_marine/StationKeeping-v0", observation="pixels", observation_delay=1)
