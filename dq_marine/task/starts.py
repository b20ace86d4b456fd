"""Starts that several tasks draw."""

from __future__ import annotations

import math
from collections.abc import Callable

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.level import Level, level_length, level_turned
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, multiply_elementwise, scale
from dq_marine.task.protocol import Start

LARGEST_TILT = 0.3
"""Of starts: roll and pitch [rad]."""

START_SPEED = 0.2
"""Largest component of a start's velocity [m/s, rad/s]."""

SLOW_START_DRAWS = 12
"""Uniform random numbers that `slow_start` takes."""


def slow_start(
    center_ned: Vector3, radius: float, height: float, uniforms: tuple[float, ...], first: int
) -> Start:
    """Return a start in a ball, or in a disc: any heading, moderate tilt, slow.

    Args:
        center_ned: of the ball [m].
        radius: of the ball [m].
        height: of the ball along the vertical, over its radius: 1, or 0 where starts are level with the centre.
        uniforms: random numbers in [0, 1).
        first: index of the first of the `SLOW_START_DRAWS` numbers that are used.
    """
    # Uniform in the ball: the height of a direction and the cube of a distance are.
    z = 2.0 * uniforms[first] - 1.0
    azimuth = math.pi * (2.0 * uniforms[first + 1] - 1.0)
    across = math.sqrt(1.0 - z * z)
    direction = (across * math.cos(azimuth), across * math.sin(azimuth), height * z)
    distance = radius * uniforms[first + 2] ** (1.0 / 3.0)
    attitude = quaternion_from_euler(
        LARGEST_TILT * (2.0 * uniforms[first + 3] - 1.0),
        LARGEST_TILT * (2.0 * uniforms[first + 4] - 1.0),
        math.pi * (2.0 * uniforms[first + 5] - 1.0),
    )
    linear = symmetric3(uniforms, first + 6)
    angular = symmetric3(uniforms, first + 9)
    velocity = Spatial(scale(START_SPEED, angular), scale(START_SPEED, linear))
    return Start(add_scaled(center_ned, distance, direction), attitude, velocity)


def under_way(position_ned: Vector3, heading: float, speed: float) -> Start:
    """Return a start at a place [m] that goes straight ahead on the level: heading [rad], speed over ground [m/s]."""
    attitude = quaternion_from_euler(0.0, 0.0, heading)
    return Start(position_ned, attitude, Spatial((0.0, 0.0, 0.0), (speed, 0.0, 0.0)))


def beside_start(
    center_ned: Vector3,
    radius: float,
    velocity_ned: Level,
    turn: float,
    uniforms: tuple[float, ...],
    first: int,
) -> Start:
    """Return a start in a disc that goes about as fast and about where a velocity leads, on the level.

    Args:
        center_ned: of the disc [m].
        radius: of the disc [m].
        velocity_ned: north and east [m/s].
        turn: largest angle of heading and velocity [rad].
        uniforms: random numbers in [0, 1), of which three from `first` on are used.
        first: see `uniforms`.
    """
    bearing, distance = math.tau * uniforms[first], radius * math.sqrt(uniforms[first + 1])
    north, east = level_turned((distance, 0.0), bearing)
    heading = math.atan2(velocity_ned[1], velocity_ned[0]) + turn * (2.0 * uniforms[first + 2] - 1.0)
    return under_way(add(center_ned, (north, east, 0.0)), heading, level_length(velocity_ned))


def symmetric3(uniforms: tuple[float, ...], first: int) -> Vector3:
    """Return three numbers in [-1, 1) of three in [0, 1)."""
    return (
        2.0 * uniforms[first] - 1.0,
        2.0 * uniforms[first + 1] - 1.0,
        2.0 * uniforms[first + 2] - 1.0,
    )


def make_walk(points: int) -> Callable[[Vector3, Vector3, tuple[float, ...], int], tuple[Vector3, ...]]:
    """Return (start, largest step along each axis [m], uniforms, index) -> points, each drawn from the one before.

    A step is uniform in a box; the points take three uniform random numbers each, from `index` on.
    """

    def last(point: Vector3, step: Vector3, uniforms: tuple[float, ...], index: int) -> tuple[Vector3, ...]:
        return (add(point, multiply_elementwise(step, symmetric3(uniforms, index))),)

    if points == 1:
        return last
    rest = make_walk(points - 1)

    def walk(point: Vector3, step: Vector3, uniforms: tuple[float, ...], index: int) -> tuple[Vector3, ...]:
        following = add(point, multiply_elementwise(step, symmetric3(uniforms, index)))
        return (following, *rest(following, step, uniforms, index + 3))

    return walk
