"""The vector environment's numbers are those of separate environments: bit for bit where arithmetic is strict."""

from functools import partial

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.environments import StationKeepingEnv
from support.fleet import everything
from support.listening_task import TASK as LISTENING
from support.separate import (
    Separate,
    agreeing_reports,
    assert_flights_agree,
    assert_infos_are,
    assert_step_is,
    info_of,
    same,
)
from support.sweeps import sweep
from support.travellers import driven_by_wrenches

import dq_marine  # noqa: F401 - registers
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/StationKeeping-v0"
EXTREME = {"substeps": 1, "control_period": 0.5, "workspace_radius": 1e4, "start_radius": 1.0}
"""Steps so long and workspaces so large that fast bodies give the integrator trouble."""


def some_axes():
    vehicle = load_vehicle("bluerov2_heavy")
    limits = vehicle.limits.model_copy(update={"wrench": (100.0, 0.0, 100.0, 0.0, 0.0, 30.0)})
    return vehicle.model_copy(update={"limits": limits})


# Strict arithmetic: the same bits


@pytest.mark.parametrize("threads", [1, 2, 3, None])
@pytest.mark.parametrize("count", [1, 3, 8, 13, 20])
def test_flights_are_the_same_for_any_number_of_environments_and_threads(count, threads):
    limits = {"max_episode_steps": 20, "workspace_radius": 2.5}
    envs = gym.make_vec(ID, num_envs=count, threads=threads, **limits)
    assert_flights_agree(envs, Separate(count, **limits), 70, seed=count)


@pytest.mark.sweep
def test_a_tasks_own_instruments_draw_the_same_errors():
    """What `sense` draws, and how often a reading is lost, in every lane and after a reset."""
    envs, separate = (
        gym.make_vec(LISTENING, num_envs=5, max_episode_steps=40),
        Separate(5, LISTENING, max_episode_steps=40),
    )
    assert_flights_agree(envs, separate, 100, seed=4)
    lost = [env.unwrapped.measured["lost"] for env in separate.envs]
    assert 0.0 < max(lost) < 40.0


GAUSS_MARKOV = {"mean": (0.1, 0.0, 0.0), "standard_deviation": 0.2, "correlation_time": 5.0}
PROFILE = {"depths": (3.0, 5.0, 8.0), "velocities": ((0.5, 0.0), (0.2, 0.3), (-0.4, 0.0))}
KEYWORDS = {
    "still water": {"current": 0.0, "substeps": 1, "start_radius": 0.0},
    "fixed current": {
        "current": (0.2, -0.1, 0.05), "control_period": 0.03, "substeps": 3, "goal_position": (1.0, -2.0, 3.0),
    },
    "reward": {
        "reward": {"position": 0.1, "effort": 0.5, "attitude_width": 2.0}, "workspace_radius": 40.0, "current": 2.0,
    },
    "paper": {"scheme": "paper"},
    "three axes": {"vehicle": some_axes(), "start_radius": 5.0},
    "thrusters": {"actuation": "thrusters"},
    "actuators of every kind": {"actuation": "thrusters", "vehicle": everything(), "current": 0.0},
    "profile": {"current": PROFILE},
    "Gauss-Markov": {"current": GAUSS_MARKOV},
    "Gauss-Markov, gauss": {"current": GAUSS_MARKOV, "scheme": "gauss", "order": 8, "substeps": 1},
    "Gauss-Markov, runge_kutta": {
        "current": GAUSS_MARKOV, "scheme": "runge_kutta", "order": 8, "substeps": 1,
    },
    "Gauss-Markov, galerkin": {"current": GAUSS_MARKOV, "scheme": "galerkin", "order": 4, "substeps": 1},
    "all but actuators and wind": driven_by_wrenches() | {"max_episode_steps": 20},
}  # fmt: skip


@pytest.mark.parametrize("name", sweep(KEYWORDS, plain=("fixed current", "reward")))
def test_flights_are_the_same_whatever_the_keywords(name):
    keywords = KEYWORDS[name]
    envs = gym.make_vec(ID, num_envs=5, **keywords)
    assert_flights_agree(envs, Separate(5, **keywords), 60)


def test_a_whole_episode_and_the_next_are_the_same():
    assert_flights_agree(gym.make_vec(ID, num_envs=3), Separate(3), 320, scale=0.3)


@settings(max_examples=10)
@given(seed=st.integers(0, 2**100))
def test_an_episode_follows_from_its_seed(seed):
    assert_flights_agree(gym.make_vec(ID, num_envs=5), Separate(5), 10, seed=seed)


def test_thousands_of_starts_are_the_same():
    """Rare branches of the random draws too, and episode after episode from one generator."""
    count, single = 500, StationKeepingEnv()
    envs = gym.make_vec(ID, num_envs=count)
    resets = [envs.reset(seed=1000), *(envs.reset() for _ in range(3))]
    ends = envs.call("get_state")
    at_goal = 0
    for i in range(count):
        for seed, (observations, infos) in zip((1000 + i, None, None, None), resets, strict=True):
            observation, info = single.reset(seed=seed)
            assert same(observations[i], observation)
            assert np.array_equal(infos["current_ned"][i], info["current_ned"])
            at_goal += info["position_error"] == 0.0
        assert same(ends[i], single.get_state())
    assert 100 < at_goal < 300


# Trouble


def speeds(velocities):
    return [{"velocity": velocity, "position": (0.0, 0.0, 5.0)} for velocity in velocities]


@pytest.mark.parametrize("scheme", sweep(["midpoint", "paper"], plain=["midpoint"]))
def test_fallback_and_refused_steps_are_those_of_separate_environments(scheme):
    """Environments that are solved, take the fallback or are refused, side by side: none disturbs its neighbours."""
    slow, fallbacks = (0.3, 0.0, 0.1, 0.0, 0.2, 0.0), (30.0, 30.0, 0.0, 5.0, 80.0, 9.0)
    refused = (3e4, 3e4, 0.0, 5e3, 8e4, 9e3)
    velocities = np.array(
        [slow, refused, slow, fallbacks, slow, slow, fallbacks, refused, slow, slow, refused]
    )
    envs = gym.make_vec(ID, num_envs=11, scheme=scheme, **EXTREME)
    separate = Separate(11, scheme=scheme, **EXTREME)
    envs.reset(seed=0, options={"velocity": velocities, "position": (0.0, 0.0, 5.0)})
    separate.reset(0, speeds(velocities))
    reasons = set()
    for _ in range(6):
        before = envs.get_attr("position_ned")
        expected = separate.step(np.zeros((11, 6)))
        result = envs.step(np.zeros((11, 6)))
        assert_step_is(result, expected)
        refusals = result[-1]["refused"]
        assert result[2][refusals].all()
        assert sorted(envs.refusals) == np.flatnonzero(refusals).tolist()
        for i in np.flatnonzero(refusals).tolist():
            assert np.array_equal(envs.get_attr("position_ned")[i], before[i])
            assert agreeing_reports(envs.refusals[i], separate.envs[i].unwrapped.refusal)
            reasons.add(envs.refusals[i]["refused"])
    assert reasons
    fallbacks = envs.get_attr("fallback_substeps")
    assert fallbacks == tuple(env.unwrapped.fallback_substeps for env in separate.envs)
    assert fallbacks[3] > 0
    assert fallbacks[0] == 0
    assert same(envs.call("get_state"), separate.states())


def test_the_end_by_a_refusal_is_kept_in_the_final_info():
    velocities = np.array([[0.1] * 6, [3e4, 3e4, 0.0, 5e3, 8e4, 9e3], [0.1] * 6])
    envs = gym.make_vec(ID, num_envs=3, autoreset_mode="SameStep", **EXTREME)
    separate = Separate(3, **EXTREME)
    envs.reset(seed=0, options={"velocity": velocities, "position": (0.0, 0.0, 5.0)})
    separate.reset(0, speeds(velocities))
    for _ in range(10):
        expected = separate.step(np.zeros((3, 6)))
        *_, terminated, _, infos = envs.step(np.zeros((3, 6)))
        if terminated.any():
            break
    assert terminated.tolist() == [False, True, False]
    assert infos["_final_info"].tolist() == [False, True, False]
    assert not infos["refused"].any()
    final = infos["final_info"]
    assert final["refused"].tolist() == [False, True, False]
    own, single = info_of(final, 1), expected[1][-1]
    assert own.keys() == single.keys()
    assert all(np.array_equal(own[name], single[name]) for name in single)


@settings(max_examples=30)
@given(seed=st.integers(0, 2**31), logs=st.lists(st.floats(-1.0, 150.0), min_size=7, max_size=7))
def test_extreme_speeds_are_those_of_separate_environments(seed, logs):
    random = np.random.default_rng(seed)
    velocities = random.normal(size=(7, 6)) * 10.0 ** np.array(logs)[:, None]
    envs, separate = gym.make_vec(ID, num_envs=7, **EXTREME), Separate(7, **EXTREME)
    observations, infos = envs.reset(seed=seed, options={"velocity": velocities})
    expected = separate.reset(seed, [{"velocity": velocity} for velocity in velocities])
    assert same(list(observations), [observation for observation, _ in expected])
    assert_infos_are(infos, [info for _, info in expected])
    for actions in random.uniform(-1.0, 1.0, (4, 7, 6)):
        assert_step_is(envs.step(actions), separate.step(actions))


# Other arithmetic: close, and as safe

ARITHMETICS = [
    ("fast", "float64", 1e-12, 150.0),
    ("strict", "float32", 1e-3, 15.0),
    ("fast", "float32", 1e-3, 15.0),
]
"""Arithmetic, precision, how far from the strict float64 result, and how large powers of ten it may meet."""


@pytest.mark.sweep  # in a plain run it is tests/backend/test_lane_elementary.py that computes in other arithmetic
@pytest.mark.parametrize(("arithmetic", "precision", "tolerance", "_"), ARITHMETICS)
def test_other_arithmetic_stays_close(arithmetic, precision, tolerance, _):
    count = 13
    envs = gym.make_vec(ID, num_envs=count, arithmetic=arithmetic, precision=precision)
    separate = Separate(count)
    observations, infos = envs.reset(seed=0)
    expected = separate.reset(0)
    close = partial(np.testing.assert_allclose, rtol=tolerance, atol=tolerance)
    in_float32 = partial(np.testing.assert_allclose, rtol=1e-6, atol=max(tolerance, 1e-6))
    for actions in np.random.default_rng(0).uniform(-1.0, 1.0, (20, count, 6)):
        observations, rewards, terminated, truncated, infos = envs.step(actions)
        expected = separate.step(actions)
        assert (observations.dtype, rewards.dtype) == (np.float32, np.float64)
        assert {infos[key].dtype for key in ("position_error", "attitude_error")} == {np.dtype(np.float64)}
        assert not terminated.any()
        assert not truncated.any()
        in_float32(observations, [one[0] for one in expected])
        close(rewards, [one[1] for one in expected])
        for key in ("position_error", "attitude_error"):
            close(infos[key], [one[-1][key] for one in expected])
    close(np.array(envs.get_attr("position_ned")), [env.unwrapped.position_ned for env in separate.envs])


@pytest.mark.sweep
@pytest.mark.parametrize(("arithmetic", "precision", "_", "__"), ARITHMETICS)
def test_other_arithmetic_repeats_itself_through_ends(arithmetic, precision, _, __):
    keywords = {
        "arithmetic": arithmetic,
        "precision": precision,
        "max_episode_steps": 7,
        "workspace_radius": 2.05,
    }
    flights = []
    for _ in range(2):
        envs = gym.make_vec(ID, num_envs=13, **keywords)
        flights.append([envs.reset(seed=2)])
        ends = 0
        for actions in np.random.default_rng(0).uniform(-1.0, 1.0, (40, 13, 6)):
            flights[-1].append(envs.step(actions))
            ends += (flights[-1][-1][2] | flights[-1][-1][3]).sum()
        assert ends > 20
    assert same(*flights)


@pytest.mark.sweep
@pytest.mark.parametrize(("arithmetic", "precision", "_", "largest"), ARITHMETICS)
def test_no_nan_leaves_other_arithmetic(arithmetic, precision, _, largest):
    """At any speed: a step is taken or refused, and what comes out is finite and in the observation space."""
    count, random = 13, np.random.default_rng(0)
    envs = gym.make_vec(ID, num_envs=count, arithmetic=arithmetic, precision=precision, **EXTREME)
    refused = 0
    for round_ in range(15):
        powers = random.uniform(-1.0, largest, (count, 1))
        results = [
            envs.reset(seed=round_, options={"velocity": random.normal(size=(count, 6)) * 10.0**powers})
        ]
        results += [envs.step(actions) for actions in random.uniform(-1.0, 1.0, (4, count, 6))]
        for result in results:
            assert np.isfinite(result[0]).all()
            assert envs.observation_space.contains(result[0])
            assert np.isfinite(result[-1]["position_error"]).all()
            assert np.isfinite(result[-1]["attitude_error"]).all()
            refused += result[-1]["refused"].sum()
        assert all(np.isfinite(result[1]).all() for result in results[1:])
    assert refused > 0
