"""Advancing a body by its actuators: commands in, the step, the actuators' state out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.selection import select
from dq_marine.algebra.spatial import ZERO, Spatial
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.forces import Forces
from dq_marine.integrator.step import ACCEPTED, Composition, StepOutcome, StepParameters, make_advance
from dq_marine.physics.actuators.formulas.force import Actuators, Transient


class Actuated(NamedTuple):
    """The outcome of an advance, and the actuators' channels at its end, nested; as they were if it was refused."""

    step: StepOutcome
    values: Any


def with_transient(actuators: Actuators, transient: Transient) -> Actuators:
    """Return the parameters of the actuators' force with another transient."""
    return Actuators(actuators.channels, actuators.effects, actuators.step, transient)


def time_actuators(parameters: StepParameters) -> Actuators:
    """Return the actuators' parameters where their force is the first that depends on time alone."""
    actuators: Actuators = parameters.forces.of_time[0]
    return actuators


def velocity_actuators(parameters: StepParameters) -> Actuators:
    """Return the actuators' parameters where their force is the first velocity force."""
    actuators: Actuators = parameters.forces.of_velocity[0]
    return actuators


def with_time_actuators(parameters: StepParameters, actuators: Actuators) -> StepParameters:
    """Return the parameters with others for the actuators: see `time_actuators`."""
    inertia, damping, forces, water, timing, contact = parameters
    driven = Forces((actuators, forces.of_time[1]), forces.of_pose, forces.of_velocity)
    return StepParameters(inertia, damping, driven, water, timing, contact)


def with_velocity_actuators(parameters: StepParameters, actuators: Actuators) -> StepParameters:
    """Return the parameters with others for the actuators: see `velocity_actuators`."""
    inertia, damping, forces, water, timing, contact = parameters
    driven = Forces(forces.of_time, forces.of_pose, (actuators, forces.of_velocity[1]))
    return StepParameters(inertia, damping, driven, water, timing, contact)


def actuators_reader(composition: Composition) -> Callable[[StepParameters], Actuators]:
    """Return (parameters) -> the actuators' parameters, for a composition that has actuators."""
    return velocity_actuators if composition.actuation.uses_velocity else time_actuators


def actuators_writer(composition: Composition) -> Callable[[StepParameters, Actuators], StepParameters]:
    """Return (parameters, actuators) -> parameters with these, for a composition that has actuators."""
    return with_velocity_actuators if composition.actuation.uses_velocity else with_time_actuators


def make_actuated_advance(
    composition: Composition,
) -> Callable[[StepParameters, BodyState, Any, Any, Spatial, float, int], Actuated]:
    """Return (parameters, state, values, commands, wrench, time, steps) -> Actuated.

    Values and commands are nested; the wrench acts besides the actuators. The composition must have actuators.
    """
    targets_of, follow = composition.actuation.targets, composition.actuation.follow
    advance = make_advance(composition)
    read, write = actuators_reader(composition), actuators_writer(composition)

    def actuated(
        parameters: StepParameters,
        state: BodyState,
        values: Any,
        commands: Any,
        wrench: Spatial,
        time: float,
        steps: int,
    ) -> Actuated:
        actuators = read(parameters)
        targets = targets_of(actuators.channels, values, commands)
        driven = write(parameters, with_transient(actuators, Transient(values, targets, time)))
        outcome = advance(driven, state, wrench, time, steps)
        after = follow(actuators.channels, values, targets, steps * actuators.step)
        return Actuated(outcome, select(outcome.status == ACCEPTED, after, values))

    return actuated


def make_actuator_wrench(composition: Composition) -> Callable[[StepParameters, Any, Spatial], Spatial]:
    """Return (parameters, values, twist relative to the water) -> what the actuators do to the body."""
    add_wrenches, read = composition.actuation.add_wrenches, actuators_reader(composition)

    def actuator_wrench(parameters: StepParameters, values: Any, twist: Spatial) -> Spatial:
        return add_wrenches(read(parameters).effects, values, twist, ZERO)

    return actuator_wrench
