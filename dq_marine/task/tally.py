"""Means over the part of an episode in which errors count."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, add_scaled, scale


class Tally(NamedTuple):
    """Time for which errors have counted [s], and the integrals of three numbers over it."""

    time: float
    sums: Vector3


NOTHING_YET = Tally(0.0, (0.0, 0.0, 0.0))
"""Before errors count."""


def counted(tally: Tally, counting: bool, numbers: Vector3, period: float) -> Tally:
    """Return a tally after one more control period [s], with the numbers at its end, if they count."""
    time = select(counting, period, 0.0)
    return Tally(tally.time + time, add_scaled(tally.sums, time, numbers))


def means(tally: Tally, period: float) -> Vector3:
    """Return the means of the three numbers since errors count: 0 before."""
    return scale(1.0 / max(tally.time, period), tally.sums)
