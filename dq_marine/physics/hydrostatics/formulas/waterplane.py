"""Restoring force of a vessel that floats, linear in depth, roll and pitch (Fossen 2021, sec. 4.2).

Conservative and free of Euler angles. With d the direction of down in the body frame and z the depth of the body
origin below where it is at rest, zeta = (z, d_y, -d_x) is (heave, roll, pitch) to first order, and the potential is

    V = (1/2) zeta . C zeta,

whose wrench is -C zeta to first order. It knows one rest position upright and one upside down, since sin(roll) does:
it is meant for angles up to some 30 degrees. Beyond, and where a vessel leaves or enters the water, see
`physics.hydrostatics.formulas.hull`.

Published models of vessels mostly have -C zeta itself along the body's axes. That equals the above to first order, but
heave on a trimmed vessel then pushes it ahead or astern: the force has no potential.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.matrix3 import Matrix3, transform
from dq_marine.algebra.quaternion import world_down_in_body
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, cross, scale


class WaterplaneRestoring(NamedTuple):
    """What a waterplane does.

    Attributes:
        stiffness: C of heave, roll and pitch about the body origin, symmetric [N/m, N, N m].
        equilibrium_depth: z of the body origin at rest, in NED [m].
    """

    stiffness: Matrix3
    equilibrium_depth: float


def small_motions_force(term: WaterplaneRestoring, pose: DualQuaternion, down: Vector3) -> Vector3:
    """Return C zeta."""
    depth = pose_position(pose)[2] - term.equilibrium_depth
    return transform(term.stiffness, (depth, down[1], -down[0]))


def waterplane_restoring_in_body_axes(
    term: WaterplaneRestoring, pose: DualQuaternion, time: float
) -> Spatial:
    """Return the wrench -C zeta along and about the body's axes."""
    heave, roll, pitch = small_motions_force(term, pose, world_down_in_body(pose.real))
    return Spatial((-roll, -pitch, 0.0), (0.0, 0.0, -heave))


def waterplane_restoring(term: WaterplaneRestoring, pose: DualQuaternion, time: float) -> Spatial:
    """Return the wrench of V: the force -(dV/dz) d and the moment d x dV/dd."""
    down = world_down_in_body(pose.real)
    heave, roll, pitch = small_motions_force(term, pose, down)
    # d turns in the body frame as d' = d x omega, so the power of dV/dd is omega . (dV/dd x d).
    return Spatial(cross(down, (-pitch, roll, 0.0)), scale(-heave, down))
