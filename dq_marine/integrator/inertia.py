"""The 6x6 inertia M = M_RB + M_A of a body in water, with the inverses that the step needs."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.matrix3 import Matrix3
from dq_marine.algebra.spatial import Matrix6, Spatial, matrix6_transform


class Inertia(NamedTuple):
    """Symmetric positive definite M about the body origin, any coupling.

    Attributes:
        matrix: M [kg m^2, kg m, kg].
        inverse: M^-1.
        linear_block_inverse: inverse of M's linear 3x3 block [1/kg]; not a block of M^-1.
    """

    matrix: Matrix6
    inverse: Matrix6
    linear_block_inverse: Matrix3


def momentum_from_twist(inertia: Inertia, twist: Spatial) -> Spatial:
    """Return the body momentum mu = M chi."""
    return matrix6_transform(inertia.matrix, twist)


def twist_from_momentum(inertia: Inertia, momentum: Spatial) -> Spatial:
    """Return the body twist chi = M^-1 mu."""
    return matrix6_transform(inertia.inverse, momentum)
