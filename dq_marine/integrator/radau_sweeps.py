"""The stages of a step with damping: sweeps that become Newton's method where damping makes them slow.

A sweep takes the rates K at the stages to the momentum y at the stages. What is left over of (RI1) is

    r_i = c + sum_j A_ij K_j + C_i - y_i                                                             (RI2)

Where damping is weak it changes y as it is, y_i <- y_i + r_i; where it is not, by an iteration of Newton's method
(`integrator.stage_newton`), whose matrix is made where sweeps contract slowly, and anew where they go on to do so.
Attitudes and ways follow from the rates. See docs/theory.md, "Radau's collocation, for damping".
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeAlias

from dq_marine.algebra.selection import by_precision, negation, select, some, spread
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_subtract
from dq_marine.algebra.stages import each_stage, stage_product, stage_sum
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.corner import Corners, coefficients, make_no_corners
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.drift_report import SolverReport
from dq_marine.integrator.forced_stages import ForcedStage, Place, Surroundings, follow
from dq_marine.integrator.gauss_stages import weighted_square
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.stage_newton import make_stage_newton
from dq_marine.integrator.sweeps import ROUND_OFF, ROUND_OFF_SINGLE, Ending, kept, same, tolerated

MAX_SWEEPS = 40
TELLING = 4  # the sweep whose rates tell how exact the method is; tests begin there, once corners are in
SLOW = 0.4  # of the squared change, from one sweep to the next: sweeps that shrink it less want a new matrix
SLOWEST = 0.5  # the same: sweeps that shrink it less are not done
HOPELESS = 1e12  # of the size, squared: sweeps that change more diverge
CORNER_PERIOD = 3  # sweeps from one look at corners to the next: they settle sooner than the rest
CORNER_SWEEPS = 16  # that follow corners: where zeros come and go for longer, sweeps go on without

ENDING = Ending(0.0003, 0.05, 0.01, 0.06)
"""Of sweeps, by the highest power in the polynomial through the rates."""

STIFF_ENDING = Ending(0.0003, 0.0, 0.0003, 0.06)
"""Of those of Newton's method: where damping is stiff, that power tells little of how much long steps err."""

Solve: TypeAlias = Callable[
    [Surroundings, Any, Place, ForcedStage, float],
    tuple[Place, SolverReport],
]


def left_over(reached: Spatial, corner: Spatial, momentum: Spatial) -> Spatial:
    """Return (RI2)."""
    return spatial_subtract(spatial_add(reached, corner), momentum)


def make_solve(
    method: Collocation, evaluate: Callable[..., ForcedStage], algebra: DampingAlgebra, corners: Corners
) -> Solve:
    """Return (surroundings, damping, start, evaluation at the stages, size) -> (places at the stages, report).

    A body that is done waits, unchanged, for those beside it. The report's `on_rest_branch` says whether the sweeps
    converged.

    Args:
        method: Radau's, with four stages.
        evaluate: (surroundings, place) -> all rates, those of damping among them.
        algebra: of the damping matrix.
        corners: the correction (RI5).
    """
    matrix, weights = method.matrix, method.weights
    highest, ones = coefficients(method)[-1], (1.0,) * len(method.weights)
    newton, no_corners = make_stage_newton(method, algebra), make_no_corners(method)
    is_stiff, inverses, newton_change = newton.wanted, newton.inverses, newton.change
    corners_of = algebra.corners

    def telltale(length_squared: float, rates: Spatial) -> float:
        """Return the square of what tells how much the method errs."""
        return weighted_square(length_squared, stage_sum(highest, rates))

    def solve(
        around: Surroundings, damping: Any, start: Place, begun: ForcedStage, size: float
    ) -> tuple[Place, SolverReport]:
        inertia, length_squared = around.parameters.inertia, around.length_squared
        at_start, c = twist_from_momentum(inertia, start.momentum), corners_of(damping)
        active = spread(True, size)
        implicit = renewed = active & is_stiff(around, damping, at_start)
        inverse = each_stage(weights, kept, (active, inertia.inverse, inertia.inverse))
        corner = no_corners(c, at_start, begun.twist)
        y, now = each_stage(weights, same, (start,)), begun
        tolerance = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
        converged = negation(active)
        before = last = spread(math.inf, size)
        count = 0
        for sweep in range(1, MAX_SWEEPS + 1):
            reached = each_stage(weights, follow, (start, stage_product(matrix, now.rate)))
            change = each_stage(weights, left_over, (reached.momentum, corner, y.momentum))
            if some(renewed):
                fresh = inverses(around, damping, now.twist, y.momentum)
                inverse = each_stage(weights, kept, (renewed, fresh, inverse))
            if some(implicit):
                solved = newton_change(inertia, inverse, change)
                change = each_stage(weights, kept, (implicit, solved, change))
            moved = Place(
                each_stage(weights, spatial_add, (y.momentum, change)), reached.attitude, reached.way
            )
            square = stage_sum(ones, each_stage(weights, weighted_square, (length_squared, change)))
            before, last = select(active, last, before), select(active, square, last)
            y = each_stage(weights, kept, (active, moved, y))
            count += 1
            if sweep == TELLING:
                told = telltale(length_squared, now.rate.momentum)
                plain, stiff = tolerated(ENDING, told, size), tolerated(STIFF_ENDING, told, size)
                tolerance = max(tolerance, select(implicit, stiff, plain))
            if sweep >= TELLING:
                contracts = last < SLOWEST * before
                done = (contracts & (last * last <= tolerance * before)) | (last <= tolerance)
                converged = converged | (active & done)
            active = active & negation(converged) & (last <= HOPELESS * size)
            if not some(active):
                break
            renewed = active & (last > SLOW * before)  # after the first sweep `before` is infinite
            implicit = implicit | renewed
            now = each_stage(weights, evaluate, (around, y))
            if sweep % CORNER_PERIOD == 0:
                corner = corners(c, at_start, now.twist)
            if sweep > CORNER_SWEEPS:
                corner = no_corners(c, at_start, now.twist)
        return y, SolverReport(last / size, converged, count)

    return solve
