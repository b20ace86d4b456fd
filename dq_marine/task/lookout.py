"""What a vessel sees and makes of another that keeps course and speed, from above."""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.algebra.level import Level, level_cross, level_dot, level_length
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import bounded
from dq_marine.integrator.body import Motion
from dq_marine.task.colregs import Nearest, closest_approach, passing, sight_turns
from dq_marine.task.common import SPEED_BOUND
from dq_marine.task.traffic import OtherVessel, moved

CLEAR = 5.0
"""Nearer than this a vessel is near [lengths]."""

SIDEWAYS = 0.25
"""Who slides past at this share of one's own speed is fully on one side."""

VESSEL_SPEED_BOUND = 2.0 * SPEED_BOUND
"""Velocities of others, less one's own, are observed up to this [m/s]."""


class Lookout(NamedTuple):
    """Other vessels; the least distance to each so far [m], and how the line of sight turned there (`sight_turns`)."""

    vessels: tuple[OtherVessel, OtherVessel, OtherVessel]
    least: tuple[float, float, float]
    turning: tuple[float, float, float]


def first_lookout(vessels: tuple[OtherVessel, OtherVessel, OtherVessel]) -> Lookout:
    """Return the lookout of a vessel at the origin that has just begun."""
    a, b, c = vessels
    return Lookout(
        vessels, (level_length(a.place), level_length(b.place), level_length(c.place)), (0.0, 0.0, 0.0)
    )


def lookout_kept(lookout: Lookout, motion: Motion, period: float) -> Lookout:
    """Return the lookout some time later [s], with one's own motion of then."""
    a, b, c = lookout.vessels
    vessels = (moved(a, period), moved(b, period), moved(c, period))
    first = _nearer(vessels[0], motion, lookout.least[0], lookout.turning[0])
    second = _nearer(vessels[1], motion, lookout.least[1], lookout.turning[1])
    third = _nearer(vessels[2], motion, lookout.least[2], lookout.turning[2])
    return Lookout(vessels, (first[0], second[0], third[0]), (first[1], second[1], third[1]))


def least_distance(lookout: Lookout) -> float:
    """Return the least distance to any vessel so far [m]."""
    return min(lookout.least[0], min(lookout.least[1], lookout.least[2]))


def next_approach(lookout: Lookout, motion: Motion, far: float) -> Nearest:
    """Return the nearest of the closest approaches of all vessels; no farther than `far` [m]."""
    a, b, c = lookout.vessels
    return _nearest(c, motion, _nearest(b, motion, _nearest(a, motion, Nearest(far, 0.0))))


def wrong_sides(lookout: Lookout, motion: Motion) -> float:
    """Return how many vessels have been passed on the side that the rules forbid."""
    (a, b, c), (first, second, third) = lookout.vessels, lookout.turning
    return (
        _passed_wrong(a, motion, first) + _passed_wrong(b, motion, second) + _passed_wrong(c, motion, third)
    )


def crowding(lookout: Lookout, motion: Motion, length: float, speed: float) -> tuple[float, float]:
    """Return how near the vessels are, and how far they are about to be passed on the wrong side: each adds up to 1.

    Args:
        lookout: of one's own vessel.
        motion: of it.
        length: of it [m].
        speed: at which it goes its way [m/s].
    """
    a, b, c = lookout.vessels
    first, second, third = (
        _crowding(a, motion, length, speed),
        _crowding(b, motion, length, speed),
        _crowding(c, motion, length, speed),
    )
    return first[0] + second[0] + third[0], first[1] + second[1] + third[1]


def shown(lookout: Lookout, measured: Motion, bow: Level, far: float, longest: float) -> Any:
    """Return what is shown of the vessels: where they are and go, how they pass, and rules.

    Args:
        lookout: of one's own vessel.
        measured: motion of it.
        bow: where it heads, a unit vector. Places, bearings, velocities and courses are ahead and to starboard of it.
        far: bound of distances [m].
        longest: bound of the times to the nearest approach [s].
    """
    a, b, c = lookout.vessels
    return (
        _shown(a, measured, bow, far, longest),
        _shown(b, measured, bow, far, longest),
        _shown(c, measured, bow, far, longest),
    )


def along_route(course: Level, motion: Motion) -> Level:
    """Return how far a vehicle is along a route from the origin and to starboard of it [m]; `course` is of length 1."""
    place = (motion.position_ned[0], motion.position_ned[1])
    return (level_dot(course, place), level_cross(course, place))


def relative(vessel: OtherVessel, motion: Motion) -> tuple[Level, Level]:
    """Return the way to a vessel [m], and its velocity less one's own [m/s], in north and east."""
    place, velocity = motion.position_ned, rotate(motion.attitude, motion.velocity.linear)
    offset = (vessel.place[0] - place[0], vessel.place[1] - place[1])
    return offset, (vessel.velocity[0] - velocity[0], vessel.velocity[1] - velocity[1])


def _nearer(vessel: OtherVessel, motion: Motion, least: float, turning: float) -> tuple[float, float]:
    """Return the least distance to a vessel so far [m], and how the line of sight turned there."""
    offset, velocity = relative(vessel, motion)
    distance = level_length(offset)
    return select(distance < least, (distance, sight_turns(offset, velocity)), (least, turning))


def _nearest(vessel: OtherVessel, motion: Motion, other: Nearest) -> Nearest:
    """Return the nearer of a vessel's closest approach and another one."""
    offset, velocity = relative(vessel, motion)
    own = closest_approach(offset, velocity)
    return select((vessel.present > 0.5) & (own.distance < other.distance), own, other)


def _passed_wrong(vessel: OtherVessel, motion: Motion, turning: float) -> float:
    """Return 1 where a vessel is past, and the line of sight turned to the wrong side where it was nearest; else 0."""
    offset, velocity = relative(vessel, motion)
    return select((turning > 0.0) & (level_dot(offset, velocity) > 0.0), vessel.to_port, 0.0)


def _crowding(vessel: OtherVessel, motion: Motion, length: float, speed: float) -> tuple[float, float]:
    offset, velocity = relative(vessel, motion)
    distance = level_length(offset)
    near = max(0.0, 1.0 - distance / (CLEAR * length))
    sliding = sight_turns(offset, velocity) / (max(distance, length) * SIDEWAYS * speed)
    closing = select(level_dot(offset, velocity) < 0.0, vessel.to_port, 0.0)
    return near * near, closing * max(0.0, min(1.0, sliding))


def _shown(vessel: OtherVessel, measured: Motion, bow: Level, far: float, longest: float) -> Any:
    offset, velocity = relative(vessel, measured)
    speed, distance = max(1e-9, level_length(vessel.velocity)), level_length(offset)
    ahead, starboard = level_dot(bow, offset), level_cross(bow, offset)
    touching = max(1e-9, distance)
    return (
        (bounded(ahead, far), bounded(starboard, far)),
        bounded(distance, far),
        (ahead / touching, starboard / touching),
        bounded(level_dot(bow, velocity), VESSEL_SPEED_BOUND),
        bounded(level_cross(bow, velocity), VESSEL_SPEED_BOUND),
        (level_dot(bow, vessel.velocity) / speed, level_cross(bow, vessel.velocity) / speed),
        passing(offset, velocity, far, longest),
        (vessel.present, vessel.give_way, vessel.to_port),
    )
