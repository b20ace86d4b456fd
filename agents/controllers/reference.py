"""The way of a point that moves, over the time for which an observation shows it.

Place, velocity and acceleration now, and two places ahead, make a polynomial of degree 4 in time,

    p(t) = p + v t + a t^2 / 2 + c t^3 + d t^4,                                                       (1)

from which the velocity in the point's own axes follows: x the way it goes, seen from above, and z down.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SLOWEST = 1e-6
"""A point whose level speed is below this has no course; it keeps the one that it had [m/s]."""


class Reference(NamedTuple):
    """A reference over n control periods, in its own axes, which turn with its course; Fossen's order.

    Attributes:
        velocity: in the middle of each period, shape (n, 6) [m/s, rad/s].
        acceleration: how fast its components change in each period, shape (n, 6) [m/s^2, rad/s^2].
    """

    velocity: Array
    acceleration: Array


class Way(NamedTuple):
    """What is shown of a point's way, in its own axes now: each of shape (3,) [m, m/s, m/s^2].

    Attributes:
        velocity: now.
        acceleration: now.
        soon: the place at the first time ahead, less the place now.
        later: the place at the second time ahead, less the place now.
    """

    velocity: Array
    acceleration: Array
    soon: Array
    later: Array


def reference_along(way: Way, ahead: tuple[float, float], period: float, periods: int) -> Reference:
    """Return the reference for some control periods from now on.

    Args:
        way: of the point.
        ahead: times at which it is at `way.soon` and `way.later` [s].
        period: of control [s].
        periods: how many; up to the later time, (1) lies between what is shown.
    """
    t = period * np.arange(periods + 1)[:, None]
    times = np.array(ahead)
    beyond = np.array([way.soon, way.later]) - times[:, None] * way.velocity
    beyond -= 0.5 * times[:, None] ** 2 * way.acceleration
    c, d = np.linalg.solve(np.column_stack([times**3, times**4]), beyond)
    velocity = way.velocity + way.acceleration * t + 3.0 * c * t**2 + 4.0 * d * t**3
    acceleration = way.acceleration + 6.0 * c * t + 12.0 * d * t**2
    twists = _along_course(velocity, acceleration)
    return Reference(0.5 * (twists[1:] + twists[:-1]), np.diff(twists, axis=0) / period)


def _along_course(velocity: Array, acceleration: Array) -> Array:
    """Return linear and angular velocity in axes that turn with the course, shape (n, 6)."""
    twists = np.zeros((len(velocity), 6))
    cosine, sine = 1.0, 0.0
    for twist, (x, y, z), (ax, ay, _) in zip(twists, velocity.tolist(), acceleration.tolist(), strict=True):
        level = math.hypot(x, y)
        if level > SLOWEST:
            cosine, sine = x / level, y / level
            twist[5] = (x * ay - y * ax) / level**2
        twist[:3] = cosine * x + sine * y, cosine * y - sine * x, z
    return twists
