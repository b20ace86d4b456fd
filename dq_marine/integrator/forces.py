"""Forces that act on a body, and how a kick takes them in.

A force is a plain function of its parameters and of where the body is:

    time force      (parameters, time) -> wrench
    pose force      (parameters, pose, time) -> wrench
    velocity force  (parameters, pose, twist, time) -> wrench

with the pose body to NED, the twist relative to the water in the body frame, and the wrench about the body origin in
the body frame, both as `Spatial`. Anyone can write one (see `dq_marine.physics.term.ForceTerm`); it is compiled like
the step's own functions. Forces that are not there cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.nesting import folded
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_scale
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.kick import Kick

TimeForce: TypeAlias = Callable[[Any, float], Spatial]
PoseForce: TypeAlias = Callable[[Any, DualQuaternion, float], Spatial]
VelocityForce: TypeAlias = Callable[[Any, DualQuaternion, Spatial, float], Spatial]
Potential: TypeAlias = Callable[[Any, DualQuaternion], float]
AddTimeForces: TypeAlias = Callable[[Any, float, Spatial], Spatial]
AddPoseForces: TypeAlias = Callable[[Any, DualQuaternion, float, Spatial], Spatial]
AddVelocityForces: TypeAlias = Callable[[Any, DualQuaternion, Spatial, float, Spatial], Spatial]


class Forces(NamedTuple):
    """A scene's forces by what they depend on: their functions, or their parameters.

    Parameters are nested in pairs, (first, (second, (..., ()))).

    Attributes:
        of_time: those of time alone.
        of_pose: those of pose and time.
        of_velocity: those of the velocity, too.
    """

    of_time: Any
    of_pose: Any
    of_velocity: Any


ForcedKick: TypeAlias = Callable[
    [Forces, Any, Inertia, Any, DualQuaternion, Spatial, float, Spatial], Spatial
]


def no_time_force(parameters: Any, time: float, wrench: Spatial) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def no_pose_force(parameters: Any, pose: DualQuaternion, time: float, wrench: Spatial) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def no_velocity_force(
    parameters: Any, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def join_time_forces(forces: tuple[TimeForce, ...]) -> AddTimeForces:
    """Return (parameters, time, wrench) -> wrench + the sum of all forces."""

    def link(first: TimeForce, rest: AddTimeForces) -> AddTimeForces:
        def add_time_forces(parameters: Any, time: float, wrench: Spatial) -> Spatial:
            return rest(parameters[1], time, spatial_add(wrench, first(parameters[0], time)))

        return add_time_forces

    return folded(link, forces, no_time_force)


def join_pose_forces(forces: tuple[PoseForce, ...]) -> AddPoseForces:
    """Return (parameters, pose, time, wrench) -> wrench + the sum of all forces."""

    def link(first: PoseForce, rest: AddPoseForces) -> AddPoseForces:
        def add_pose_forces(parameters: Any, pose: DualQuaternion, time: float, wrench: Spatial) -> Spatial:
            return rest(parameters[1], pose, time, spatial_add(wrench, first(parameters[0], pose, time)))

        return add_pose_forces

    return folded(link, forces, no_pose_force)


def join_posed_forces(forces: Forces) -> AddPoseForces:
    """Return (the forces' parameters, pose, time, wrench) -> wrench + all forces but those of the velocity."""
    add_time_forces, add_pose_forces = join_time_forces(forces.of_time), join_pose_forces(forces.of_pose)

    def add_posed_forces(parameters: Forces, pose: DualQuaternion, time: float, wrench: Spatial) -> Spatial:
        pushed = add_time_forces(parameters.of_time, time, wrench)
        return add_pose_forces(parameters.of_pose, pose, time, pushed)

    return add_posed_forces


def no_potential(parameters: Any, pose: DualQuaternion) -> float:
    """Return zero."""
    return 0.0


def join_potentials(potentials: tuple[Potential, ...]) -> Potential:
    """Return (parameters, pose) -> the sum of all potential energies [J]."""

    def link(first: Potential, rest: Potential) -> Potential:
        def add_potentials(parameters: Any, pose: DualQuaternion) -> float:
            return first(parameters[0], pose) + rest(parameters[1], pose)

        return add_potentials

    return folded(link, potentials, no_potential)


def join_velocity_forces(forces: tuple[VelocityForce, ...]) -> AddVelocityForces:
    """Return (parameters, pose, twist, time, wrench) -> wrench + the sum of all forces."""

    def link(first: VelocityForce, rest: AddVelocityForces) -> AddVelocityForces:
        def add_velocity_forces(
            parameters: Any, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
        ) -> Spatial:
            added = spatial_add(wrench, first(parameters[0], pose, twist, time))
            return rest(parameters[1], pose, twist, time, added)

        return add_velocity_forces

    return folded(link, forces, no_velocity_force)


def make_forced_kick(kick: Kick, forces: Forces) -> ForcedKick:
    """Return (forces' parameters, damping, inertia, kick's parameters, pose, momentum, time, wrench) -> momentum.

    Velocity forces are explicit: taken at the start for a first kick, then at the mean of start and its end, which
    makes the kick of second order.
    """
    add_posed_forces = join_posed_forces(forces)

    def posed_kick(
        numbers: Forces,
        damping: Any,
        inertia: Inertia,
        parameters: Any,
        pose: DualQuaternion,
        momentum: Spatial,
        time: float,
        wrench: Spatial,
    ) -> Spatial:
        return kick(parameters, damping, inertia, momentum, add_posed_forces(numbers, pose, time, wrench))

    if not forces.of_velocity:
        return posed_kick
    add_velocity_forces = join_velocity_forces(forces.of_velocity)

    def moving_kick(
        numbers: Forces,
        damping: Any,
        inertia: Inertia,
        parameters: Any,
        pose: DualQuaternion,
        momentum: Spatial,
        time: float,
        wrench: Spatial,
    ) -> Spatial:
        posed = add_posed_forces(numbers, pose, time, wrench)
        twist = twist_from_momentum(inertia, momentum)
        acting = add_velocity_forces(numbers.of_velocity, pose, twist, time, posed)
        first = kick(parameters, damping, inertia, momentum, acting)
        middle = twist_from_momentum(inertia, spatial_scale(0.5, spatial_add(momentum, first)))
        acting = add_velocity_forces(numbers.of_velocity, pose, middle, time, posed)
        return kick(parameters, damping, inertia, momentum, acting)

    return moving_kick
