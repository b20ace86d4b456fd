"""Range sensors: fans of beams fixed to a vehicle, and what is wrong with their readings."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.normal import normal_pair
from dq_marine.algebra.quaternion import Quaternion, rotate
from dq_marine.algebra.selection import select, smallest_normal
from dq_marine.algebra.stages import for_each
from dq_marine.algebra.vector3 import Vector3, add_scaled, scale

FORWARD = math.pi
"""Angle of a fan that sees all that is ahead [rad]."""

BOW, STARBOARD, DOWN = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
"""Unit vectors in the body frame."""

SWATH = math.radians(100.0)
"""Angle of a fan that sees the ground across the way [rad]."""

HIGHEST_BEAM = math.radians(15.0)
"""Of a fan that sees the ground ahead: how far below the bow [rad]."""

NO_ECHO = 1e9
"""Error of a reading that is lost [m]: held within the reach, it reads as if nothing were there."""

Cast = Callable[[Any, Vector3, Vector3, float], float]
"""(world, origin, direction, reach) -> range."""


def fan_bearings(beams: int, spread: float) -> tuple[float, ...]:
    """Return the bearings of beams from the bow, from port to starboard, evenly within half a spread [rad]."""
    return tuple(spread * (i / (beams - 1) - 0.5) for i in range(beams))


def round_bearings(beams: int) -> tuple[float, ...]:
    """Return the bearings of beams from the bow, evenly all round, from that astern over port to starboard [rad]."""
    return tuple(math.tau * (i / beams - 0.5) for i in range(beams))


def ground_bearings(beams: int) -> tuple[float, ...]:
    """Return the bearings of beams that see the ground ahead, evenly down to the last, an altimeter's [rad].

    They are measured from the bow downwards.
    """
    step = (0.5 * math.pi - HIGHEST_BEAM) / (beams - 1)
    return tuple(HIGHEST_BEAM + step * i for i in range(beams))


class Fan(NamedTuple):
    """Where beams in a plane of the vehicle point.

    Attributes:
        bearings: of the beams, from `middle` towards `side` [rad].
        middle: unit vector in the body frame that a bearing of 0 points along.
        side: unit vector in the body frame, square to it, that a bearing of pi/2 points along.
    """

    bearings: tuple[float, ...]
    middle: Vector3
    side: Vector3


def fan_forward(beams: int) -> Fan:
    """Return the fan that sees what is round the bow, from port to starboard within `FORWARD`."""
    return Fan(fan_bearings(beams, FORWARD), BOW, STARBOARD)


def fan_round(beams: int) -> Fan:
    """Return the fan that sees what is all round, from astern over port to starboard."""
    return Fan(round_bearings(beams), BOW, STARBOARD)


def fan_ahead(beams: int) -> Fan:
    """Return the fan that sees the ground ahead and, by its last beam, straight down."""
    return Fan(ground_bearings(beams), BOW, DOWN)


def fan_across(beams: int) -> Fan:
    """Return the fan that sees the ground across the way, from port to starboard within `SWATH`."""
    return Fan(fan_bearings(beams, SWATH), DOWN, STARBOARD)


def directions_of(fan: Fan) -> tuple[Vector3, ...]:
    """Return the directions of a fan's beams, unit vectors in the body frame."""
    return tuple(
        add_scaled(scale(math.cos(one), fan.middle), math.sin(one), fan.side) for one in fan.bearings
    )


def make_fan(fan: Fan, cast: Cast) -> Callable[[Any, Vector3, Quaternion, float], Any]:
    """Return (world, position, attitude, reach) -> ranges of a fan's beams.

    Args:
        fan: where they point.
        cast: what a beam meets.
    """
    ways = tuple((math.cos(one), math.sin(one)) for one in fan.bearings)
    fan_middle, fan_side = fan.middle, fan.side

    def one(way: tuple[float, float], others: Any) -> float:
        world, position, middle, side, reach = others
        return cast(world, position, add_scaled(scale(way[0], middle), way[1], side), reach)

    def ranges(world: Any, position: Vector3, attitude: Quaternion, reach: float) -> Any:
        middle, side = rotate(attitude, fan_middle), rotate(attitude, fan_side)
        return for_each(ways, one, (world, position, middle, side, reach))

    return ranges


def make_errors(beams: int, first: int = 0) -> Callable[[float, float, tuple[float, ...]], Any]:
    """Return (noise [m], dropout, uniforms) -> errors of an even number of readings [m], one uniform number for each.

    A reading is lost with a probability of `dropout`, which is less than 1; else its error is normal.
    """
    second = first + 1

    def pair(noise: float, dropout: float, uniforms: tuple[float, ...]) -> Any:
        a, b = uniforms[first], uniforms[second]
        one, other = normal_pair(_left_over(a, dropout), _left_over(b, dropout))
        return (
            select(a < dropout, NO_ECHO, noise * one),
            select(b < dropout, NO_ECHO, noise * other),
        )

    if second == beams - 1:
        return pair
    rest = make_errors(beams, first + 2)

    def errors(noise: float, dropout: float, uniforms: tuple[float, ...]) -> Any:
        return (*pair(noise, dropout, uniforms), *rest(noise, dropout, uniforms))

    return errors


def make_readings(beams: int, first: int = 0) -> Callable[[Any, Any, float], Any]:
    """Return (ranges [m], errors [m], reach [m]) -> readings as shares of the reach: 1 where no echo comes back."""

    def one(ranges: Any, errors: Any, reach: float) -> Any:
        told = max(0.0, min(1.0, (ranges[first] + errors[first]) / reach))
        return (select(ranges[first] < reach, told, 1.0),)

    if first == beams - 1:
        return one
    rest = make_readings(beams, first + 1)

    def readings(ranges: Any, errors: Any, reach: float) -> Any:
        return (*one(ranges, errors, reach), *rest(ranges, errors, reach))

    return readings


def _left_over(uniform: float, dropout: float) -> float:
    """Return a uniform number that does not depend on whether the given one is below `dropout`."""
    tiny = smallest_normal(uniform)
    lost, kept = uniform / max(dropout, tiny), (uniform - dropout) / (1.0 - dropout)
    return select(uniform < dropout, lost, kept)
