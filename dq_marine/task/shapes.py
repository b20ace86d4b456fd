"""Curves by number: circle, helix, lemniscate, and a circle with waves that are drawn; at any heading, on any side."""

from __future__ import annotations

import math

from dq_marine.algebra.vector3 import Vector3
from dq_marine.task.harmonics import Curve

SHAPES = ("circle", "helix", "lemniscate", "wavy")
CIRCLE, HELIX, LEMNISCATE, WAVY = range(len(SHAPES))

SHAPE_DRAWS = 11
"""Uniform random numbers that `shaped_curve` takes."""

UNEVENNESS = (0.0, 0.1, 0.04)
"""Of a wavy circle: largest second and third harmonic along each axis, over the radius; so its slope is never 0."""

# Cosine and sine of one size add up to sqrt(2) of it along an axis, and two axes in phase to sqrt(2) of that.
STEEPEST = (1.0, 1.0, math.sqrt(2.0), 1.0 + 2.0 * (2.0 * UNEVENNESS[1] + 3.0 * UNEVENNESS[2]))
"""Largest level slope of each shape, over its radius: what its speed is told by."""


def shaped_curve(
    shape: float, radius: float, height: float, uniforms: tuple[float, ...], first: int
) -> Curve:
    """Return a curve about the origin.

    Args:
        shape: index in `SHAPES`.
        radius: of the circle that it is or comes from, or half the length of the lemniscate [m].
        height: by which a helix goes down in a turn, and a wavy circle up and down [m].
        uniforms: random numbers in [0, 1), of which `SHAPE_DRAWS` from `first` on are used.
        first: see `uniforms`.
    """
    heading = 2.0 * math.pi * uniforms[first]
    side = 1.0 if uniforms[first + 1] < 0.5 else -1.0
    eight, wavy = shape == LEMNISCATE, shape == WAVY
    c1 = (0.0, 0.0 if eight else -1.0, 0.0)
    s1 = (1.0, 0.0, 0.5 * height / radius * _signed(uniforms[first + 2]) if wavy else 0.0)
    c2, s2 = _drawn(wavy, UNEVENNESS[1], uniforms, first + 3)
    c3, s3 = _drawn(wavy, UNEVENNESS[2], uniforms, first + 7)
    s2 = (s2[0], 0.5 if eight else s2[1], 0.0)
    down = height / (2.0 * math.pi) if shape == HELIX else 0.0
    return Curve(
        (0.0, 0.0, 0.0),
        (0.0, 0.0, down),
        (
            _turned(c1, radius, side, heading),
            _turned(c2, radius, side, heading),
            _turned(c3, radius, side, heading),
        ),
        (
            _turned(s1, radius, side, heading),
            _turned(s2, radius, side, heading),
            _turned(s3, radius, side, heading),
        ),
    )


def _drawn(wavy: bool, size: float, uniforms: tuple[float, ...], first: int) -> tuple[Vector3, Vector3]:
    """Return the coefficients of a harmonic: drawn of a wavy circle, else none."""
    size = size if wavy else 0.0
    return (
        (size * _signed(uniforms[first]), size * _signed(uniforms[first + 1]), 0.0),
        (size * _signed(uniforms[first + 2]), size * _signed(uniforms[first + 3]), 0.0),
    )


def _signed(uniform: float) -> float:
    return 2.0 * uniform - 1.0


def _turned(vector: Vector3, radius: float, side: float, heading: float) -> Vector3:
    """Return a vector of a radius of 1 made larger, mirrored if side is -1, and turned about the vertical."""
    c, s = radius * math.cos(heading), radius * math.sin(heading)
    x, y = vector[0], side * vector[1]
    return (c * x - s * y, s * x + c * y, radius * vector[2])
