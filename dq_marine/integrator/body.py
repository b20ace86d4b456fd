"""The state of one body, what an observer sees of it, and its invariants."""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_from_parts, pose_position
from dq_marine.algebra.quaternion import Quaternion, rotate
from dq_marine.algebra.spatial import ZERO, Spatial, spatial_dot
from dq_marine.algebra.vector3 import Vector3, add, cross
from dq_marine.integrator.inertia import Inertia, twist_from_momentum


class BodyState(NamedTuple):
    """The state of one body.

    Attributes:
        pose: body to NED.
        momentum: relative to the water, in the body frame.
        fluid_memory: of the water around it, see `integrator.fluid_memory`; () in a scene without.
    """

    pose: DualQuaternion
    momentum: Spatial
    fluid_memory: Any = ()


AT_REST = BodyState(pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), ZERO)
"""At the world's origin, axes aligned, at rest in the water."""


BODY_NUMBERS = 15
"""Of a body's state: time, pose, momentum; without fluid memory."""


class Motion(NamedTuple):
    """What an observer on the ground sees of a body.

    Attributes:
        position_ned: of the body origin [m].
        attitude: unit quaternion, body to NED.
        velocity: over ground, in the body frame.
    """

    position_ned: Vector3
    attitude: Quaternion
    velocity: Spatial


def kinetic_energy(inertia: Inertia, momentum: Spatial) -> float:
    """Return (1/2) mu . M^-1 mu [J], relative to the water."""
    return 0.5 * spatial_dot(momentum, twist_from_momentum(inertia, momentum))


def spatial_momentum(state: BodyState) -> Spatial:
    """Return the momentum in the world frame about the world's origin, constant in free motion.

    Linear part q mu_lin q*, angular part q mu_ang q* + l x (q mu_lin q*).
    """
    linear = rotate(state.pose.real, state.momentum.linear)
    angular = rotate(state.pose.real, state.momentum.angular)
    return Spatial(add(angular, cross(pose_position(state.pose), linear)), linear)
