"""From matrices in Fossen's order to the kernel's functions and tuples, leaving out what is zero."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.kernel.branching import branching_pose_force, branching_velocity_force
from dq_marine.kernel.current import MOVING_WATER, STILL_WATER, UniformCurrent, Water
from dq_marine.kernel.damping import DiagonalDamping, FullDamping
from dq_marine.kernel.inertia import Inertia
from dq_marine.kernel.kick import (
    Kick,
    LinearKick,
    NodeKick,
    QuadraticKick,
    UndampedKick,
    diagonal_node_kick,
    diagonal_quadratic_kick,
    full_node_kick,
    full_quadratic_kick,
    linear_kick,
    undamped_kick,
)
from dq_marine.kernel.matrix3 import Matrix3
from dq_marine.kernel.restoring import NetWeight, RightingMoment, net_weight, righting_moment
from dq_marine.kernel.rosenbrock import diagonal_rosenbrock_kick, full_rosenbrock_kick
from dq_marine.kernel.spatial import Matrix6, Spatial
from dq_marine.kernel.strang import StrangTiming
from dq_marine.kernel.vector3 import Vector3

Array = NDArray[np.float64]


class ForceTerm(NamedTuple):
    """A force that a scene has.

    Attributes:
        name: what it is called.
        function: a plain function, compiled with the step, `(parameters, pose, time) -> Spatial`, or with
            `uses_velocity` `(parameters, pose, twist, time) -> Spatial`; see `dq_marine.kernel.forces`. It is found by
            its names: functions that it calls are imported by name, not through their module.
        parameters: nested tuples of floats, handed to the function.
        uses_velocity: whether it depends on the velocity.
        branches: whether the function asks `if`, `and`, `or`, `not`, `min` or `max` of a number that is a body's own. A
            batch then calls it for one body at a time, which is slower than lanes; `dq_marine.kernel.selection` has
            what lanes can do instead.
    """

    name: str
    function: Callable[..., Spatial]
    parameters: Any
    uses_velocity: bool = False
    branches: bool = False

    @property
    def compiled_form(self) -> Callable[..., Spatial]:
        """The function as the step has it."""
        if not self.branches:
            return self.function
        return (branching_velocity_force if self.uses_velocity else branching_pose_force)(self.function)


def vector3(a: NDArray[Any]) -> Vector3:
    """Return an array of shape (3,) as a kernel vector."""
    x, y, z = a.tolist()
    return (x, y, z)


def spatial(a: Array) -> Spatial:
    """Return a vector of shape (6,) in Fossen's order as a kernel pair, angular first."""
    return Spatial(vector3(a[3:]), vector3(a[:3]))


def angular_first(m: Array) -> Array:
    """Reorder a matrix of shape (6, 6) from Fossen's order to angular first; its own inverse."""
    order = [3, 4, 5, 0, 1, 2]
    return m[np.ix_(order, order)]


def matrix3(m: NDArray[Any]) -> Matrix3:
    """Return an array of shape (3, 3) as a kernel matrix."""
    a, b, c, d, e, f, g, h, i = m.ravel().tolist()
    return (a, b, c, d, e, f, g, h, i)


def matrix6(m: NDArray[Any]) -> Matrix6:
    """Return an angular-first array of shape (6, 6) as kernel blocks."""
    return Matrix6(matrix3(m[:3, :3]), matrix3(m[:3, 3:]), matrix3(m[3:, :3]), matrix3(m[3:, 3:]))


def inertia_term(mass_matrix: Array) -> Inertia:
    """Return the kernel's inertia of a symmetric positive definite M in Fossen's order, shape (6, 6)."""
    m = angular_first(mass_matrix)
    inverse = np.linalg.inv(m)
    return Inertia(matrix6(m), matrix6(0.5 * (inverse + inverse.T)), matrix3(np.linalg.inv(m[3:, 3:])))


def restoring_terms(excess_weight: float, arm: Array) -> tuple[ForceTerm, ...]:
    """Return the restoring forces that are present.

    Args:
        excess_weight: W - B [N].
        arm: W r_G - B r_B [N m], shape (3,).
    """
    terms: list[ForceTerm] = []
    if excess_weight != 0.0:
        terms.append(ForceTerm("net weight", net_weight, NetWeight(excess_weight)))
    if arm.any():
        terms.append(ForceTerm("righting moment", righting_moment, RightingMoment(vector3(arm))))
    return tuple(terms)


def nested_parameters(terms: tuple[ForceTerm, ...]) -> Any:
    """Return the terms' parameters as the step wants them: (first, (second, (..., ())))."""
    nested: Any = ()
    for term in reversed(terms):
        nested = (term.parameters, nested)
    return nested


class WaterTerm(NamedTuple):
    """What the water does.

    Attributes:
        name: of the term; empty if the water is still.
        water: the kernel's functions.
        parameters: their numbers, nested tuples.
    """

    name: str
    water: Water
    parameters: Any


def uniform_water(current_ned: Array) -> WaterTerm:
    """Return water that moves with a velocity in NED [m/s], shape (3,): still water if that is zero."""
    if not current_ned.any():
        return WaterTerm("", STILL_WATER, ())
    return WaterTerm("current", MOVING_WATER, UniformCurrent(vector3(current_ned)))


class DampingTerm(NamedTuple):
    """Linear damping matrix (6, 6) and quadratic coefficients (6,) in Fossen's order, with the M they act on.

    `l_stable` chooses between the default kick and the implicit-node one.
    """

    linear: Array
    quadratic: Array
    mass_matrix: Array
    l_stable: bool = True

    @property
    def name(self) -> str:
        """What the kick computes; empty without damping."""
        if self.quadratic.any():
            return f"{'diagonal' if self._is_diagonal else 'full'} linear and quadratic damping"
        return "linear damping" if self.linear.any() else ""

    @property
    def kick(self) -> Kick:
        """The cheapest kick that has all of this damping."""
        if not self.name:
            return undamped_kick
        if not self.l_stable:
            return diagonal_node_kick if self._is_diagonal else full_node_kick
        if self.quadratic.any():
            return diagonal_quadratic_kick if self._is_diagonal else full_quadratic_kick
        return linear_kick

    @property
    def accurate_kick(self) -> Kick:
        """The same for a method of fourth order."""
        if not self.l_stable or not self.quadratic.any():
            return self.kick
        return diagonal_rosenbrock_kick if self._is_diagonal else full_rosenbrock_kick

    def timing(self, step: float) -> StrangTiming:
        """Return what Strang's method needs to know of a step size [s]."""
        half = 0.5 * step
        if self.name and not self.l_stable:
            opening, closing, between = ((0.0, half), (half, 0.0), (half, half))
            return StrangTiming(step, NodeKick(*opening), NodeKick(*closing), NodeKick(*between))
        return StrangTiming(
            step, self._kick_parameters(half), self._kick_parameters(half), self._kick_parameters(step)
        )

    @property
    def _is_diagonal(self) -> bool:
        return not (self.linear - np.diag(np.diag(self.linear))).any()

    @property
    def matrices(self) -> DiagonalDamping | FullDamping | tuple[()]:
        """What the kick needs to know whatever its duration: nothing, if it can be prepared for each."""
        if not self.name or (self.l_stable and not self.quadratic.any()):
            return ()
        coefficients = spatial(self.quadratic)
        if self._is_diagonal:
            return DiagonalDamping(spatial(np.diag(self.linear).copy()), coefficients)
        return FullDamping(matrix6(angular_first(self.linear)), coefficients)

    def _kick_parameters(self, duration: float) -> UndampedKick | LinearKick | QuadraticKick:
        if self.quadratic.any():
            return QuadraticKick(duration)
        return self._linear_kick(duration) if self.linear.any() else UndampedKick(duration)

    def _linear_kick(self, h: float) -> LinearKick:
        """Prepare the kick of a constant D: see `kernel.kick`.

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


LARGEST_PADE_ARGUMENT = 0.05
"""Of the matrix norm: the approximation's error is then below 1e-18."""

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
