"""The wrench on the body that comes from an actuator's channels, about the body origin in the body frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.selection import select
from dq_marine.algebra.spatial import Spatial, spatial_dot, spatial_scale, wrench_at
from dq_marine.algebra.vector3 import Vector3


class EffectKind(NamedTuple):
    """What a kind of actuator does.

    Attributes:
        wrench: (parameters, values, twist) -> wrench; `values` are those of its channels and of all that follow,
            nested in pairs, the twist is relative to the water.
        channels: how many of the values are its own: 1 or 2.
        uses_velocity: whether the wrench depends on the twist.
    """

    wrench: Callable[[Any, Any, Spatial], Spatial]
    channels: int
    uses_velocity: bool


class Propeller(NamedTuple):
    """A propeller's thrust over its shaft speed squared [N s^2], ahead and astern."""

    forward: float
    reverse: float


class FixedThruster(NamedTuple):
    """A propeller whose axis is fixed, and the wrench of a thrust of 1 N."""

    propeller: Propeller
    wrench: Spatial


class ThrusterInFlow(NamedTuple):
    """A fixed thruster whose thrust falls with the water's speed through it.

    Attributes:
        propeller: at zero speed of advance.
        wrench: of a thrust of 1 N.
        inflow: thrust lost over shaft speed and speed of advance [N s^2/m].
        advance: what the twist is paired with to give the speed of advance: moment and direction of the axis.
    """

    propeller: Propeller
    wrench: Spatial
    inflow: float
    advance: Spatial


class AzimuthThruster(NamedTuple):
    """A propeller at a position [m], whose axis turns in the body's xy-plane."""

    propeller: Propeller
    position: Vector3


class Fin(NamedTuple):
    """The wrench of a fin per radian of deflection and per square of the surge velocity."""

    wrench: Spatial


def thrust_of(propeller: Propeller, speed: float) -> float:
    """Return k n |n|, the thrust at zero speed of advance [N]."""
    return select(speed < 0.0, propeller.reverse, propeller.forward) * speed * abs(speed)


def fixed_thruster_wrench(thruster: FixedThruster, values: Any, twist: Spatial) -> Spatial:
    """Return the wrench at a shaft speed n = values[0]."""
    return spatial_scale(thrust_of(thruster.propeller, values[0]), thruster.wrench)


def thruster_in_flow_wrench(thruster: ThrusterInFlow, values: Any, twist: Spatial) -> Spatial:
    """Return the wrench at a shaft speed n = values[0] and a speed of advance u_a: k n |n| - k_u |n| u_a.

    This is the bilinear thruster model (Fossen 2021, ch. 9, after Blanke).
    """
    speed = values[0]
    lost = thruster.inflow * abs(speed) * spatial_dot(thruster.advance, twist)
    return spatial_scale(thrust_of(thruster.propeller, speed) - lost, thruster.wrench)


def azimuth_thruster_wrench(thruster: AzimuthThruster, values: Any, twist: Spatial) -> Spatial:
    """Return the wrench at a shaft speed values[0] and an angle values[1][0] from forward towards starboard [rad]."""
    thrust, angle = thrust_of(thruster.propeller, values[0]), values[1][0]
    sine, cosine = sine_and_cosine(angle)
    force = (thrust * cosine, thrust * sine, 0.0)
    return wrench_at(thruster.position, force)


def fin_wrench(fin: Fin, values: Any, twist: Spatial) -> Spatial:
    """Return the wrench at a deflection values[0] [rad] and a surge velocity u: u |u| times it."""
    u = twist.linear[0]
    return spatial_scale(u * abs(u) * values[0], fin.wrench)


FIXED_THRUSTER = EffectKind(fixed_thruster_wrench, channels=1, uses_velocity=False)
THRUSTER_IN_FLOW = EffectKind(thruster_in_flow_wrench, channels=1, uses_velocity=True)
AZIMUTH_THRUSTER = EffectKind(azimuth_thruster_wrench, channels=2, uses_velocity=False)
FIN = EffectKind(fin_wrench, channels=1, uses_velocity=True)
