"""Quadrature across the zero of a velocity, where |v| v has a corner in its slope that no polynomial follows.

Collocation integrates the polynomial through the rates at the stages, and errs by the order of h^3 in a step in which
a velocity v passes through zero. There the integral of -c |v| v to stage i is taken piece by piece instead, with the
polynomial p through the velocity at the stages, its zero tau and the sign s that it has afterwards. What that adds to
the quadrature is (docs/theory.md, eq. RI5)

    C_i = -2 c s (int_tau^c_i p^2 dt - sum_(j: c_j > tau) A_ij p_j^2),                               (RI5)

the integral being zero before tau. Velocities and the step are scaled: p is h v, and the step lasts 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.selection import select, some
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum, stages_apart
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.collocation import Collocation

Corners: TypeAlias = Callable[[Spatial, Spatial, Spatial], Spatial]
"""(c of all axes, twist at the start, twists at the stages) -> C at the stages."""


class Cubic(NamedTuple):
    """A cubic height + slope u + curving u^2 + twisting u^3 of the time u from about its zero."""

    height: float
    slope: float
    curving: float
    twisting: float


def flip(before: float, after: float) -> float:
    """Return 1 where a velocity changes its sign, else 0."""
    return select(before * after < 0.0, 1.0, 0.0)


def beyond(before: float, p: float) -> float:
    """Return p^2 where the velocity has left the sign that it had before, else 0."""
    return select(before * p < 0.0, p * p, 0.0)


def turned(c: Vector3, before: Vector3, at: Vector3) -> bool:
    """Whether a velocity with a corner has left the sign that it had before."""
    return (
        (c[0] * before[0] * at[0] < 0.0) | (c[1] * before[1] * at[1] < 0.0) | (c[2] * before[2] * at[2] < 0.0)
    )


def any_turned(c: Spatial, before: Spatial, at: Spatial) -> float:
    """Return 1 where one of six velocities has left the sign that it had before, else 0."""
    return select(
        turned(c.angular, before.angular, at.angular) | turned(c.linear, before.linear, at.linear), 1.0, 0.0
    )


def integral_beyond(node: float, zero: float, p: Cubic) -> float:
    """Return the integral of p^2 from its zero to the node."""
    u = max(node - zero, 0.0)
    a = p.height * p.height
    b = p.height * p.slope
    c = (p.slope * p.slope + 2.0 * p.height * p.curving) * (1.0 / 3.0)
    d = (p.slope * p.curving + p.height * p.twisting) * 0.5
    e = (2.0 * p.slope * p.twisting + p.curving * p.curving) * 0.2
    f = p.curving * p.twisting * (1.0 / 3.0)
    g = p.twisting * p.twisting * (1.0 / 7.0)
    return u * (a + u * (b + u * (c + u * (d + u * (e + u * (f + u * g))))))


def missing(wanted: bool, factor: float, exact: float, taken: float) -> float:
    """Return factor (exact - taken) where it is wanted, else 0."""
    return select(wanted, factor * (exact - taken), 0.0)


def make_corners(method: Collocation) -> Corners:
    """Return the correction (RI5) of a method with four stages, all axes together."""
    matrix, nodes = method.matrix, method.nodes
    first, second, third, fourth = nodes
    nothing, ones = (0.0,) * len(nodes), (1.0,) * len(nodes)
    no_corners = make_no_corners(method)
    constant, linear, square, cubic = coefficients(method)

    def corner(c: float, before: float, p: Any) -> Any:
        """Return C of one axis, from its velocity at the start and at the stages."""
        found = stage_constants(nothing, before)
        p1, p2, p3, p4 = stages_apart(nodes, p)
        flips = flip(before, p1) + flip(p1, p2) + flip(p2, p3) + flip(p3, p4)
        crosses = (flips == 1.0) & (c != 0.0)
        if some(crosses):
            # The stages between which the sign changes, and the zero of the chord there.
            late, later, latest = before * p1 >= 0.0, before * p2 >= 0.0, before * p3 >= 0.0
            left = select(latest, third, select(later, second, select(late, first, 0.0)))
            right = select(latest, fourth, select(later, third, select(late, second, first)))
            low = select(latest, p3, select(later, p2, select(late, p1, before)))
            high = select(latest, p4, select(later, p3, select(late, p2, p1)))
            zero = left + (right - left) * (low / (low - high))
            a0, a1 = stage_sum(constant, p), stage_sum(linear, p)
            a2, a3 = stage_sum(square, p), stage_sum(cubic, p)
            # One step of Newton's method: an error of the zero counts by its cube, as p^2 is small there.
            height = a0 + zero * (a1 + zero * (a2 + zero * a3))
            slope = a1 + zero * (2.0 * a2 + zero * (3.0 * a3))
            zero = max(left, min(right, zero - height / select(slope == 0.0, 1.0, slope)))
            there = Cubic(
                a0 + zero * (a1 + zero * (a2 + zero * a3)),
                a1 + zero * (2.0 * a2 + zero * (3.0 * a3)),
                a2 + 3.0 * (zero * a3),
                a3,
            )
            exact = each_stage(nodes, integral_beyond, (stage_constants(nodes, before), zero, there))
            taken = stage_product(matrix, each_stage(nodes, beyond, (before, p)))
            factor = select(before < 0.0, -2.0 * c, 2.0 * c)
            found = each_stage(nodes, missing, (crosses, factor, exact, taken))
        return found

    def all_corners(c: Spatial, start: Spatial, at: Spatial) -> Spatial:
        angular, linear = at.angular, at.linear
        return Spatial(
            (
                corner(c.angular[0], start.angular[0], angular[0]),
                corner(c.angular[1], start.angular[1], angular[1]),
                corner(c.angular[2], start.angular[2], angular[2]),
            ),
            (
                corner(c.linear[0], start.linear[0], linear[0]),
                corner(c.linear[1], start.linear[1], linear[1]),
                corner(c.linear[2], start.linear[2], linear[2]),
            ),
        )

    def corners(c: Spatial, start: Spatial, at: Spatial) -> Spatial:
        found = no_corners(c, start, at)
        if some(stage_sum(ones, each_stage(nodes, any_turned, (c, start, at))) > 0.0):
            found = all_corners(c, start, at)
        return found

    return corners


def make_no_corners(method: Collocation) -> Corners:
    """Return the correction where no force has corners."""
    nothing = (0.0,) * len(method.nodes)

    def no_corners(c: Spatial, start: Spatial, at: Spatial) -> Spatial:
        zero = stage_constants(nothing, start.linear[0])
        return Spatial((zero, zero, zero), (zero, zero, zero))

    return no_corners


def coefficients(method: Collocation) -> tuple[tuple[float, ...], ...]:
    """Return what gives the coefficients of the polynomial through values at the stages, in the time from the start.

    `Collocation.powers` has them, halved, for x = 2 t - 1; this expands the powers of x.
    """
    count = len(method.nodes)
    found = [[0.0] * count for _ in range(count)]
    for power, row in enumerate(method.powers):
        for k in range(power + 1):
            binomial = math.comb(power, k) * 2.0**k * (-1.0) ** (power - k)
            for j in range(count):
                found[k][j] += 2.0 * binomial * row[j]
    return tuple(map(tuple, found))
