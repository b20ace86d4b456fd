"""A tether: a spring to an anchor, as a force of your own."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, scale, subtract
from dq_marine.physics.term import ForceTerm


class Tether(NamedTuple):
    """Anchor in NED [m], and stiffness [N/m]."""

    anchor_ned: Vector3
    stiffness: float


def tether(own: Tether, pose: DualQuaternion, time: float) -> Spatial:
    """Return the moment and the force on the body, about its origin, in its own axes."""
    pull_ned = scale(own.stiffness, subtract(own.anchor_ned, pose_position(pose)))
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, pull_ned))


TETHER = ForceTerm("tether", tether, Tether((0.0, 0.0, 5.0), 2.0))
