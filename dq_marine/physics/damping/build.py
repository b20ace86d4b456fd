"""Damping of a scene: chooses its kick and the numbers of that kick."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from dq_marine.algebra.nesting import nested
from dq_marine.algebra.spatial import ANGULAR_FIRST
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.kick import (
    Kick,
    LinearKick,
    NodeKick,
    QuadraticKick,
    UndampedKick,
    linear_kick,
    make_node_kick,
    make_quadratic_kick,
    undamped_kick,
)
from dq_marine.integrator.rosenbrock import make_rosenbrock_kick
from dq_marine.integrator.strang import StrangTiming
from dq_marine.physics.damping.formulas.blended import Blend
from dq_marine.physics.damping.formulas.coupled import (
    HEAVE_PLANE,
    SWAY_PLANE,
    CoupledDamping,
    Coupling,
    DampingStructure,
    StripShape,
    coupled_algebra,
)
from dq_marine.physics.damping.formulas.cross_flow import StripRow
from dq_marine.physics.damping.formulas.diagonal import DIAGONAL, FULL, DiagonalDamping, FullDamping
from dq_marine.physics.damping.formulas.drag import make_drag, make_linear_drag
from dq_marine.physics.matrices import Array, angular_first, matrix6, spatial
from dq_marine.physics.term import ForceTerm

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

NO_COUPLINGS = np.zeros((6, 6, 6))
NO_COUPLINGS.flags.writeable = False


class StripTerm(NamedTuple):
    """A row of strips with cross-flow drag.

    Attributes:
        plane: `SWAY_PLANE` or `HEAVE_PLANE`.
        row: coefficient and levers: x in sway, -x in heave.
        number: of strips.
    """

    plane: tuple[int, int]
    row: StripRow
    number: int


class BlendTerm(NamedTuple):
    """Blended damping of an axis, an index in Fossen's order."""

    axis: int
    blend: Blend


class DampingTerm(NamedTuple):
    """All damping of a body in Fossen's order, with the M it acts on.

    Attributes:
        linear: matrix, shape (6, 6).
        quadratic: coefficients of |nu_i| nu_i, shape (6,).
        mass_matrix: M, shape (6, 6).
        l_stable: whether the default kick takes it in, or the implicit-node one.
        couplings: c_ijk of the forces -c_ijk |nu_k| nu_j, shape (6, 6, 6).
        strips: cross-flow drag.
        blends: damping that passes from linear to quadratic under way.
        signed_couplings: c_ijk of the forces -c_ijk nu_k nu_j, shape (6, 6, 6).
    """

    linear: Array
    quadratic: Array
    mass_matrix: Array
    l_stable: bool = True
    couplings: Array = NO_COUPLINGS
    strips: tuple[StripTerm, ...] = ()
    blends: tuple[BlendTerm, ...] = ()
    signed_couplings: Array = NO_COUPLINGS

    @property
    def names(self) -> tuple[str, ...]:
        """Names of what the kick computes; empty without damping."""
        names = [
            self._own_name,
            "damping couplings" if self._has_couplings else "",
            "cross-flow drag" if self.strips else "",
            "blended damping" if self.blends else "",
        ]
        return tuple(filter(None, names))

    @property
    def _own_name(self) -> str:
        if self.quadratic.any():
            return f"{'diagonal' if self._is_diagonal else 'full'} linear and quadratic damping"
        return "linear damping" if self.linear.any() else ""

    @property
    def kick(self) -> Kick:
        """The cheapest kick that has all of this damping."""
        if not self.names:
            return undamped_kick
        if not self.l_stable:
            return make_node_kick(self.algebra)
        return make_quadratic_kick(self.algebra) if self.grows else linear_kick

    @property
    def accurate_kick(self) -> Kick:
        """The same for a method of fourth order."""
        if not self.l_stable or not self.grows:
            return self.kick
        return make_rosenbrock_kick(self.algebra)

    def timing(self, step: float) -> StrangTiming:
        """Return what Strang's method needs to know of a step size [s]."""
        half = 0.5 * step
        if self.names and not self.l_stable:
            opening, closing, between = ((0.0, half), (half, 0.0), (half, half))
            return StrangTiming(step, NodeKick(*opening), NodeKick(*closing), NodeKick(*between))
        return StrangTiming(
            step, self._kick_parameters(half), self._kick_parameters(half), self._kick_parameters(step)
        )

    @property
    def matrices(self) -> DiagonalDamping | FullDamping | CoupledDamping | tuple[()]:
        """Matrices that the kick needs for any duration; none if a kick can be prepared for each duration."""
        if not self.names or (self.l_stable and not self.grows):
            return ()
        coefficients = spatial(self.quadratic)
        own: DiagonalDamping | FullDamping
        if self._is_diagonal:
            own = DiagonalDamping(spatial(np.diag(self.linear).copy()), coefficients)
        else:
            own = FullDamping(matrix6(angular_first(self.linear)), coefficients)
        if not self._is_coupled:
            return own
        present = [
            float(tensor[indices])
            for tensor in (self.couplings, self.signed_couplings)
            for indices in _entries(tensor)
        ]
        return CoupledDamping(
            own,
            nested(present),
            nested([strips.row for strips in self.strips]),
            nested([term.blend for term in self.blends]),
        )

    @property
    def drag(self) -> tuple[ForceTerm, ...]:
        """The same damping as a force; none without damping."""
        if not self.names:
            return ()
        name, matrices = self.names[0], self.stage_matrices
        if self.grows:
            return (ForceTerm(name, make_drag(self.algebra), matrices, uses_velocity=True),)
        return (ForceTerm(name, make_linear_drag(self.algebra), matrices.linear, uses_velocity=True),)

    @property
    def stage_matrices(self) -> Any:
        """What methods need to know of the damping that solve their stages: matrices for any duration."""
        return self._replace(l_stable=False).matrices

    @property
    def grows(self) -> bool:
        """Whether damping depends on the velocity."""
        return bool(self.quadratic.any()) or self._is_coupled

    @property
    def _is_coupled(self) -> bool:
        return self._has_couplings or bool(self.strips) or bool(self.blends)

    @property
    def _has_couplings(self) -> bool:
        return bool(self.couplings.any()) or bool(self.signed_couplings.any())

    @property
    def _is_diagonal(self) -> bool:
        return not (self.linear - np.diag(np.diag(self.linear))).any()

    @property
    def algebra(self) -> DampingAlgebra:
        """Operations on the kind of matrix that this damping needs."""
        if self._is_coupled:
            return coupled_algebra(self._structure)
        return DIAGONAL if self._is_diagonal else FULL

    @property
    def _structure(self) -> DampingStructure:
        couplings = (
            Coupling(ANGULAR_FIRST[i], ANGULAR_FIRST[j], ANGULAR_FIRST[k], signed)
            for tensor, signed in ((self.couplings, False), (self.signed_couplings, True))
            for i, j, k in _entries(tensor)
        )
        shapes = (StripShape(strips.plane, strips.number) for strips in self.strips)
        axes = (ANGULAR_FIRST[term.axis] for term in self.blends)
        return DampingStructure(tuple(couplings), tuple(shapes), tuple(axes), self._is_diagonal)

    def _kick_parameters(self, duration: float) -> UndampedKick | LinearKick | QuadraticKick:
        if self.grows:
            return QuadraticKick(duration)
        return self._linear_kick(duration) if self.linear.any() else UndampedKick(duration)

    def _linear_kick(self, h: float) -> LinearKick:
        """Prepare the kick of a constant D: see `integrator.kick`.

        With x = h D M^-1, mu' = P mu + Q F, P = exp(-x) and Q = h (1 - P) x^-1: exact. From the Pade (3,4)
        approximation p/q of a small part of x, Q then being h ((q - p)/x)/q, and doubled: P becomes P P and Q
        becomes Q + P Q.
        """
        x = h * angular_first(self.linear) @ np.linalg.inv(angular_first(self.mass_matrix))
        doublings = max(0, math.ceil(math.log2(np.abs(x).sum(axis=0).max() / LARGEST_PADE_ARGUMENT)))
        x = x / 2**doublings
        denominator = np.linalg.inv(matrix_polynomial(PADE_DENOMINATOR, x))
        propagator = denominator @ matrix_polynomial(PADE_NUMERATOR, x)
        forcing = h / 2**doublings * denominator @ matrix_polynomial(PADE_FORCING, x)
        for _ in range(doublings):
            forcing = forcing + propagator @ forcing
            propagator = propagator @ propagator
        return LinearKick(matrix6(propagator), matrix6(forcing))


def _entries(couplings: Array) -> list[tuple[int, int, int]]:
    """Return force, velocity and speed of the couplings that are there."""
    return [(i, j, k) for i, j, k in np.argwhere(couplings).tolist()]


LARGEST_PADE_ARGUMENT = 0.05
"""Largest norm of the matrix for which the approximation's error is below 1e-18."""

PADE_NUMERATOR = (1.0, -3.0 / 7.0, 1.0 / 14.0, -1.0 / 210.0)
PADE_DENOMINATOR = (1.0, 4.0 / 7.0, 1.0 / 7.0, 2.0 / 105.0, 1.0 / 840.0)
PADE_FORCING = (1.0, 1.0 / 14.0, 1.0 / 42.0, 1.0 / 840.0)
"""Coefficients of p and q with p(x)/q(x) = exp(-x) + O(x^8), and of (q - p)/x, from the constant on."""


def matrix_polynomial(coefficients: tuple[float, ...], x: Array) -> Array:
    """Return sum_k c_k x^k for a square matrix."""
    total = np.zeros_like(x)
    for coefficient in reversed(coefficients):
        total = total @ x + coefficient * np.eye(len(x))
    return total


def vehicle_damping(vehicle: Vehicle, *, l_stable: bool = True) -> DampingTerm:
    """Return a vehicle's damping, with the default kick or the implicit-node one."""
    strips = []
    for drag in vehicle.cross_flow:
        plane, side = (SWAY_PLANE, 1.0) if drag.plane == "sway" else (HEAVE_PLANE, -1.0)
        row = StripRow(
            drag.strip_coefficient(vehicle.buoyancy.water_density),
            side * float(drag.levers[0]),
            side * drag.length / drag.strips,
        )
        strips.append(StripTerm(plane, row, drag.strips))
    return DampingTerm(
        vehicle.linear_damping,
        vehicle.quadratic_damping,
        vehicle.mass_matrix,
        l_stable,
        vehicle.damping_couplings,
        tuple(strips),
        tuple(BlendTerm(blended.index, blended.blend) for blended in vehicle.damping.blended),
        vehicle.signed_damping_couplings,
    )
