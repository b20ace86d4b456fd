"""What an environment does when the integrator has trouble: fallbacks counted, refusals told, never a NaN."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.environments import StationKeepingEnv
from support.sweeps import sweep


@pytest.mark.parametrize("scheme", sweep(["midpoint", "paper"], plain=["midpoint"]))
def test_a_fallback_step_is_counted_and_the_episode_goes_on(scheme):
    env = StationKeepingEnv(scheme=scheme, substeps=1, control_period=0.5, workspace_radius=1e3)
    env.reset(seed=0, options={"velocity": (30.0, 30.0, 0.0, 5.0, 80.0, 9.0), "position": (0.0, 0.0, 5.0)})
    *_, terminated, _, info = env.step(np.zeros(6))
    assert env.fallback_substeps == 1
    assert not terminated
    assert not info["refused"]


def test_a_refused_step_ends_the_episode_and_says_why():
    env = StationKeepingEnv(substeps=1, control_period=0.5, workspace_radius=1e4, start_radius=1.0)
    observation, _ = env.reset(
        seed=0, options={"velocity": (3e4, 3e4, 0.0, 5e3, 8e4, 9e3), "position": (0.0, 0.0, 5.0)}
    )
    for _ in range(10):
        before = env.position_ned
        observation, reward, terminated, _, info = env.step(np.zeros(6))
        assert np.isfinite(observation).all()
        assert env.observation_space.contains(observation)
        if terminated:
            break
    assert terminated
    assert info["refused"]
    assert env.refusal["refused"] in ("wrong_branch", "not_converged", "not_finite")
    assert env.refusal["step_times_speed"] > 0.0
    assert np.array_equal(env.position_ned, before)
    assert np.isfinite(reward)


@settings(max_examples=40)
@given(seed=st.integers(0, 2**31), log_speed=st.floats(-1.0, 150.0))
def test_no_nan_ever_leaves(seed, log_speed):
    rng = np.random.default_rng(seed)
    env = StationKeepingEnv(workspace_radius=1e4, start_radius=1.0)
    outcomes = [env.reset(seed=seed, options={"velocity": rng.normal(size=6) * 10.0**log_speed})]
    for action in rng.uniform(-1.0, 1.0, (5, 6)):
        outcomes.append(env.step(action))
        assert np.isfinite(outcomes[-1][1])
        if outcomes[-1][2]:
            break
    for outcome in outcomes:
        assert np.isfinite(outcome[0]).all()
        assert env.observation_space.contains(outcome[0])
        assert np.isfinite(outcome[-1]["position_error"])
        assert np.isfinite(outcome[-1]["attitude_error"])
