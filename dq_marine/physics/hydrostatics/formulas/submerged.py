"""Weight and buoyancy of a submerged body (Fossen 2021, Handbook of Marine Craft, sec. 4.1).

Both are constant world vectors, so the wrench depends on the attitude alone, through the direction "down" in
the body frame. Force and moment are separate terms: a neutrally buoyant scene has no force, one with
coincident centres has no moment, and neither computes what it does not have.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.quaternion import world_down_in_body
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, cross, dot, scale


class NetWeight(NamedTuple):
    """Weight minus buoyancy, W - B [N], positive for a body that sinks."""

    force: float


class RightingMoment(NamedTuple):
    """First moment of weight and buoyancy about the body origin, W r_G - B r_B [N m], body frame."""

    arm: Vector3


def net_weight(term: NetWeight, pose: DualQuaternion, time: float) -> Spatial:
    """Return the wrench (W - B) d, d the body-frame direction of down, acting at the body origin."""
    return Spatial((0.0, 0.0, 0.0), scale(term.force, world_down_in_body(pose.real)))


def righting_moment(term: RightingMoment, pose: DualQuaternion, time: float) -> Spatial:
    """Return the moment (W r_G - B r_B) x d, d the body-frame direction of down."""
    return Spatial(cross(term.arm, world_down_in_body(pose.real)), (0.0, 0.0, 0.0))


def net_weight_potential(term: NetWeight, pose: DualQuaternion) -> float:
    """Return -(W - B) z [J], z the depth of the body origin."""
    return -term.force * pose_position(pose)[2]


def righting_potential(term: RightingMoment, pose: DualQuaternion) -> float:
    """Return -(W r_G - B r_B) . d [J]."""
    return -dot(term.arm, world_down_in_body(pose.real))
