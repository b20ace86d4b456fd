"""A pipe on the seabed, as straight as it is near a vehicle: what is seen of it, and where the vehicle is beside it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.distances import line_distance
from dq_marine.algebra.elementary import arctangent
from dq_marine.algebra.level import (
    Level,
    from_above,
    level_bow,
    level_cross,
    level_dot,
    level_length,
    seen_at,
)
from dq_marine.algebra.normal import normal_pair
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import Vector3, add_scaled, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.world.beams import Cast, make_errors
from dq_marine.task.world.keel import Keel
from dq_marine.task.world.rays import ray_to_line

LEAST_ALONG = 0.2
"""Of a line's course, along the bow, that it is taken to have."""


class Pipe(NamedTuple):
    """A straight pipe: a point on its axis [m], a unit vector along that, its radius [m]."""

    on_axis: Vector3
    axis: Vector3
    radius: float


class LaidPipe(NamedTuple):
    """The seabed, and the pipe on it."""

    ground: Any
    pipe: Pipe


class Sight(NamedTuple):
    """A pipe at a distance ahead of the bow, seen from above: how far to starboard [m], and its bearing there [rad].

    The bearing is where it leads to from there, from the bow to starboard.
    """

    starboard: float
    bearing: float


class View(NamedTuple):
    """What is seen of a pipe and the seabed, or the errors in it: ranges of beams [m], and a detector's sight."""

    ranges: Any
    sight: Sight


class BesidePipe(NamedTuple):
    """A vehicle beside a pipe.

    Attributes:
        starboard: how far to starboard of it [m].
        height: over its axis [m].
        askew: from the pipe's course to that over ground, to starboard [rad].
        speed: along it, seen from above [m/s].
        clearance: of the hull from it [m].
    """

    starboard: float
    height: float
    askew: float
    speed: float
    clearance: float


class PipeOnGround(NamedTuple):
    """The functions of a pipe on a kind of ground.

    Attributes:
        laid: (ground, place [m], course, radius [m]) -> a pipe that lies on the ground there and runs that way.
        cast: (laid pipe, origin, direction, reach) -> range along a ray to pipe or ground [m].
    """

    laid: Callable[[Any, Level, Level, float], Pipe]
    cast: Cast


def make_pipe(
    along: Callable[[Any, float, float, float, float], tuple[float, float]], cast: Cast
) -> PipeOnGround:
    """Return the functions of a pipe.

    Args:
        along: (ground, north, east, a level direction's parts) -> depth, and its growth per metre that way.
        cast: (ground, origin, direction, reach) -> range along a ray to the ground [m].
    """

    def laid(ground: Any, place: Level, course: Level, radius: float) -> Pipe:
        length = level_length(course)
        north, east = course[0] / length, course[1] / length
        depth, growth = along(ground, place[0], place[1], north, east)
        level = 1.0 / math.sqrt(1.0 + growth * growth)
        # The axis is a radius off the ground's tangent, and so higher by more than that where the ground is not level.
        on_axis = (place[0], place[1], depth - radius / level)
        return Pipe(on_axis, (level * north, level * east, level * growth), radius)

    def pipe_cast(world: LaidPipe, origin: Vector3, direction: Vector3, reach: float) -> float:
        pipe = world.pipe
        met = ray_to_line(origin, direction, pipe.on_axis, pipe.axis, pipe.radius, reach)
        return min(met, cast(world.ground, origin, direction, reach))

    return PipeOnGround(laid, pipe_cast)


def beside_pipe(pipe: Pipe, motion: Motion, keel: Keel) -> BesidePipe:
    """Return where a vehicle is beside a pipe, which is not vertical."""
    axis, way = from_above(pipe.axis), from_above(rotate(motion.attitude, motion.velocity.linear))
    off, level = subtract(motion.position_ned, pipe.on_axis), level_length(axis)
    return BesidePipe(
        level_cross(axis, from_above(off)) / level,
        -off[2],
        seen_at(axis, way),
        level_dot(axis, way) / level,
        pipe_clearance(pipe, motion, keel),
    )


def pipe_clearance(pipe: Pipe, motion: Motion, keel: Keel) -> float:
    """Return the least distance of bow, middle and stern from a pipe, less half the hull's height [m]."""
    place, ahead = motion.position_ned, rotate(motion.attitude, (1.0, 0.0, 0.0))
    middle = line_distance(place, pipe.on_axis, pipe.axis, pipe.radius)
    bow = add_scaled(place, keel.half_length, ahead)
    stern = add_scaled(place, -keel.half_length, ahead)
    ends = min(
        line_distance(bow, pipe.on_axis, pipe.axis, pipe.radius),
        line_distance(stern, pipe.on_axis, pipe.axis, pipe.radius),
    )
    return min(middle, ends) - keel.half_height


def detected(sight: Sight, errors: Sight, widest: Sight, lost: bool) -> tuple[float, float, float]:
    """Return what a detector tells: 1 and a sight with errors; or zeros, where it is lost or beyond the widest one."""
    starboard, bearing = sight.starboard + errors.starboard, sight.bearing + errors.bearing
    beyond = (abs(starboard) > widest.starboard) | (abs(bearing) > widest.bearing)
    return select(beyond | lost, spread((0.0, 0.0, 0.0), bearing), (spread(1.0, bearing), starboard, bearing))


def make_view_errors(beams: int) -> tuple[Callable[[float, float, float, Any], View], View]:
    """Return (noise, dropout, altitude [m], uniforms) -> errors of a view, and those of one without errors.

    The range after those of the beams tells by `NO_ECHO` that the detector loses the pipe. `beams` + 3 uniform numbers
    are used.
    """
    drawn_errors = make_errors(beams + 1)

    def view_errors(noise: float, dropout: float, altitude: float, uniforms: Any) -> View:
        aside, turned = normal_pair(uniforms[beams + 1], uniforms[beams + 2])
        seen = Sight(noise * aside, noise / altitude * turned)
        return View(drawn_errors(noise, dropout, uniforms), seen)

    return view_errors, View((0.0,) * (beams + 1), Sight(0.0, 0.0))


def sight(motion: Motion, place: Level, course: Level, ahead: float) -> Sight:
    """Return where a line through a place [m] crosses that square to the bow at a distance ahead [m].

    A line that runs across the bow is taken to run a little along it.

    Args:
        motion: of the vehicle.
        place: on the line, near the crossing.
        course: of the line there, of any length.
        ahead: distance of the crossing [m].
    """
    bow = level_bow(motion.attitude)
    off = (place[0] - motion.position_ned[0], place[1] - motion.position_ned[1])
    along, across = level_dot(bow, course), level_cross(bow, course)
    steepness = across / max(along, LEAST_ALONG * level_length(course))
    starboard = level_cross(bow, off) + steepness * (ahead - level_dot(bow, off))
    return Sight(starboard, arctangent(across, along))
