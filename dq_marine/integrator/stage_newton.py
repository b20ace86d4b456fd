"""Newton's method for the stages of a step with damping: its matrices, and what an iteration changes.

With S the slope of damping and G that of Kirchhoff's equations, both from the mean over the stages, and the lower
triangle L = Q diag(d) Q^-1 in place of A (see `integrator.splitting`), what is left over, r, changes the momentum y at
the stages by (docs/theory.md, eqs. RI3 and RI4)

    (M + h d_i (S - G)) e_i = (Q^-1 r)_i                                                             (RI3)
    y_i <- y_i + M (Q e)_i                                                                           (RI4)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.frames import momentum_bracket_slope
from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_add_scaled,
    matrix6_invert,
    matrix6_transform,
    spatial_scale,
)
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.forced_stages import Surroundings, multiplied
from dq_marine.integrator.inertia import Inertia, momentum_from_twist
from dq_marine.integrator.splitting import splitting

STIFF = 3.0  # h times the slope of damping, over inertia, from which the first sweep has a matrix


class StageNewton(NamedTuple):
    """What sweeps need of Newton's method.

    Attributes:
        wanted: (surroundings, damping, twist at the start) -> whether damping is stiff there.
        inverses: (surroundings, damping, twists and momenta at the stages) -> the inverses of the matrices in (RI3).
        change: (inertia, inverses, r) -> the change of momentum (RI4).
    """

    wanted: Callable[[Surroundings, Any, Spatial], bool]
    inverses: Callable[[Surroundings, Any, Spatial, Spatial], Matrix6]
    change: Callable[[Inertia, Matrix6, Spatial], Spatial]


def is_stiff(h: float, inertia: Matrix6, diagonal: Spatial) -> bool:
    """Whether h times the slope of damping, of which this is the diagonal, exceeds inertia on any axis."""
    m, n = inertia.angular, inertia.linear
    a, b = diagonal
    return (
        (h * a[0] > STIFF * m[0])
        | (h * a[1] > STIFF * m[4])
        | (h * a[2] > STIFF * m[8])
        | (h * b[0] > STIFF * n[0])
        | (h * b[1] > STIFF * n[4])
        | (h * b[2] > STIFF * n[8])
    )


def make_stage_newton(method: Collocation, algebra: DampingAlgebra) -> StageNewton:
    """Return Newton's method for one kind of damping matrix; twists and momenta are scaled by h."""
    weights = method.weights
    mean = (1.0 / len(weights),) * len(weights)
    diagonal, together, apart = splitting(method)
    slope_of, add_slope, diagonal_of = algebra.slope, algebra.add_slope, algebra.slope_diagonal

    def wanted(around: Surroundings, damping: Any, twist: Spatial) -> bool:
        h = around.h
        slope = slope_of(damping, spatial_scale(1.0 / h, twist))
        return is_stiff(h, around.parameters.inertia.matrix, diagonal_of(slope))

    def inverse(inertia: Matrix6, gyration: Matrix6, slope: Any, h: float) -> Matrix6:
        return matrix6_invert(add_slope(matrix6_add_scaled(inertia, -h, gyration), h, slope))

    def inverses(around: Surroundings, damping: Any, twists: Spatial, momenta: Spatial) -> Matrix6:
        h, inertia = around.h, around.parameters.inertia.matrix
        own = each_stage(weights, spatial_scale, (1.0 / h, twists))
        slope = stage_sum(mean, each_stage(weights, slope_of, (damping, own)))
        momentum = spatial_scale(1.0 / h, stage_sum(mean, momenta))
        gyration = momentum_bracket_slope(inertia, stage_sum(mean, own), momentum)
        steps = each_stage(weights, multiplied, (h, stage_constants(diagonal, around.size)))
        found: Matrix6 = each_stage(weights, inverse, (inertia, gyration, slope, steps))
        return found

    def change(inertia: Inertia, inverse: Matrix6, left_over: Spatial) -> Spatial:
        parted = each_stage(weights, matrix6_transform, (inverse, stage_product(apart, left_over)))  # (RI3)
        changed: Spatial = each_stage(
            weights, momentum_from_twist, (inertia, stage_product(together, parted))
        )  # (RI4)
        return changed

    return StageNewton(wanted, inverses, change)
