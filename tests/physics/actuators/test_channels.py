"""What a channel does under a command, against its differential equation."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from dq_marine.physics.actuators.formulas.channels import (
    Channel,
    Lag,
    LaggedSlew,
    Slew,
    follow_at_once,
    follow_with_lag,
    follow_with_lagged_slew,
    follow_with_slew,
    limited_target,
    scaled_command,
    turning_target,
)

KINDS = [
    (follow_at_once, ()),
    (follow_with_lag, Lag(0.3)),
    (follow_with_slew, Slew(2.0)),
    (follow_with_lagged_slew, LaggedSlew(0.3, 2.0)),
]

values = st.floats(-50.0, 50.0)
times = st.floats(0.0, 20.0)


@pytest.mark.parametrize(("value", "target"), [(0.0, 4.0), (1.0, -3.0), (0.2, 0.5), (-2.0, -2.0)])
def test_lag_and_rate_limit_solve_their_equation(value, target):
    """dx/dt = clip((c - x)/T, -R, R), solved by SciPy in two parts where the rate leaves its limit."""
    lag, rate = 0.3, 2.0
    instants = np.linspace(0.0, 3.0, 31)
    solution = solve_ivp(
        lambda _, x: np.clip((target - x) / lag, -rate, rate),
        (0.0, 3.0),
        [value],
        t_eval=instants,
        rtol=1e-10,
        atol=1e-12,
        max_step=0.01,
    )
    closed = [follow_with_lagged_slew(LaggedSlew(lag, rate), value, target, t) for t in instants]
    assert closed == pytest.approx(solution.y[0], abs=1e-6)


def test_a_lag_is_an_exponential():
    for t in (0.0, 0.1, 0.5, 2.0):
        expected = 3.0 + (1.0 - 3.0) * math.exp(-t / 0.3)
        assert follow_with_lag(Lag(0.3), 1.0, 3.0, t) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(("follow", "dynamics"), KINDS)
@given(value=values, target=values, first=times, second=times)
def test_following_may_be_interrupted(follow, dynamics, value, target, first, second):
    """The value after t1 + t2 is that after t2 from the value after t1: the closed forms are a flow."""
    whole = follow(dynamics, value, target, first + second)
    pieces = follow(dynamics, follow(dynamics, value, target, first), target, second)
    assert pieces == pytest.approx(whole, abs=1e-10)


@pytest.mark.parametrize(("follow", "dynamics"), KINDS)
@given(value=values, target=values, elapsed=times)
def test_the_value_stays_between_start_and_target(follow, dynamics, value, target, elapsed):
    after = follow(dynamics, value, target, elapsed)
    assert min(value, target) - 1e-12 <= after <= max(value, target) + 1e-12


@pytest.mark.parametrize(("follow", "dynamics"), KINDS[2:])
@given(value=values, target=values, elapsed=st.floats(0.0, 5.0))
def test_the_rate_is_kept(follow, dynamics, value, target, elapsed):
    assert abs(follow(dynamics, value, target, elapsed) - value) <= dynamics.rate * elapsed + 1e-10


@given(value=values, command=st.floats(-1e6, 1e6))
def test_commands_are_held_within_limits_and_dead_band(value, command):
    channel = Channel(-3.0, 5.0, 0.5, ())
    target = limited_target(channel, value, command)
    assert target == (0.0 if abs(command) < 0.5 else min(5.0, max(-3.0, command)))


@given(value=values, command=values)
def test_a_thruster_turns_the_short_way(value, command):
    target = turning_target(Channel(-math.pi, math.pi, 0.0, ()), value, command)
    assert abs(target - value) <= math.pi + 1e-12
    assert math.cos(target - command) == pytest.approx(1.0, abs=1e-12)


def test_an_action_reaches_the_limit_on_its_side():
    channel = Channel(-3.0, 5.0, 0.0, ())
    assert [scaled_command(channel, action) for action in (-1.0, -0.5, 0.0, 0.5, 1.0)] == [
        -3,
        -1.5,
        0,
        2.5,
        5,
    ]
