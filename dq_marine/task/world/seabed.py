"""A seabed as a height field: a mean depth and a few waves, which an episode draws.

    z(x, y) = z_0 + sum over i of a_i sin(k_i . (x, y) + phi_i)                                         (1)

Along a beam in the unit direction d, whose part seen from above is l = (d_x, d_y), the height h above the seabed is
therefore, at a way t on from a point of the beam,

    h(t) >= h - t (sum of a_i |k_i . l| + d_z),    h(t) >= h + h' t - t^2 / 2 sum of a_i (k_i . l)^2      (2)

Sphere tracing (Hart 1996) goes on by the larger of the ways at which these bounds are 0, again and again: it never
passes the seabed, and near it each step is about one of Newton's.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.selection import every
from dq_marine.algebra.vector3 import Vector3, add_scaled

WAVE_DRAWS = 4
"""Uniform random numbers that a wave of a seabed takes."""

SHORTEST = 0.5
"""The shortest wave, over the longest."""

TRACING = 16
"""Steps of a beam to a seabed: of 12,000 that grazed it they left none more than a micrometre above it;
eight would leave one in a thousand 8 cm above. Most end after five."""

LEAST_CLOSING = 1e-6
"""Of a beam and the seabed, per metre: what comes closer more slowly, or not at all, is taken to come at this rate."""


class Wave(NamedTuple):
    """One term of (1): wave number vector [rad/m], phase [rad] and amplitude [m]."""

    north: float
    east: float
    phase: float
    amplitude: float


class Ground(NamedTuple):
    """A seabed: mean depth [m], and waves."""

    depth: float
    waves: Any


class Seabed(NamedTuple):
    """The functions of a seabed of so many waves.

    Attributes:
        depth: (ground, north, east) -> depth there [m].
        cast: (ground, origin, direction, reach) -> range along a ray [m].
        drawn: (depth [m], steepest slope, longest wave [m], uniforms, index) -> ground; takes `WAVE_DRAWS` for each.
        along: (ground, north, east, a level direction's parts) -> depth there [m], and its growth per metre that way.
    """

    depth: Callable[[Ground, float, float], float]
    cast: Callable[[Ground, Vector3, Vector3, float], float]
    drawn: Callable[[float, float, float, tuple[float, ...], int], Ground]
    along: Callable[[Ground, float, float, float, float], tuple[float, float]]


def make_seabed(waves: int) -> Seabed:
    """Return the functions of a seabed of so many waves."""
    relief, relief_along = _make_relief(waves, 0), _make_relief_along(waves, 0)
    bounds, drawn_waves = _make_bounds(waves, 0), _make_drawn(waves, 0)

    def depth(ground: Ground, north: float, east: float) -> float:
        return ground.depth + relief(ground.waves, north, east)

    def along(
        ground: Ground, north: float, east: float, way_north: float, way_east: float
    ) -> tuple[float, float]:
        below, growth = relief_along(ground.waves, north, east, way_north, way_east)
        return ground.depth + below, growth

    def cast(ground: Ground, origin: Vector3, direction: Vector3, reach: float) -> float:
        slope, bend = bounds(ground.waves, direction[0], direction[1])
        closing = max(slope + direction[2], LEAST_CLOSING)
        travelled = 0.0 * origin[0]
        for _ in range(TRACING):
            point = add_scaled(origin, travelled, direction)
            below, growth = along(ground, point[0], point[1], direction[0], direction[1])
            height, falling = max(below - point[2], 0.0), direction[2] - growth
            # The root of the parabola in (2), without a difference: Press et al. 2007, Numerical Recipes, 5.6.
            spread = falling + math.sqrt(falling * falling + 2.0 * bend * height)
            bent = 2.0 * height / max(spread, LEAST_CLOSING)
            before, travelled = travelled, min(travelled + max(height / closing, bent), reach)
            # A step follows from the way so far alone: after one of no length, those that are left would have none.
            if every(travelled == before):
                break
        return travelled

    def drawn(
        mean: float, steepest: float, longest: float, uniforms: tuple[float, ...], index: int
    ) -> Ground:
        return Ground(mean, drawn_waves(steepest / waves, longest, uniforms, index))

    return Seabed(depth, cast, drawn, along)


def _make_relief(count: int, first: int) -> Callable[[Any, float, float], float]:
    def one(waves: Any, north: float, east: float) -> float:
        wave: Wave = waves[first]
        return wave.amplitude * sine_and_cosine(wave.north * north + wave.east * east + wave.phase)[0]

    if first == count - 1:
        return one
    rest = _make_relief(count, first + 1)

    def relief(waves: Any, north: float, east: float) -> float:
        return one(waves, north, east) + rest(waves, north, east)

    return relief


def _make_relief_along(count: int, first: int) -> Callable[[Any, float, float, float, float], Any]:
    """Return (waves, north, east, a direction's parts) -> relief at a place, and its growth per metre that way."""

    def one(waves: Any, north: float, east: float, way_north: float, way_east: float) -> Any:
        wave: Wave = waves[first]
        phase = wave.north * north + wave.east * east + wave.phase
        rate = wave.north * way_north + wave.east * way_east
        sine, cosine = sine_and_cosine(phase)
        return wave.amplitude * sine, wave.amplitude * rate * cosine

    if first == count - 1:
        return one
    rest = _make_relief_along(count, first + 1)

    def relief_along(waves: Any, north: float, east: float, way_north: float, way_east: float) -> Any:
        own = one(waves, north, east, way_north, way_east)
        others = rest(waves, north, east, way_north, way_east)
        return own[0] + others[0], own[1] + others[1]

    return relief_along


def _make_bounds(count: int, first: int) -> Callable[[Any, float, float], Any]:
    """Return (waves, a direction's parts) -> bounds of slope and bend [1/m] that way, those in (2)."""

    def one(waves: Any, way_north: float, way_east: float) -> Any:
        wave: Wave = waves[first]
        rate = abs(wave.north * way_north + wave.east * way_east)
        return wave.amplitude * rate, wave.amplitude * rate * rate

    if first == count - 1:
        return one
    rest = _make_bounds(count, first + 1)

    def bounds(waves: Any, way_north: float, way_east: float) -> Any:
        own, others = one(waves, way_north, way_east), rest(waves, way_north, way_east)
        return own[0] + others[0], own[1] + others[1]

    return bounds


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
