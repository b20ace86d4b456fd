"""Tracking of a point that runs along a curve: how exact a vehicle has to be, how far it is off, what it sees of it."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.level import seen_at
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, bounded_vector, norm, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.harmonics import CurvePoint, level_course


class Exactness(NamedTuple):
    """How exact a vehicle has to be.

    Attributes:
        position: distance to the point [m].
        heading: angle between the bow and the way the point goes, seen from above [rad].
        held: for how long it has to be within both [s].
        integral: bound of the position error's integral along each NED axis [m s].
        stretch: of times, over those of a vehicle with the shortest control period.
        under_way: 1 for vehicles that only steer, which start on their way, else 0.
    """

    position: float
    heading: float
    held: float
    integral: float
    stretch: float
    under_way: float


class PointErrors(NamedTuple):
    """Distance to the point [m], and angle between the bow and the way it goes, seen from above [rad]."""

    position: float
    heading: float


def point_errors(point: CurvePoint, motion: Motion) -> PointErrors:
    """Return distance to the point and angle to its course."""
    ahead, _ = level_course(point.slope_ned)
    bow = rotate(motion.attitude, (1.0, 0.0, 0.0))
    distance = norm(subtract(point.position_ned, motion.position_ned))
    return PointErrors(distance, abs(seen_at((ahead[0], ahead[1]), (bow[0], bow[1]))))


def time_on_track(exact: Exactness, before: float, off: PointErrors, period: float) -> float:
    """Return for how long a vehicle has been on track [s], a control period later."""
    on_track = (off.position < exact.position) & (off.heading < exact.heading)
    return select(on_track, before + period, 0.0)


def place_seen(place_ned: Vector3, motion: Motion, reach: float) -> Vector3:
    """Return where a place is, seen from a vehicle, within a reach [m]."""
    return bounded_vector(rotate_inverse(motion.attitude, subtract(place_ned, motion.position_ned)), reach)
