"""What all baselines share: how fast momentum changes, their step size, and how a call ends.

The equations are those of docs/theory.md, "State and equations", with all forces explicit:

    mu' = ad_chi^T mu + F(pose, chi, t),     chi = M^-1 mu                                          (Ri1)

Momentum stands for velocity. M is constant, so every Runge-Kutta or Euler step on the one is that on the other, and
momentum needs one product with M^-1 a step where velocity needs products with M^-1 and M. A uniform current is exact,
as it is for the product's own steps: the position is that in the frame which drifts with the water
(`physics.current.formulas.uniform`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.spatial import Spatial, spatial_add
from dq_marine.algebra.stages import Weights, for_each
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.forces import join_time_forces
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import (
    Composition,
    Progress,
    StepOutcome,
    StepParameters,
    arrival,
    set_out,
)


class StepSize(NamedTuple):
    """All that a baseline needs to know of a step: its size [s]."""

    h: float


class Point(NamedTuple):
    """Where a body is.

    Attributes:
        attitude: quaternion, body to NED.
        position: of the body origin in the drifting frame [m].
        momentum: relative to the water, in the body frame.
    """

    attitude: Quaternion
    position: Vector3
    momentum: Spatial


class Foreseen(NamedTuple):
    """The time of a stage since the start of the call [s], and the wrench that depends on time alone."""

    elapsed: float
    wrench: Spatial


Wrench: TypeAlias = Callable[[StepParameters, Point, Spatial, float, float, Spatial], Spatial]
MomentumRate: TypeAlias = Callable[[StepParameters, Point, Spatial, float, float, Spatial], Spatial]
Land: TypeAlias = Callable[[StepParameters, BodyState, Point, float, int, int], StepOutcome]


def make_wrench(composition: Composition) -> Wrench:
    """Return (parameters, point, twist, start, elapsed, wrench) -> the sum of all forces, of the body frame.

    `start` is the time of the call [s], at which the drifting frame was that of the world, `elapsed` the time since.
    """
    forces_at, carry = composition.stage_forces, composition.water.at_stages.carry

    def total(
        parameters: StepParameters,
        point: Point,
        twist: Spatial,
        start: float,
        elapsed: float,
        wrench: Spatial,
    ) -> Spatial:
        pose = carry(parameters.water, start, elapsed, pose_from_parts(point.attitude, point.position))
        return forces_at(parameters, pose, twist, start + elapsed, wrench)

    return total


def make_momentum_rate(composition: Composition) -> MomentumRate:
    """Return (parameters, point, twist, start, elapsed, wrench) -> mu' (Ri1); arguments as in `make_wrench`."""
    total = make_wrench(composition)

    def momentum_rate(
        parameters: StepParameters,
        point: Point,
        twist: Spatial,
        start: float,
        elapsed: float,
        wrench: Spatial,
    ) -> Spatial:
        force = total(parameters, point, twist, start, elapsed, wrench)
        return spatial_add(momentum_bracket(twist, point.momentum), force)

    return momentum_rate


def without_time_forces(composition: Composition) -> Composition:
    """Return the composition less the forces that depend on time alone."""
    return replace(composition, time_forces=())


def make_foresee(
    composition: Composition,
) -> Callable[[StepParameters, float, float, Spatial, Weights], tuple[Foreseen, ...]]:
    """Return (parameters, start, elapsed, wrench, shares of the step at the stages) -> what is foreseen of each.

    Methods of several stages have the forces that depend on time alone computed for all stages side by side, as the
    product's own explicit methods have; the rest is as in `make_wrench`.
    """
    add_time_forces = join_time_forces(composition.time_forces)

    def at_stage(share: float, step: tuple[StepParameters, float, float, Spatial]) -> Foreseen:
        parameters, start, elapsed, wrench = step
        then = elapsed + share * parameters.timing.h
        return Foreseen(then, add_time_forces(parameters.forces.of_time, start + then, wrench))

    def foresee(
        parameters: StepParameters, start: float, elapsed: float, wrench: Spatial, nodes: Weights
    ) -> tuple[Foreseen, ...]:
        return for_each(nodes, at_stage, (parameters, start, elapsed, wrench))

    return foresee


def twist_at(parameters: StepParameters, point: Point) -> Spatial:
    """Return chi = M^-1 mu."""
    return twist_from_momentum(parameters.inertia, point.momentum)


def make_landing(composition: Composition) -> Land:
    """Return (parameters, state, point, start, steps, iterations) -> the outcome of a call that began at `state`.

    A baseline refuses nothing but what is not finite.
    """
    carry = composition.water.at_stages.carry

    def land(
        parameters: StepParameters, state: BodyState, point: Point, start: float, steps: int, iterations: int
    ) -> StepOutcome:
        pose = pose_from_parts(point.attitude, point.position)
        arrived = carry(parameters.water, start, steps * parameters.timing.h, pose)
        begun = set_out(state)
        progress = Progress(
            begun.under_way,
            begun.status,
            begun.completed + steps,
            iterations,
            begun.fallbacks,
            begun.residual_squared,
        )
        return arrival(state, arrived, point.momentum, state.fluid_memory, progress)

    return land
