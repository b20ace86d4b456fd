"""What one number of an actuator does under a command: a shaft's speed, a fin's deflection, an azimuth's angle.

A channel does not depend on the body, so under a constant command it is an explicit function of time. With the
first-order lag T and the largest rate R,

    dx/dt = (c - x)/T held within -R and R,                                                            (C1)

the gap c - x shrinks at the rate R while it is larger than R T, then as an exponential. Without a lag it shrinks at the
rate R until it is closed; without a largest rate it is an exponential from the start; without either the value is the
command. A step of the integrator evaluates these closed forms where it needs them, so actuators cost it no order.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import arctangent, exponential, sine_and_cosine
from dq_marine.algebra.selection import select


class Lag(NamedTuple):
    """A first-order lag with its time constant [s]."""

    time_constant: float


class Slew(NamedTuple):
    """A largest rate, in units of the channel per second."""

    rate: float


class LaggedSlew(NamedTuple):
    """A first-order lag with its time constant [s], and a largest rate."""

    time_constant: float
    rate: float


class Channel(NamedTuple):
    """One number of an actuator.

    Attributes:
        low: the smallest value, at the action -1.
        high: the largest value, at the action 1.
        dead_band: commands smaller than this count as 0.
        dynamics: parameters of how the value follows the command: `()`, `Lag`, `Slew` or `LaggedSlew`.
    """

    low: float
    high: float
    dead_band: float
    dynamics: Any


class ChannelKind(NamedTuple):
    """The functions of a channel.

    Attributes:
        target: (channel, value, command) -> the value that the command leads to.
        follow: (dynamics, value, target, elapsed) -> the value after a time [s] under a constant command.
    """

    target: Callable[[Channel, float, float], float]
    follow: Callable[[Any, float, float, float], float]


def scaled_command(channel: Channel, action: float) -> float:
    """Return the command of an action in [-1, 1]: 0 is 0, and each end is the limit on its side."""
    return select(action < 0.0, -channel.low, channel.high) * action


def limited_target(channel: Channel, value: float, command: float) -> float:
    """Return the command held within the limits; 0 within the dead band."""
    held = max(channel.low, min(channel.high, command))
    return select(abs(held) < channel.dead_band, 0.0, held)


def turning_target(channel: Channel, value: float, command: float) -> float:
    """Return the angle nearest to the value that points where the command does: a thruster that turns all round."""
    return value + arctangent(*sine_and_cosine(command - value))


def follow_at_once(dynamics: Any, value: float, target: float, elapsed: float) -> float:
    """Return the target."""
    return target


def follow_with_lag(lag: Lag, value: float, target: float, elapsed: float) -> float:
    """Return the solution of (C1) without a largest rate."""
    return target + (value - target) * exponential(-elapsed / lag.time_constant)


def follow_with_slew(slew: Slew, value: float, target: float, elapsed: float) -> float:
    """Return the solution of (C1) without a lag."""
    reach = slew.rate * elapsed
    return value + max(-reach, min(reach, target - value))


def follow_with_lagged_slew(dynamics: LaggedSlew, value: float, target: float, elapsed: float) -> float:
    """Return the solution of (C1)."""
    gap = target - value
    size = abs(gap)
    sliding = min(elapsed, max(0.0, size / dynamics.rate - dynamics.time_constant))
    left = (size - dynamics.rate * sliding) * exponential((sliding - elapsed) / dynamics.time_constant)
    return target - select(gap < 0.0, -left, left)
