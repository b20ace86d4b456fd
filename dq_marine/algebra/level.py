"""Level vectors: what is seen from above, as pairs (north, east).

They may also be pairs along any other axes of which the second is turned by 90 degrees clockwise from the first, as
ahead and to starboard.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from dq_marine.algebra.elementary import arctangent, sine_and_cosine
from dq_marine.algebra.quaternion import Quaternion, rotate

Level: TypeAlias = tuple[float, float]


def from_above(a: tuple[float, float, float]) -> Level:
    """Return a vector in NED as it is seen from above."""
    return (a[0], a[1])


def level_dot(a: Level, b: Level) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1]


def level_cross(a: Level, b: Level) -> float:
    """Return what is positive where b points to starboard of a: the sine of the angle times both lengths."""
    return a[0] * b[1] - a[1] * b[0]


def level_length(a: Level) -> float:
    """Return the length."""
    return math.sqrt(a[0] * a[0] + a[1] * a[1])


def level_turned(a: Level, angle: float) -> Level:
    """Return a vector that is turned to starboard by an angle [rad]."""
    s, c = sine_and_cosine(angle)
    return (c * a[0] - s * a[1], s * a[0] + c * a[1])


def level_along(a: Level, ahead: Level) -> Level:
    """Return a vector that is given ahead and to starboard of a unit vector, as that is: in north and east, or so."""
    return (a[0] * ahead[0] - a[1] * ahead[1], a[0] * ahead[1] + a[1] * ahead[0])


def level_bow(quaternion_body_to_ned: Quaternion) -> Level:
    """Return where the bow points, seen from above: a unit vector, or about 0 for a vehicle that stands upright."""
    bow = rotate(quaternion_body_to_ned, (1.0, 0.0, 0.0))
    length = max(1e-9, level_length((bow[0], bow[1])))
    return (bow[0] / length, bow[1] / length)


def seen_at(course: Level, offset: Level) -> float:
    """Return the bearing of a place from the bow [rad]: 0 ahead, pi/2 on the starboard beam, within -pi and pi.

    Args:
        course: where the vessel heads, of any length.
        offset: from the vessel to the place [m].
    """
    return arctangent(level_cross(course, offset), level_dot(course, offset))
