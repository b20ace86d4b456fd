"""Steps of a body with forces by the explicit Runge-Kutta method of order 8."""

from __future__ import annotations

from collections.abc import Callable

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_from_parts, pose_position
from dq_marine.algebra.selection import by_precision, smallest_normal, some, spread
from dq_marine.algebra.spatial import Spatial, spatial_scale
from dq_marine.algebra.stages import weighted_sum
from dq_marine.algebra.vector3 import add
from dq_marine.integrator.dormand_prince import ERROR, WEIGHTS, Weighted, make_stages, rates
from dq_marine.integrator.drift_report import DriftReport, SolverReport
from dq_marine.integrator.forced_stages import ForcedStage, Place, Surroundings, follow, make_evaluate
from dq_marine.integrator.gauss_forced import Steps
from dq_marine.integrator.gauss_stages import squared_length, weighted_square
from dq_marine.integrator.increment import unit
from dq_marine.integrator.step import Composition, StepParameters

LARGEST_ERROR = 0.3
"""Of the rates of the momentum: what a step may differ by from one of order 5. For y' = z y that is exceeded beyond
z = -7 and z = 6i, and the method is stable up to -6.4 and 6i, however small y is."""

ROUND_OFF = 1e-10
"""Of the momentum: a difference below this says nothing."""

ROUND_OFF_SINGLE = 1e-4
"""`ROUND_OFF` where numbers have single precision."""


def make_find(composition: Composition) -> Callable[[Surroundings, float, Place], ForcedStage]:
    """Return (surroundings of the step's start, share of the step that is over, place) -> what is found there."""
    evaluate = make_evaluate(composition)

    def find(at_start: Surroundings, share: float, place: Place) -> ForcedStage:
        parameters, length_squared, size, h, position, wrench, began, elapsed = at_start
        later = elapsed + share * h
        around = Surroundings(parameters, length_squared, size, h, position, wrench, began, later)
        return evaluate(around, place)

    return find


def is_short_enough(length_squared: float, momentum: Spatial, found: Weighted) -> bool:
    """Whether a step from a momentum, whose stages these are, is stable."""
    k = rates(found)
    changing = weighted_square(length_squared, k[0].momentum) + weighted_square(length_squared, k[1].momentum)
    size = weighted_square(length_squared, momentum) + smallest_normal(length_squared)
    blur = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
    error = weighted_square(length_squared, weighted_sum(ERROR, k).momentum)
    return error <= LARGEST_ERROR**2 * changing + blur


def make_forced_steps(composition: Composition) -> Steps:
    """Return (parameters, time, h, steps, pose, momentum, wrench) -> (pose, momentum, report).

    Steps that are too long are not solved, by the report.
    """
    stages_of = make_stages(make_find(composition), follow)
    carry = composition.water.at_stages.carry

    def forced_steps(
        parameters: StepParameters,
        time: float,
        h: float,
        steps: int,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        like = momentum.linear[0]
        length_squared, position = squared_length(parameters.inertia), pose_position(pose)
        here = Place(spatial_scale(h, momentum), pose.real, spread((0.0, 0.0, 0.0), like))
        fine = spread(True, like)
        for step in range(steps):
            at_start = Surroundings(parameters, length_squared, like, h, position, wrench, time, step * h)
            found = stages_of(at_start, here)
            fine = fine & is_short_enough(length_squared, here.momentum, found)
            if not some(fine):
                break
            reached = follow(here, weighted_sum(WEIGHTS, rates(found)))
            here = Place(reached.momentum, unit(reached.attitude), reached.way)
        after = pose_from_parts(here.attitude, add(position, here.way))
        after = carry(parameters.water, time, steps * h, after)
        report = SolverReport(spread(0.0, like), fine, 0)
        return after, spatial_scale(1.0 / h, here.momentum), DriftReport(report, spread(True, like))

    return forced_steps
