"""Damping matrices with couplings, cross-flow drag and blended damping.

    D(chi) = linear + diag(quadratic |chi|) + sum c_ijk |chi_k| e_i e_j^T + cross-flow drag + blended       (D1)

A coupling c_ijk is a force i by the velocity j that grows with the speed |chi_k|: drag that couples axes (k = j), lift
of body and fins (k = surge). A signed one has chi_k in place of |chi_k|: the moment of lift that the trailing end of a
hull sheds, whichever end that is. D need not be symmetric then. Cross-flow drag is that of
`physics.damping.formulas.cross_flow`, in the plane of sway and yaw or of heave and pitch; blended damping, on the
diagonal, that of `physics.damping.formulas.blended`. The derivative of D(chi) chi has c_ijk |chi_k| in column j, and

    c_ijk sign(chi_k) chi_j   in column k, of a signed one c_ijk chi_j                                      (D2)

besides. Which couplings, strips and blends there are is the `DampingStructure`; what is not in it is neither computed
nor compiled. Indices count the angular part first: 0 to 2 roll, pitch, yaw, 3 to 5 surge, sway, heave.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.entries import Places, add_products
from dq_marine.algebra.nesting import folded
from dq_marine.algebra.selection import select
from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_add_scaled,
    matrix6_diagonal,
    spatial_absolute,
    spatial_scale,
    spatial_subtract,
)
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.physics.damping.formulas.blended import (
    Blend,
    blended_damping,
    blended_slope,
    blended_turning,
)
from dq_marine.physics.damping.formulas.cross_flow import SumStrips, make_strip_sums
from dq_marine.physics.damping.formulas.diagonal import DiagonalDamping, FullDamping
from dq_marine.physics.damping.formulas.matrix_entries import make_component, make_entry_addition
from dq_marine.physics.damping.formulas.matrix_kinds import FULL_MATRIX, MatrixKind, sparse_matrix

SWAY_PLANE, HEAVE_PLANE = (4, 2), (5, 1)
"""The velocity across the flow and the rate of turn of the two planes of cross-flow drag."""

SURGE = 3
"""The velocity that blended damping is weighed by."""


class Coupling(NamedTuple):
    """A force by a velocity times a speed, each an index: c |chi_speed| stands in row `force`, column `velocity`.

    Signed, it is c chi_speed.
    """

    force: int
    velocity: int
    speed: int
    signed: bool = False


class StripShape(NamedTuple):
    """The plane of a row of strips, `SWAY_PLANE` or `HEAVE_PLANE`, and how many there are."""

    plane: tuple[int, int]
    number: int


class DampingStructure(NamedTuple):
    """What a damping matrix is made of, besides its linear part and its quadratic diagonal.

    Attributes:
        couplings: in the order of their numbers.
        strips: likewise.
        blends: likewise; the axes.
        diagonal: whether the linear part is diagonal.
    """

    couplings: tuple[Coupling, ...]
    strips: tuple[StripShape, ...]
    blends: tuple[int, ...]
    diagonal: bool

    @property
    def matrix_kind(self) -> MatrixKind:
        """How D is held."""
        if not self.diagonal:
            return FULL_MATRIX
        places = {(one.force, one.velocity) for one in self.couplings if one.force != one.velocity}
        for shape in self.strips:
            across, turning = shape.plane
            places |= {(across, turning), (turning, across)}
        return sparse_matrix(tuple(sorted(places)))


class CoupledDamping(NamedTuple):
    """The numbers of (D1).

    Attributes:
        own: linear part and quadratic diagonal; a diagonal one if the structure's is.
        couplings: c_ijk, nested in pairs (first, (second, (..., ()))) in the order of the structure.
        strips: a `StripRow` for each of the structure's, nested likewise.
        blends: a `Blend` for each of the structure's, nested likewise.
    """

    own: FullDamping | DiagonalDamping
    couplings: Any
    strips: Any
    blends: Any


AddToMatrix: TypeAlias = Callable[[Any, Spatial, Any], Any]
"""(parameters, twist, matrix) -> matrix, of the kind that it is made for."""


def join_couplings(kind: MatrixKind, couplings: tuple[Coupling, ...]) -> AddToMatrix:
    """Return (numbers, twist, D) -> D with c |chi_k|, or c chi_k, of every coupling added to its entry."""
    if not couplings:
        return add_nothing
    places = Places(
        (kind.place(one.force, one.velocity), index, one.speed if one.signed else 6 + one.speed)
        for index, one in enumerate(couplings)
    )

    def add_couplings(coefficients: Any, twist: Spatial, matrix: Any) -> Any:
        return add_products(places, matrix, coefficients, (twist, spatial_absolute(twist)))

    return add_couplings


def join_coupling_slopes(couplings: tuple[Coupling, ...]) -> AddToMatrix:
    """Return (numbers, twist, S) -> S with the derivative of c |chi_k| chi_j, or c chi_k chi_j, added to its row."""
    if not couplings:
        return add_nothing
    add_couplings = join_couplings(FULL_MATRIX, couplings)
    nothing = (0.0,) * len(couplings)
    turned = Places(
        (index, 6 if one.signed else one.speed, one.velocity) for index, one in enumerate(couplings)
    )
    turning = Places(
        (FULL_MATRIX.place(one.force, one.speed), index, index) for index, one in enumerate(couplings)
    )

    def add_coupling_slopes(coefficients: Any, twist: Spatial, matrix: Matrix6) -> Matrix6:
        velocities = add_products(turned, nothing, (signs_of(twist), 1.0), twist)
        matrix = add_couplings(coefficients, twist, matrix)
        return add_products(turning, matrix, coefficients, velocities)  # (D2)

    return add_coupling_slopes


def signs_of(twist: Spatial) -> Spatial:
    """Return -1 for every component that is negative, and 1 for the others."""
    return Spatial(signs(twist.angular), signs(twist.linear))


def signs(a: Vector3) -> Vector3:
    """Return -1 for every component that is negative, and 1 for the others."""
    return (select(a[0] < 0.0, -1.0, 1.0), select(a[1] < 0.0, -1.0, 1.0), select(a[2] < 0.0, -1.0, 1.0))


@functools.cache
def make_strips(kind: MatrixKind, shape: StripShape, factor: float) -> AddToMatrix:
    """Return (row of strips, twist, D) -> D with `factor` times their cross-flow drag added to its 2x2 block."""
    across, turning = shape.plane
    speed_of, rate_of = make_component(across), make_component(turning)
    sums_of: SumStrips = make_strip_sums(shape.number)
    add_zeroth, add_second, add_first, add_mirrored = (
        make_entry_addition(kind.place(row, column))
        for row, column in ((across, across), (turning, turning), (across, turning), (turning, across))
    )

    def add_strips(row: Any, twist: Spatial, matrix: Any) -> Any:
        sums = sums_of(row, speed_of(twist), rate_of(twist))
        first = factor * sums.first
        matrix = add_first(add_zeroth(matrix, factor * sums.zeroth), first)
        return add_second(add_mirrored(matrix, first), factor * sums.second)

    return add_strips


@functools.cache
def make_blend(kind: MatrixKind, axis: int) -> AddToMatrix:
    """Return (blend, twist, D) -> D with blended damping added to its diagonal."""
    add_entry = make_entry_addition(kind.place(axis, axis))
    surge_of, velocity_of = make_component(SURGE), make_component(axis)

    def add_blend(blend: Blend, twist: Spatial, matrix: Any) -> Any:
        return add_entry(matrix, blended_damping(blend, surge_of(twist), velocity_of(twist)))

    return add_blend


@functools.cache
def make_blend_slope(axis: int) -> AddToMatrix:
    """Return (blend, twist, S) -> S with the derivative of blended damping added to its row (B2)."""
    place = FULL_MATRIX.place
    add_own, add_turning = make_entry_addition(place(axis, axis)), make_entry_addition(place(axis, SURGE))
    surge_of, velocity_of = make_component(SURGE), make_component(axis)

    def add_blend_slope(blend: Blend, twist: Spatial, matrix: Any) -> Any:
        surge, velocity = surge_of(twist), velocity_of(twist)
        matrix = add_own(matrix, blended_slope(blend, surge, velocity))
        return add_turning(matrix, blended_turning(blend, surge, velocity))

    return add_blend_slope


def add_nothing(parameters: Any, twist: Spatial, matrix: Any) -> Any:
    """Return the matrix as it is."""
    return matrix


def join_additions(additions: tuple[AddToMatrix, ...]) -> AddToMatrix:
    """Return the addition of all, whose parameters are nested in pairs."""

    def link(first: AddToMatrix, rest: AddToMatrix) -> AddToMatrix:
        def add_all(parameters: Any, twist: Spatial, matrix: Any) -> Any:
            return rest(parameters[1], twist, first(parameters[0], twist, matrix))

        return add_all

    return folded(link, additions, add_nothing)


@functools.cache
def coupled_algebra(structure: DampingStructure) -> DampingAlgebra:
    """Return the operations on damping matrices of a structure, the same functions for equal structures."""
    kind, full = structure.matrix_kind, FULL_MATRIX
    own_at, own_slope, diagonal_of = kind.own_at, kind.own_slope, kind.diagonal
    add_couplings = join_couplings(kind, structure.couplings)
    add_coupling_slopes = join_coupling_slopes(structure.couplings)
    add_strips = join_additions(tuple(make_strips(kind, shape, 1.0) for shape in structure.strips))
    add_strip_slopes = join_additions(tuple(make_strips(full, shape, 2.0) for shape in structure.strips))
    add_blends = join_additions(tuple(make_blend(kind, axis) for axis in structure.blends))
    add_blend_slopes = join_additions(tuple(make_blend_slope(axis) for axis in structure.blends))

    def coupled_at(damping: CoupledDamping, twist: Spatial) -> Any:
        matrix = add_couplings(damping.couplings, twist, own_at(damping.own, twist))
        return add_blends(damping.blends, twist, add_strips(damping.strips, twist, matrix))

    def coupled_slope(damping: CoupledDamping, twist: Spatial) -> Any:
        matrix = add_coupling_slopes(damping.couplings, twist, own_slope(damping.own, twist))
        return add_blend_slopes(damping.blends, twist, add_strip_slopes(damping.strips, twist, matrix))

    def coupled_growth(damping: CoupledDamping, s: float, before: Spatial, after: Spatial) -> Spatial:
        slow, fast = diagonal_of(coupled_at(damping, before)), diagonal_of(coupled_at(damping, after))
        return spatial_scale(s, spatial_subtract(fast, slow))

    def coupled_corners(damping: CoupledDamping) -> Spatial:
        return damping.own.quadratic

    return DampingAlgebra(
        at=coupled_at,
        slope=coupled_slope,
        growth=coupled_growth,
        apply=kind.apply,
        add_scaled=kind.add_scaled,
        add_slope=matrix6_add_scaled,
        sandwich=kind.sandwich,
        slope_diagonal=matrix6_diagonal,
        corners=coupled_corners,
    )
