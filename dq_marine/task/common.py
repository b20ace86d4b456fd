"""Formulas that several tasks share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.quaternion import Quaternion, rotate_inverse
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, bounded_vector, scale
from dq_marine.integrator.body import Motion
from dq_marine.task.harmonics import CurvePoint, course_rate
from dq_marine.task.protocol import Situation

SPEED_BOUND = 10.0
"""Velocities are observed up to this [m/s, rad/s]."""


def next_turn(turn: float, turns: float) -> float:
    """Return whose turn follows, 0 to turns - 1."""
    return select(turn > turns - 1.5, 0.0, turn + 1.0)


def observed_velocity(measured: Motion) -> tuple[Vector3, Vector3]:
    """Return linear and angular velocity over ground in the body frame [m/s, rad/s], within `SPEED_BOUND`."""
    velocity = measured.velocity
    return (bounded_vector(velocity.linear, SPEED_BOUND), bounded_vector(velocity.angular, SPEED_BOUND))


def observed_curve_motion(
    point: CurvePoint, rate: float, attitude: Quaternion
) -> tuple[Vector3, Vector3, Vector3]:
    """Return velocity [m/s], turn rate of the course [rad/s] and acceleration [m/s^2] of a point on a curve.

    They are over ground, in the axes of a body, and within `SPEED_BOUND`.

    Args:
        point: on the curve.
        rate: of its phase [rad/s].
        attitude: of the body, body to NED.
    """
    velocity = rotate_inverse(attitude, scale(rate, point.slope_ned))
    turning = rotate_inverse(attitude, (0.0, 0.0, course_rate(point, rate)))
    acceleration = rotate_inverse(attitude, scale(rate * rate, point.bend_ned))
    return (
        bounded_vector(velocity, SPEED_BOUND),
        bounded_vector(turning, SPEED_BOUND),
        bounded_vector(acceleration, SPEED_BOUND),
    )


def effort(weight: float, now: Situation) -> float:
    """Return the reward's term for the mean square of the action, which is negative."""
    return -(weight * now.action_squares / now.actions)


def peak(error: float, fine: float, far: float) -> float:
    """Return how good an error of a magnitude is: 1 where it is 0; half of it falls within `fine`, half by `far`.

    A peak alone is not felt from afar, and a wide bell does not tell the last tenth from the one before.
    """
    return 0.5 * (exponential(-error / fine) + exponential(-error / far))


def make_pick(count: int, first: int = 0) -> Callable[[float, Any], Any]:
    """Return (number, tuple) -> the tuple's entry of about that number, held within 0 and `count` - 1."""

    def pick_last(number: float, entries: Any) -> Any:
        return entries[count - 1]

    if first == count - 1:
        return pick_last
    rest = make_pick(count, first + 1)

    def pick(number: float, entries: Any) -> Any:
        return select(number < first + 0.5, entries[first], rest(number, entries))

    return pick
