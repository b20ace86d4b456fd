"""From matrices in Fossen's order to the kernel's functions and tuples, leaving out what is zero."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.kernel.branching import branching_pose_force, branching_velocity_force
from dq_marine.kernel.current import MOVING_WATER, STILL_WATER, UniformCurrent, Water
from dq_marine.kernel.inertia import Inertia
from dq_marine.kernel.matrix3 import Matrix3
from dq_marine.kernel.restoring import NetWeight, RightingMoment, net_weight, righting_moment
from dq_marine.kernel.spatial import Matrix6, Spatial
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
    return nested([term.parameters for term in terms])


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


def nested(items: Sequence[Any]) -> Any:
    """Return (first, (second, (..., ())))."""
    pairs: Any = ()
    for item in reversed(items):
        pairs = (item, pairs)
    return pairs
