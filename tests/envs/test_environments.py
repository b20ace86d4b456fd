"""Environments in weather: episodes meet other stretches of it, the same for one and for many."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from support.environments import StationKeepingEnv, StationKeepingVectorEnv

import dq_marine  # noqa: F401 - registers
from dq_marine.errors import InvalidInputError
from dq_marine.physics.current.build import GaussMarkovCurrent
from dq_marine.physics.weather import Jonswap, Sea, SlowDrift, WaveLoads, Wind, Windage, weather_of
from dq_marine.physics.weather.choice import weather_terms

SEA = {"kind": "sea", "height": 1.0, "period": 5.0, "direction": 0.4, "components": 7, "seed": 2}


def flown(env, actions, seed):
    """Observations of an episode, and the final state."""
    observations = [env.reset(seed=seed)[0]]
    observations += [env.step(action)[0] for action in actions]
    return np.array(observations), env.get_state()


ACTIONS = np.random.default_rng(1).uniform(-1.0, 1.0, (12, 6)).astype(np.float32)


def test_a_dictionary_is_what_it_says():
    sea, drift, wind = weather_of(
        [SEA | {"slow_drift": True}, {"kind": "wind", "speed": 5.0, "direction_from": 1.0, "windage": {
            "frontal_area": 1.0, "lateral_area": 2.0, "length": 3.0, "height": 4.0}}]
    )  # fmt: skip
    expected = Sea(Jonswap(1.0, 5.0), 0.4, components=7, seed=2)
    assert isinstance(sea, WaveLoads)
    assert isinstance(drift, SlowDrift)
    assert sea.sea == drift.sea == expected
    assert wind == Wind(5.0, 1.0, Windage(1.0, 2.0, 3.0, 4.0))
    assert not wind.changes
    assert sea.changes


@pytest.mark.parametrize(
    ("weather", "message"),
    [
        ({"kind": "hail"}, "give 'sea' or 'wind'"),
        (SEA | {"spectrum": "flat"}, "spectrum = 'flat'"),
        (SEA | {"colour": "blue"}, "colour"),
        ({"kind": "wind"}, "speed"),
        (SEA | {"height": -1.0}, "height = -1"),
    ],
)
def test_a_wrong_dictionary_is_refused(weather, message):
    with pytest.raises(InvalidInputError, match=message):
        StationKeepingEnv(weather=[weather])


@pytest.mark.sweep
def test_episodes_meet_other_stretches_of_the_sea_and_can_be_taken_up_again():
    env = StationKeepingEnv(weather=[SEA])
    clocks = []
    for seed in range(20):
        env.reset(seed=seed)
        clocks.append(env.get_state()["clock"])
    assert min(clocks) >= 0.0
    assert max(clocks) < 1e4
    assert np.std(clocks) > 1e3
    env.reset(seed=3)
    for action in ACTIONS[:5]:
        env.step(action)
    state = env.get_state()
    first = [env.step(action)[0] for action in ACTIONS[5:]]
    other = StationKeepingEnv(weather=[SEA])
    other.set_state(state)
    again = [other.step(action)[0] for action in ACTIONS[5:]]
    assert np.array_equal(first, again)


@pytest.mark.sweep
def test_waves_move_what_holds_still_and_calm_weather_draws_nothing():
    calm, steady = StationKeepingEnv(), StationKeepingEnv(weather=[])
    rough = StationKeepingEnv(weather=[SEA])
    (quiet, state), (same, _), (moved, after) = (
        flown(env, 0.0 * ACTIONS, 5) for env in (calm, steady, rough)
    )
    assert np.array_equal(quiet, same)
    assert np.abs(moved - quiet).max() > 1e-3
    assert np.array_equal(quiet[0], moved[0])
    assert state["clock"] == 0.0
    assert state["random"] != after["random"]


WANDERING = GaussMarkovCurrent((0.2, 0.1, 0.0), 0.1, 20.0)


@pytest.mark.sweep
@pytest.mark.parametrize(("mode", "current"), [("NextStep", WANDERING), ("NextStep", 0.3), ("SameStep", 0.3)])
def test_the_vector_environment_has_the_bits_of_single_ones(mode, current):
    """Over ends of episodes, where the clock is drawn anew in compiled code."""
    count, keywords = 11, {"weather": [SEA], "current": current, "max_episode_steps": 5}
    many = StationKeepingVectorEnv(count, autoreset_mode=mode, **keywords)
    singles = [
        gym.make("dq_marine/StationKeeping-v0", disable_env_checker=True, **keywords) for _ in range(count)
    ]
    observations, _ = many.reset(seed=9)
    own = [single.reset(seed=9 + i)[0] for i, single in enumerate(singles)]
    assert np.array_equal(observations, own)
    over = [False] * count
    for action in ACTIONS:
        observations = many.step(np.tile(action, (count, 1)))[0]
        for i, single in enumerate(singles):
            if over[i] and mode == "NextStep":
                own[i], over[i] = single.reset()[0], False
                continue
            own[i], _, terminated, truncated, _ = single.step(action)
            over[i] = terminated or truncated
            if over[i] and mode == "SameStep":
                own[i] = single.reset()[0]
        assert np.array_equal(observations, own)
    states = [single.unwrapped.get_state() for single in singles]
    assert data_equivalence(many.call("get_state"), tuple(states), exact=True)
    assert len({state["clock"] for state in states}) == count


def test_the_wind_does_not_take_the_largest_current_for_the_real_one():
    """What is drawn is not known to it, so it blows over the fixed current alone."""
    wind = Wind(5.0, 0.0, Windage(1.0, 1.0, 1.0, 10.0))
    env = StationKeepingEnv(current=0.5, weather=[wind])
    (force,) = weather_terms(env.scene.weather, env.vehicle, env.scene.current_ned)
    assert force.parameters.air == pytest.approx((-5.0, 0.0, 0.0))
    assert not env.time_varying


def test_the_checker_finds_nothing():
    check_env(StationKeepingEnv(weather=[SEA]), skip_render_check=True)


@pytest.mark.sweep  # each by itself is met in a plain run
def test_a_current_that_wanders_keeps_to_the_clock_of_the_sea():
    """Its course is told in the sea's time, and does not jump when an episode begins."""
    env = StationKeepingEnv(weather=[SEA], current=WANDERING)
    for seed in range(3):
        env.reset(seed=seed)
        for action in ACTIONS[:4]:
            env.step(action)
        assert np.abs(env.velocity_body[:3]).max() < 1.0
