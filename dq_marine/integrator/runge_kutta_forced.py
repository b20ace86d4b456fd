"""Steps of a body with forces by explicit Runge-Kutta methods."""

from __future__ import annotations

from collections.abc import Callable

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_from_parts, pose_position
from dq_marine.algebra.selection import by_precision, smallest_normal, some, spread
from dq_marine.algebra.spatial import Spatial, spatial_scale
from dq_marine.algebra.vector3 import add
from dq_marine.integrator.drift_report import DriftReport, SolverReport
from dq_marine.integrator.explicit import Explicit
from dq_marine.integrator.forced_stages import Place, Surroundings, follow, make_evaluate
from dq_marine.integrator.gauss_forced import Steps
from dq_marine.integrator.gauss_stages import squared_length, weighted_square
from dq_marine.integrator.increment import unit
from dq_marine.integrator.step import Composition, StepParameters

ROUND_OFF = 1e-10
"""Of the momentum: a change below this says nothing of a step's length."""

ROUND_OFF_SINGLE = 1e-4
"""`ROUND_OFF` where numbers have single precision."""


def make_find(composition: Composition) -> Callable[[Surroundings, float, Place], Place]:
    """Return (surroundings of the step's start, share of the step that is over, place) -> the rates there."""
    evaluate = make_evaluate(composition)

    def find(at_start: Surroundings, share: float, place: Place) -> Place:
        parameters, length_squared, size, h, position, wrench, began, elapsed = at_start
        later = elapsed + share * h
        around = Surroundings(parameters, length_squared, size, h, position, wrench, began, later)
        return evaluate(around, place).rate

    return find


def momentum_extent(length_squared: float, change: Place) -> float:
    """Return the square of the size of a change of momentum."""
    return weighted_square(length_squared, change.momentum)


def make_forced_steps(composition: Composition, method: Explicit) -> Steps:
    """Return (parameters, time, h, steps, pose, momentum, wrench) -> (pose, momentum, report).

    Steps that are too long are not solved, by the report.
    """
    take_step, is_stable = (
        method.make_step(make_find(composition), follow),
        method.make_is_stable(momentum_extent),
    )
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
            change, rates = take_step(at_start, here)
            size = weighted_square(length_squared, here.momentum) + smallest_normal(like)
            blur = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
            fine = fine & is_stable(length_squared, rates, blur)
            if not some(fine):
                break
            reached = follow(here, change)
            here = Place(reached.momentum, unit(reached.attitude), reached.way)
        after = pose_from_parts(here.attitude, add(position, here.way))
        after = carry(parameters.water, time, steps * h, after)
        report = SolverReport(spread(0.0, like), fine, 0)
        return after, spatial_scale(1.0 / h, here.momentum), DriftReport(report, spread(True, like))

    return forced_steps
