"""The stages of a step with damping: sweeps that become Newton's method where damping makes them slow.

A sweep takes the rates K at the stages to the momentum y at the stages. Where damping is weak it does so as it is,
y_i <- c + sum_j A_ij K_j + C_i; where it is not, by one iteration of Newton's method, with the slope S of damping and
that of Kirchhoff's equations, G, both from the mean over the stages (docs/theory.md, eqs. RI1-RI4):

    r_i = c + sum_j A_ij K_j + C_i - y_i                                                             (RI2)
    (M + h d_i (S - G)) e_i = (Q^-1 r)_i                                                             (RI3)
    y_i <- y_i + M (Q e)_i                                                                           (RI4)

with L = Q diag(d) Q^-1 in place of A (see `integrator.splitting`). The matrix is made where sweeps contract slowly,
and made anew where they go on to do so.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.frames import momentum_bracket_slope
from dq_marine.algebra.selection import by_precision, negation, select, some, spread
from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_add_scaled,
    matrix6_invert,
    matrix6_transform,
    spatial_add,
    spatial_scale,
    spatial_subtract,
)
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.corner import Corners, coefficients, make_no_corners
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.drift_report import SolverReport
from dq_marine.integrator.forced_stages import (
    ForcedStage,
    Place,
    Surroundings,
    follow,
    multiplied,
)
from dq_marine.integrator.gauss_stages import weighted_square
from dq_marine.integrator.inertia import momentum_from_twist, twist_from_momentum
from dq_marine.integrator.splitting import splitting
from dq_marine.integrator.sweeps import ROUND_OFF, ROUND_OFF_SINGLE

MAX_SWEEPS = 40
TELLING = 3  # the sweep after which the stages tell how exact the method is; tests begin there
LARGEST_TELLTALE = 0.006  # of the size, squared
OF_THE_ERROR = 0.01  # of the square of the highest power in the rates' polynomial
SLOW = 0.25  # of the squared change, from one sweep to the next: sweeps that shrink it less want a new matrix
SLOWEST = 0.5  # the same: sweeps that shrink it less are not done
HOPELESS = 1e12  # of the size, squared: sweeps that change more diverge
STIFF = 5.0  # h times damping, over inertia, from which the first sweep has a matrix
CORNER_SWEEPS = 16  # that follow the corners; sweeps that have not converged by then go on without

Solve: TypeAlias = Callable[[Surroundings, Spatial, Place, ForcedStage, float], tuple[Place, SolverReport]]


class Swept(NamedTuple):
    """Stages while they are solved: places, C (RI5), and the inverse matrices of (RI3)."""

    place: Place
    corner: Spatial
    inverse: Matrix6


def same(place: Place) -> Place:
    """Return the place: at all stages, where `each_stage` has it."""
    return place


def kept(active: bool, new: Any, old: Any) -> Any:
    """Return what is new where it is wanted."""
    return select(active, new, old)


def residual(reached: Spatial, corner: Spatial, momentum: Spatial) -> Spatial:
    """Return (RI2)."""
    return spatial_subtract(spatial_add(reached, corner), momentum)


def is_stiff(h: float, inertia: Matrix6, diagonal: Spatial) -> bool:
    """Whether h times damping, of which this is the diagonal, is as large as inertia on any axis."""
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


def make_solve(
    method: Collocation, evaluate: Callable[..., ForcedStage], algebra: DampingAlgebra, corners: Corners
) -> Solve:
    """Return (surroundings, damping, start, evaluation at the stages, size) -> (places at the stages, report).

    Args:
        method: Radau's, with four stages.
        evaluate: (surroundings, place) -> all rates, those of damping among them.
        algebra: of the damping matrix.
        corners: the correction (RI5).
    """
    matrix, weights = method.matrix, method.weights
    split = splitting(method)
    together, apart, diagonal = split.together, split.apart, split.diagonal
    highest = coefficients(method)[-1]
    ones, mean = (1.0,) * len(weights), (1.0 / len(weights),) * len(weights)
    no_corners = make_no_corners(method)
    slope_of, add_slope = algebra.slope, algebra.add_scaled
    diagonal_of, corners_of = algebra.diagonal, algebra.corners

    def newton_inverse(inertia: Matrix6, gyration: Matrix6, slope: Any, h: float) -> Matrix6:
        return matrix6_invert(add_slope(matrix6_add_scaled(inertia, -h, gyration), h, slope))

    def inverses(around: Surroundings, damping: Any, places: Place, twists: Spatial) -> Matrix6:
        """Return the inverses of the matrices in (RI3)."""
        h, inertia = around.h, around.parameters.inertia.matrix
        own = each_stage(weights, spatial_scale, (1.0 / h, twists))
        slope = stage_sum(mean, each_stage(weights, slope_of, (damping, own)))
        gyration = momentum_bracket_slope(
            inertia, stage_sum(mean, own), spatial_scale(1.0 / h, stage_sum(mean, places.momentum))
        )
        steps = each_stage(weights, multiplied, (h, stage_constants(diagonal, around.size)))
        return each_stage(weights, newton_inverse, (inertia, gyration, slope, steps))

    def solve(
        around: Surroundings, damping: Any, start: Place, begun: ForcedStage, size: float
    ) -> tuple[Place, SolverReport]:
        inertia, h = around.parameters.inertia, around.h
        like = size
        at_start = twist_from_momentum(inertia, start.momentum)
        coefficient = corners_of(damping)
        slope = slope_of(damping, spatial_scale(1.0 / h, at_start))
        implicit = is_stiff(h, inertia.matrix, diagonal_of(slope)) & spread(True, like)
        renewed = implicit
        y = each_stage(weights, same, (start,))
        now = begun
        corner = no_corners(coefficient, at_start, begun.twist)
        inverse = each_stage(weights, kept, (implicit, inertia.inverse, inertia.inverse))
        tolerance = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
        active = spread(True, like)
        converged = negation(active)
        before = last = spread(math.inf, like)
        count = 0
        for sweep in range(1, MAX_SWEEPS + 1):
            reached = each_stage(weights, follow, (start, stage_product(matrix, now.rate)))
            step = each_stage(weights, residual, (reached.momentum, corner, y.momentum))  # (RI2)
            if some(renewed):
                fresh = inverses(around, damping, y, now.twist)
                inverse = each_stage(weights, kept, (renewed, fresh, inverse))
            if some(implicit):
                parted = each_stage(
                    weights, matrix6_transform, (inverse, stage_product(apart, step))
                )  # (RI3)
                change = each_stage(weights, momentum_from_twist, (inertia, stage_product(together, parted)))
                step = each_stage(weights, kept, (implicit, change, step))
            moved = Place(each_stage(weights, spatial_add, (y.momentum, step)), reached.attitude, reached.way)
            new = stage_sum(ones, each_stage(weights, weighted_square, (around.length_squared, step)))
            before, last = select(active, last, before), select(active, new, last)
            y = each_stage(weights, kept, (active, moved, y))
            count += 1
            if sweep == TELLING:
                top = weighted_square(around.length_squared, stage_sum(highest, now.rate.momentum))
                top = min(top, LARGEST_TELLTALE * size)
                tolerance = max(tolerance, OF_THE_ERROR**2 * (top * top / size))
            if sweep >= TELLING:
                contracts = last < SLOWEST * before
                done = (contracts & (last * last <= tolerance * before)) | (last <= tolerance)
                converged = converged | (active & done)
            active = active & negation(converged) & (last <= HOPELESS * size)
            if not some(active):
                break
            if sweep >= 2:
                renewed = active & (last > SLOW * before)
                implicit = implicit | renewed
            else:
                renewed = negation(spread(True, like))
            now = each_stage(weights, evaluate, (around, y))
            if sweep % 2 == 0:
                corner = corners(coefficient, at_start, now.twist)
            if sweep > CORNER_SWEEPS:
                corner = no_corners(coefficient, at_start, now.twist)
        return y, SolverReport(last / size, converged, count)

    return solve
