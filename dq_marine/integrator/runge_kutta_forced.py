"""Steps of a body with forces by explicit Runge-Kutta methods."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_from_parts, pose_position
from dq_marine.algebra.selection import by_precision, smallest_normal, spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.stages import Weights, for_each
from dq_marine.algebra.vector3 import Vector3, add
from dq_marine.integrator.drift_report import DriftReport, SolverReport
from dq_marine.integrator.explicit import Explicit, Foresee
from dq_marine.integrator.forced_stages import Place, Surroundings, make_evaluate
from dq_marine.integrator.forces import join_time_forces
from dq_marine.integrator.gauss_forced import Steps
from dq_marine.integrator.gauss_stages import squared_length, weighted_square
from dq_marine.integrator.increment import unit
from dq_marine.integrator.step import Composition, StepParameters

ROUND_OFF = 1e-10
"""Of the momentum: a change in a step that is below this says nothing of the step's length."""

ROUND_OFF_SINGLE = 1e-4
"""`ROUND_OFF` where numbers have single precision."""


class Departure(NamedTuple):
    """What the rates in a step depend on besides where the body is: see `forced_stages.Surroundings`.

    `elapsed` is the time since the start of the call, `began` [s].
    """

    parameters: StepParameters
    length_squared: float
    h: float
    position: Vector3
    wrench: Spatial
    began: float
    elapsed: float


class Foreseen(NamedTuple):
    """The time of a stage since the start of the call [s], and the wrench that depends on time alone."""

    elapsed: float
    wrench: Spatial


def make_foresee(composition: Composition) -> Foresee:
    """Return (departure, shares of the step that are over at the stages) -> what is foreseen of each."""
    add_time_forces = join_time_forces(composition.time_forces)

    def at_stage(share: float, departure: Departure) -> Foreseen:
        elapsed = departure.elapsed + share * departure.h
        numbers, time = departure.parameters.forces.of_time, departure.began + elapsed
        return Foreseen(elapsed, add_time_forces(numbers, time, departure.wrench))

    def foresee(departure: Departure, nodes: Weights) -> tuple[Foreseen, ...]:
        return for_each(nodes, at_stage, departure)

    return foresee


def make_find(composition: Composition) -> Callable[[Departure, Foreseen, Place], Place]:
    """Return (departure, what is foreseen of the stage, place) -> the rates there, a second."""
    evaluate = make_evaluate(replace(composition, time_forces=()))

    def find(departure: Departure, foreseen: Foreseen, place: Place) -> Place:
        parameters, length_squared, _, position, _, began, _ = departure
        # In steps that last 1 s momenta are those of the body, and their rates are a second's.
        around = Surroundings(
            parameters,
            length_squared,
            length_squared,
            1.0,
            position,
            foreseen.wrench,
            began,
            foreseen.elapsed,
        )
        return evaluate(around, place).rate

    return find


def momentum_extent(length_squared: float, rate: Place) -> float:
    """Return the square of the size of the momentum's rate."""
    return weighted_square(length_squared, rate.momentum)


def make_forced_steps(composition: Composition, method: Explicit) -> Steps:
    """Return (parameters, time, h, steps, pose, momentum, wrench) -> (pose, momentum, report).

    Steps that are too long are not solved, by the report.
    """
    take_step, is_stable = (
        method.make_step(make_foresee(composition), make_find(composition)),
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
        here = Place(momentum, pose.real, spread((0.0, 0.0, 0.0), like))
        fine, per_square = spread(True, like), 1.0 / (h * h)

        for step in range(steps):
            departure = Departure(parameters, length_squared, h, position, wrench, time, step * h)
            reached, rates = take_step(departure, h, here)
            size = (weighted_square(length_squared, here.momentum) + smallest_normal(like)) * per_square
            blur = by_precision(size, ROUND_OFF**2, ROUND_OFF_SINGLE**2) * size
            fine = fine & is_stable(length_squared, rates, blur)
            here = Place(reached.momentum, unit(reached.attitude), reached.way)
        after = pose_from_parts(here.attitude, add(position, here.way))
        after = carry(parameters.water, time, steps * h, after)
        report = SolverReport(spread(0.0, like), fine, 0)
        return after, here.momentum, DriftReport(report, spread(True, like))

    return forced_steps
