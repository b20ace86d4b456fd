"""Forces that act on a body, and how a kick takes them in.

A force is a plain function of its parameters and of where the body is:

    pose force      (parameters, pose, time) -> wrench
    velocity force  (parameters, pose, twist, time) -> wrench

with the pose body to NED, the twist relative to the water in the body frame, and the wrench about the body origin in
the body frame, both as `Spatial`. Anyone can write one (see `dq_marine.physics.term.ForceTerm`); it is compiled like
the step's own functions. Forces that are not there cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.nesting import folded
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_scale
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.kick import Kick

PoseForce: TypeAlias = Callable[[Any, DualQuaternion, float], Spatial]
VelocityForce: TypeAlias = Callable[[Any, DualQuaternion, Spatial, float], Spatial]
Potential: TypeAlias = Callable[[Any, DualQuaternion], float]
AddPoseForces: TypeAlias = Callable[[Any, DualQuaternion, float, Spatial], Spatial]
AddVelocityForces: TypeAlias = Callable[[Any, DualQuaternion, Spatial, float, Spatial], Spatial]
ForcedKick: TypeAlias = Callable[[Any, Any, Inertia, Any, DualQuaternion, Spatial, float, Spatial], Spatial]


def no_pose_force(parameters: Any, pose: DualQuaternion, time: float, wrench: Spatial) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def no_velocity_force(
    parameters: Any, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def join_pose_forces(forces: tuple[PoseForce, ...]) -> AddPoseForces:
    """Return (parameters, pose, time, wrench) -> wrench + the sum of all forces."""

    def link(first: PoseForce, rest: AddPoseForces) -> AddPoseForces:
        def add_pose_forces(parameters: Any, pose: DualQuaternion, time: float, wrench: Spatial) -> Spatial:
            return rest(parameters[1], pose, time, spatial_add(wrench, first(parameters[0], pose, time)))

        return add_pose_forces

    return folded(link, forces, no_pose_force)


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


def make_forced_kick(
    kick: Kick, pose_forces: tuple[PoseForce, ...], velocity_forces: tuple[VelocityForce, ...]
) -> ForcedKick:
    """Return (forces' parameters, damping, inertia, kick's parameters, pose, momentum, time, wrench) -> momentum.

    The forces' parameters are the pair (of the pose forces, of the velocity forces). Velocity forces are explicit:
    taken at the start for a first kick, then at the mean of start and its end, which makes the kick of second order.
    """
    add_pose_forces = join_pose_forces(pose_forces)

    def posed_kick(
        forces: Any,
        damping: Any,
        inertia: Inertia,
        parameters: Any,
        pose: DualQuaternion,
        momentum: Spatial,
        time: float,
        wrench: Spatial,
    ) -> Spatial:
        return kick(parameters, damping, inertia, momentum, add_pose_forces(forces[0], pose, time, wrench))

    if not velocity_forces:
        return posed_kick
    add_velocity_forces = join_velocity_forces(velocity_forces)

    def moving_kick(
        forces: Any,
        damping: Any,
        inertia: Inertia,
        parameters: Any,
        pose: DualQuaternion,
        momentum: Spatial,
        time: float,
        wrench: Spatial,
    ) -> Spatial:
        posed = add_pose_forces(forces[0], pose, time, wrench)
        twist = twist_from_momentum(inertia, momentum)
        first = kick(
            parameters, damping, inertia, momentum, add_velocity_forces(forces[1], pose, twist, time, posed)
        )
        middle = twist_from_momentum(inertia, spatial_scale(0.5, spatial_add(momentum, first)))
        return kick(
            parameters, damping, inertia, momentum, add_velocity_forces(forces[1], pose, middle, time, posed)
        )

    return moving_kick
