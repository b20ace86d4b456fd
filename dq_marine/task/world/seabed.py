"""A seabed as a height field: a mean depth and a few waves, which an episode draws.

    z(x, y) = z_0 + sum over i of a_i sin(k_i . (x, y) + phi_i)                                         (1)

The sum of a_i |k_i| bounds its slope s, so that along a beam in the unit direction d, the height above the seabed falls
by s sqrt(d_x^2 + d_y^2) + d_z per metre at most. Going on by the height over that, again and again, a beam meets the
seabed and never passes it: sphere tracing (Hart 1996) with a bound that knows the direction, which goes straight down
in one step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.level import level_length
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.vector3 import Vector3, add_scaled
from dq_marine.integrator.body import Motion

WAVE_DRAWS = 4
"""Uniform random numbers that a wave of a seabed takes."""

SHORTEST = 0.5
"""The shortest wave, over the longest."""

TRACING = 16
"""Steps of a beam to a seabed: what is left of a range shrinks by a fixed factor in each, the more the gentler it is."""

LEAST_CLOSING = 1e-6
"""Of a beam to the seabed, per metre: what comes closer more slowly, or not at all, goes on at this rate."""


class Wave(NamedTuple):
    """One term of (1): wave number vector [rad/m], phase [rad] and amplitude [m]."""

    north: float
    east: float
    phase: float
    amplitude: float


class Ground(NamedTuple):
    """A seabed: mean depth [m], the largest slope, waves."""

    depth: float
    steepest: float
    waves: Any


class Seabed(NamedTuple):
    """The functions of a seabed of so many waves.

    Attributes:
        depth: (ground, north, east) -> depth there [m].
        cast: (ground, origin, direction, reach) -> range along a ray [m].
        drawn: (depth [m], steepest slope, longest wave [m], uniforms, index) -> ground; takes `WAVE_DRAWS` for each.
    """

    depth: Callable[[Ground, float, float], float]
    cast: Callable[[Ground, Vector3, Vector3, float], float]
    drawn: Callable[[float, float, float, tuple[float, ...], int], Ground]


def make_seabed(waves: int) -> Seabed:
    """Return the functions of a seabed of so many waves."""
    relief, drawn_waves = _make_relief(waves, 0), _make_drawn(waves, 0)

    def depth(ground: Ground, north: float, east: float) -> float:
        return ground.depth + relief(ground.waves, north, east)

    def cast(ground: Ground, origin: Vector3, direction: Vector3, reach: float) -> float:
        closing = ground.steepest * level_length((direction[0], direction[1])) + direction[2]
        per_height = 1.0 / max(closing, LEAST_CLOSING)
        travelled = 0.0 * origin[0]
        for _ in range(TRACING):
            point = add_scaled(origin, travelled, direction)
            height = depth(ground, point[0], point[1]) - point[2]
            travelled = min(travelled + max(height, 0.0) * per_height, reach)
        return travelled

    def drawn(
        mean: float, steepest: float, longest: float, uniforms: tuple[float, ...], index: int
    ) -> Ground:
        return Ground(mean, steepest, drawn_waves(steepest / waves, longest, uniforms, index))

    return Seabed(depth, cast, drawn)


def make_under_keel(
    depth: Callable[[Any, float, float], float],
) -> Callable[[Any, Motion, float, float], float]:
    """Return (ground, motion, half the length, half the height [m]) -> clearance of a hull from the ground [m].

    It is the least height of bow, middle and stern above the ground, less half the hull's height.
    """

    def height(ground: Any, point: Vector3) -> float:
        return depth(ground, point[0], point[1]) - point[2]

    def under_keel(ground: Any, motion: Motion, half_length: float, half_height: float) -> float:
        place, ahead = motion.position_ned, rotate(motion.attitude, (1.0, 0.0, 0.0))
        bow = height(ground, add_scaled(place, half_length, ahead))
        stern = height(ground, add_scaled(place, -half_length, ahead))
        return min(height(ground, place), min(bow, stern)) - half_height

    return under_keel


def _make_relief(count: int, first: int) -> Callable[[Any, float, float], float]:
    def one(waves: Any, north: float, east: float) -> float:
        wave: Wave = waves[first]
        return wave.amplitude * math.sin(wave.north * north + wave.east * east + wave.phase)

    if first == count - 1:
        return one
    rest = _make_relief(count, first + 1)

    def relief(waves: Any, north: float, east: float) -> float:
        return one(waves, north, east) + rest(waves, north, east)

    return relief


def _make_drawn(count: int, first: int) -> Callable[[float, float, tuple[float, ...], int], Any]:
    def one(steepness: float, longest: float, uniforms: tuple[float, ...], index: int) -> Any:
        at = index + WAVE_DRAWS * first
        number = 2.0 * math.pi / (longest * (SHORTEST + (1.0 - SHORTEST) * uniforms[at]))
        course, phase = 2.0 * math.pi * uniforms[at + 1], 2.0 * math.pi * uniforms[at + 2]
        amplitude = steepness / number * (0.5 + 0.5 * uniforms[at + 3])
        return (Wave(number * math.cos(course), number * math.sin(course), phase, amplitude),)

    if first == count - 1:
        return one
    rest = _make_drawn(count, first + 1)

    def drawn(steepness: float, longest: float, uniforms: tuple[float, ...], index: int) -> Any:
        return (*one(steepness, longest, uniforms, index), *rest(steepness, longest, uniforms, index))

    return drawn
