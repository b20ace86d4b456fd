"""A seabed as a height field: a mean depth and a few waves, which an episode draws.

    z(x, y) = z_0 + sum over i of a_i sin(k_i . (x, y) + phi_i)                                         (1)

The sum of a_i |k_i| bounds its slope s, so that a point's height above the seabed over sqrt(1 + s^2) is at most its
distance from it, and changes by no more than the point moves: sphere tracing finds where a beam meets it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.vector3 import Vector3
from dq_marine.task.world.rays import make_trace

WAVE_DRAWS = 4
"""Uniform random numbers that a wave of a seabed takes."""

SHORTEST = 0.5
"""The shortest wave, over the longest."""

TRACING = 16
"""Steps of a beam to a seabed: what is left of a range shrinks to less than half in each, where slopes are gentle."""


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

    def nearer(ground: Ground, point: Vector3) -> float:
        height = depth(ground, point[0], point[1]) - point[2]
        return height / math.sqrt(1.0 + ground.steepest * ground.steepest)

    def drawn(
        mean: float, steepest: float, longest: float, uniforms: tuple[float, ...], index: int
    ) -> Ground:
        return Ground(mean, steepest, drawn_waves(steepest / waves, longest, uniforms, index))

    return Seabed(depth, make_trace(nearer, TRACING), drawn)


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
