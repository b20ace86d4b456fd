"""What every environment tells of its episodes, and terms that a user adds to the reward."""

import dataclasses

import numpy as np
import pytest
from support.environments import STATION_KEEPING, WAYPOINT_TRACKING, StationKeepingEnv

from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.registry import task_named
from dq_marine.errors import InvalidInputError
from dq_marine.task.protocol import RewardTerm


def test_reset_and_every_step_tell_the_same_things():
    """By name, type and shape: loggers and collectors lay out their memory by the first info that they see."""
    env = StationKeepingEnv()
    layouts = [env.reset(seed=0)[1], *(env.step(env.action_space.sample())[-1] for _ in range(5))]
    told = [{name: (value.dtype, value.shape) for name, value in info.items()} for info in layouts]
    assert all(one == told[0] for one in told)
    assert {"position_error", "reward/effort", "is_success", "current_ned", "refused"} < set(told[0])


def speed_squared(now):
    surge, sway, heave = now.motion.velocity.linear
    return surge * surge + sway * sway + heave * heave


def test_a_term_can_be_added_to_the_reward():
    slow = RewardTerm("slow", speed_squared, weight=-0.5)
    env, plain = StationKeepingEnv(extra_rewards=[slow]), StationKeepingEnv()
    outcomes = [one.reset(seed=1) and one.step(np.full(6, 0.4)) for one in (env, plain)]
    assert np.array_equal(outcomes[0][0], outcomes[1][0])
    term = outcomes[0][-1]["reward/slow"]
    assert term == pytest.approx(-0.5 * float(env.velocity_body[:3] @ env.velocity_body[:3]), rel=1e-12)
    assert outcomes[0][1] == outcomes[1][1] + term


@pytest.mark.parametrize(
    ("terms", "message"),
    [
        (RewardTerm("slow", speed_squared), "list"),
        ([speed_squared], "RewardTerm"),
        ([RewardTerm("effort", speed_squared)], "two rewards 'effort'"),
        ([RewardTerm("slow", speed_squared, float("nan"))], "finite"),
    ],
)
def test_wrong_terms_are_refused(terms, message):
    with pytest.raises(InvalidInputError, match=message):
        StationKeepingEnv(extra_rewards=terms)


def test_settings_of_another_kind_are_refused():
    with pytest.raises(InvalidInputError, match=r"settings = 3; give a dq_marine\.Settings"):
        StationKeepingEnv(settings=3)


def test_parameters_without_names_are_refused():
    """They would do for one environment, and fail in lanes."""
    nameless = dataclasses.replace(
        task_named(STATION_KEEPING), parameters=lambda settings, context: (1.0, 2.0)
    )
    with pytest.raises(InvalidInputError, match="StationKeeping-v0 are a tuple; return a NamedTuple"):
        MarineEnv(nameless)


def test_waypoints_without_measure_are_refused():
    with pytest.raises(InvalidInputError, match=r"spacing = 1e\+300; give at most 1000"):
        MarineEnv(WAYPOINT_TRACKING, spacing=1e300)
