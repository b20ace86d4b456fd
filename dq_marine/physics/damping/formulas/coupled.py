"""Damping matrices with couplings, cross-flow drag and blended damping.

    D(chi) = linear + diag(quadratic |chi|) + sum c_ijk |chi_k| e_i e_j^T + cross-flow drag + blended       (D1)

A coupling c_ijk is a force i by the velocity j that grows with the speed |chi_k|: drag that couples axes (k = j), lift
of body and fins (k = surge). D need not be symmetric then. Cross-flow drag is that of
`physics.damping.formulas.cross_flow`, in the plane of sway and yaw or of heave and pitch; blended damping, on the
diagonal, that of `physics.damping.formulas.blended`. The derivative of D(chi) chi has c_ijk |chi_k| in column j, and

    c_ijk sign(chi_k) chi_j   in column k                                                                   (D2)

besides. Which couplings, strips and blends there are is the `DampingStructure`; what is not in it is neither computed
nor compiled. Indices count the angular part first: 0 to 2 roll, pitch, yaw, 3 to 5 surge, sway, heave.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.matrix3 import Matrix3
from dq_marine.algebra.nesting import folded
from dq_marine.algebra.selection import select
from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_add_scaled,
    matrix6_diagonal,
    matrix6_transform,
)
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.physics.damping.formulas.blended import (
    Blend,
    blended_damping,
    blended_slope,
    blended_turning,
)
from dq_marine.physics.damping.formulas.cross_flow import SumStrips, make_strip_sums
from dq_marine.physics.damping.formulas.diagonal import FullDamping, full_at, full_sandwich, full_slope

SWAY_PLANE, HEAVE_PLANE = (4, 2), (5, 1)
"""The velocity across the flow and the rate of turn of the two planes of cross-flow drag."""

SURGE = 3
"""The velocity that blended damping is weighed by."""


class Coupling(NamedTuple):
    """A force by a velocity times a speed, each an index: c |chi_speed| stands in row `force`, column `velocity`."""

    force: int
    velocity: int
    speed: int


class StripShape(NamedTuple):
    """The plane of a row of strips, `SWAY_PLANE` or `HEAVE_PLANE`, and how many there are."""

    plane: tuple[int, int]
    number: int


class DampingStructure(NamedTuple):
    """What a damping matrix is made of, besides its linear part and its diagonal; of blends, the axes."""

    couplings: tuple[Coupling, ...]
    strips: tuple[StripShape, ...]
    blends: tuple[int, ...]


class CoupledDamping(NamedTuple):
    """The numbers of (D1).

    Attributes:
        own: linear part and quadratic diagonal.
        couplings: c_ijk, nested in pairs (first, (second, (..., ()))) in the order of the structure.
        strips: a `StripRow` for each of the structure's, nested likewise.
        blends: a `Blend` for each of the structure's, nested likewise.
    """

    own: FullDamping
    couplings: Any
    strips: Any
    blends: Any


AddToMatrix: TypeAlias = Callable[[Any, Spatial, Matrix6], Matrix6]
"""(parameters, twist, matrix) -> matrix."""


@functools.cache
def make_component(index: int) -> Callable[[Spatial], float]:
    """Return the function that takes one of the six components of a twist."""
    place = index % 3

    def angular_component(a: Spatial) -> float:
        return a.angular[place]

    def linear_component(a: Spatial) -> float:
        return a.linear[place]

    return angular_component if index < 3 else linear_component


@functools.cache
def make_entry_addition(row: int, column: int) -> Callable[[Matrix6, float], Matrix6]:
    """Return (m, value) -> m with a value added to one entry."""
    place = 3 * (row % 3) + column % 3
    after = place + 1

    def raised(block: Matrix3, value: float) -> Any:
        return block[:place] + (block[place] + value,) + block[after:]  # noqa: RUF005 - compiled code knows no star

    def add_angular(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(raised(m.angular, value), m.angular_linear, m.linear_angular, m.linear)

    def add_angular_linear(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(m.angular, raised(m.angular_linear, value), m.linear_angular, m.linear)

    def add_linear_angular(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(m.angular, m.angular_linear, raised(m.linear_angular, value), m.linear)

    def add_linear(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(m.angular, m.angular_linear, m.linear_angular, raised(m.linear, value))

    if row < 3:
        return add_angular if column < 3 else add_angular_linear
    return add_linear_angular if column < 3 else add_linear


@functools.cache
def make_coupling(coupling: Coupling) -> AddToMatrix:
    """Return (c, twist, D) -> D with c |chi_k| added to its entry."""
    add_entry = make_entry_addition(coupling.force, coupling.velocity)
    speed_of = make_component(coupling.speed)

    def add_coupling(coefficient: float, twist: Spatial, matrix: Matrix6) -> Matrix6:
        return add_entry(matrix, coefficient * abs(speed_of(twist)))

    return add_coupling


@functools.cache
def make_coupling_slope(coupling: Coupling) -> AddToMatrix:
    """Return (c, twist, S) -> S with the derivative of c |chi_k| chi_j added to its row."""
    add_coupling = make_coupling(coupling)
    add_entry = make_entry_addition(coupling.force, coupling.speed)
    speed_of, velocity_of = make_component(coupling.speed), make_component(coupling.velocity)

    def add_coupling_slope(coefficient: float, twist: Spatial, matrix: Matrix6) -> Matrix6:
        turning = coefficient * velocity_of(twist)  # (D2)
        turning = select(speed_of(twist) < 0.0, -turning, turning)
        return add_entry(add_coupling(coefficient, twist, matrix), turning)

    return add_coupling_slope


@functools.cache
def make_strips(shape: StripShape, factor: float) -> AddToMatrix:
    """Return (row of strips, twist, D) -> D with `factor` times their cross-flow drag added to its 2x2 block."""
    across, turning = shape.plane
    speed_of, rate_of = make_component(across), make_component(turning)
    sums_of: SumStrips = make_strip_sums(shape.number)
    add_zeroth, add_second = make_entry_addition(across, across), make_entry_addition(turning, turning)
    add_first, add_mirrored = make_entry_addition(across, turning), make_entry_addition(turning, across)

    def add_strips(row: Any, twist: Spatial, matrix: Matrix6) -> Matrix6:
        sums = sums_of(row, speed_of(twist), rate_of(twist))
        first = factor * sums.first
        matrix = add_first(add_zeroth(matrix, factor * sums.zeroth), first)
        return add_second(add_mirrored(matrix, first), factor * sums.second)

    return add_strips


@functools.cache
def make_blend(axis: int) -> AddToMatrix:
    """Return (blend, twist, D) -> D with blended damping added to its diagonal."""
    add_entry = make_entry_addition(axis, axis)
    surge_of, velocity_of = make_component(SURGE), make_component(axis)

    def add_blend(blend: Blend, twist: Spatial, matrix: Matrix6) -> Matrix6:
        return add_entry(matrix, blended_damping(blend, surge_of(twist), velocity_of(twist)))

    return add_blend


@functools.cache
def make_blend_slope(axis: int) -> AddToMatrix:
    """Return (blend, twist, S) -> S with the derivative of blended damping added to its row (B2)."""
    add_own, add_turning = make_entry_addition(axis, axis), make_entry_addition(axis, SURGE)
    surge_of, velocity_of = make_component(SURGE), make_component(axis)

    def add_blend_slope(blend: Blend, twist: Spatial, matrix: Matrix6) -> Matrix6:
        surge, velocity = surge_of(twist), velocity_of(twist)
        matrix = add_own(matrix, blended_slope(blend, surge, velocity))
        return add_turning(matrix, blended_turning(blend, surge, velocity))

    return add_blend_slope


def add_nothing(parameters: Any, twist: Spatial, matrix: Matrix6) -> Matrix6:
    """Return the matrix as it is."""
    return matrix


def join_additions(additions: tuple[AddToMatrix, ...]) -> AddToMatrix:
    """Return the addition of all, whose parameters are nested in pairs."""

    def link(first: AddToMatrix, rest: AddToMatrix) -> AddToMatrix:
        def add_all(parameters: Any, twist: Spatial, matrix: Matrix6) -> Matrix6:
            return rest(parameters[1], twist, first(parameters[0], twist, matrix))

        return add_all

    return folded(link, additions, add_nothing)


@functools.cache
def coupled_algebra(structure: DampingStructure) -> DampingAlgebra:
    """Return the operations on damping matrices of a structure, the same functions for equal structures."""
    add_couplings = join_additions(tuple(make_coupling(c) for c in structure.couplings))
    add_coupling_slopes = join_additions(tuple(make_coupling_slope(c) for c in structure.couplings))
    add_strips = join_additions(tuple(make_strips(shape, 1.0) for shape in structure.strips))
    add_strip_slopes = join_additions(tuple(make_strips(shape, 2.0) for shape in structure.strips))
    add_blends = join_additions(tuple(make_blend(axis) for axis in structure.blends))
    add_blend_slopes = join_additions(tuple(make_blend_slope(axis) for axis in structure.blends))

    def coupled_at(damping: CoupledDamping, twist: Spatial) -> Matrix6:
        matrix = add_couplings(damping.couplings, twist, full_at(damping.own, twist))
        return add_blends(damping.blends, twist, add_strips(damping.strips, twist, matrix))

    def coupled_slope(damping: CoupledDamping, twist: Spatial) -> Matrix6:
        matrix = add_coupling_slopes(damping.couplings, twist, full_slope(damping.own, twist))
        return add_blend_slopes(damping.blends, twist, add_strip_slopes(damping.strips, twist, matrix))

    def coupled_growth(damping: CoupledDamping, s: float, before: Spatial, after: Spatial) -> Spatial:
        slow, fast = coupled_at(damping, before), coupled_at(damping, after)
        (a, _, _, b), (c, _, _, d) = slow, fast
        return Spatial(
            (s * (c[0] - a[0]), s * (c[4] - a[4]), s * (c[8] - a[8])),
            (s * (d[0] - b[0]), s * (d[4] - b[4]), s * (d[8] - b[8])),
        )

    def coupled_corners(damping: CoupledDamping) -> Spatial:
        return damping.own.quadratic

    return DampingAlgebra(
        at=coupled_at,
        slope=coupled_slope,
        growth=coupled_growth,
        apply=matrix6_transform,
        add_scaled=matrix6_add_scaled,
        sandwich=full_sandwich,
        diagonal=matrix6_diagonal,
        corners=coupled_corners,
    )
