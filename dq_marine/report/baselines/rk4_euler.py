"""The classical Runge-Kutta method of order 4 on position, Euler angles and momentum: the textbook's form.

With roll phi, pitch theta and heading psi (zyx; Fossen 2021, ch. 2)

    phi' = p + tan(theta) (q sin(phi) + r cos(phi)),  theta' = q cos(phi) - r sin(phi),
    psi' = (q sin(phi) + r cos(phi))/cos(theta),      l' = R v,     mu' by (Ri1)

which is singular at a pitch of 90 degrees: near it the angles' rates grow without bound, and what follows is wrong, or
not finite. A step takes the sines and cosines of four times three half angles.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.quaternion import Quaternion, rotate
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled, spatial_scale
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, scale
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.classical_runge_kutta import NODES
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.dynamics import (
    Foreseen,
    Point,
    make_foresee,
    make_landing,
    make_momentum_rate,
    twist_at,
    without_time_forces,
)


class Posture(NamedTuple):
    """Roll, pitch and heading [rad], position in the drifting frame [m], momentum; or their rates, a second."""

    angles: Vector3
    position: Vector3
    momentum: Spatial


class HalfAngles(NamedTuple):
    """Cosines and sines of half the roll, half the pitch and half the heading."""

    cosines: Vector3
    sines: Vector3


def halves(angles: Vector3) -> HalfAngles:
    """Return the cosines and sines of half of three angles; NaN for what is not finite."""
    roll, pitch, heading = scale(0.5, angles)
    # NaN for an infinity, for which math.sin would raise
    roll, pitch, heading = roll + (roll - roll), pitch + (pitch - pitch), heading + (heading - heading)
    return HalfAngles(
        (math.cos(roll), math.cos(pitch), math.cos(heading)),
        (math.sin(roll), math.sin(pitch), math.sin(heading)),
    )


def attitude_of(half: HalfAngles) -> Quaternion:
    """Return the quaternion, body to NED."""
    (cr, cp, ch), (sr, sp, sh) = half
    return (
        ch * cp * cr + sh * sp * sr,
        ch * cp * sr - sh * sp * cr,
        ch * sp * cr + sh * cp * sr,
        sh * cp * cr - ch * sp * sr,
    )


def angle_rates(half: HalfAngles, spin: Vector3) -> Vector3:
    """Return the rates of roll, pitch and heading [rad/s] at a spin (p, q, r)."""
    cr, cp = half.cosines[0], half.cosines[1]
    sr, sp = half.sines[0], half.sines[1]
    sin_roll, cos_roll = 2.0 * sr * cr, cr * cr - sr * sr
    sin_pitch, cos_pitch = 2.0 * sp * cp, cp * cp - sp * sp
    heading_rate = (spin[1] * sin_roll + spin[2] * cos_roll) / cos_pitch
    return (spin[0] + sin_pitch * heading_rate, spin[1] * cos_roll - spin[2] * sin_roll, heading_rate)


def angles_of(q: Quaternion) -> Vector3:
    """Return roll, pitch and heading [rad] of a unit quaternion, pitch within 90 degrees."""
    sin_pitch = 2.0 * (q[0] * q[2] - q[3] * q[1])
    return (
        math.atan2(2.0 * (q[0] * q[1] + q[2] * q[3]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])),
        math.asin(min(1.0, max(-1.0, sin_pitch))),
        math.atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3])),
    )


def shifted(posture: Posture, h: float, rates: Posture) -> Posture:
    """Return posture + h rates."""
    return Posture(
        add_scaled(posture.angles, h, rates.angles),
        add_scaled(posture.position, h, rates.position),
        spatial_add_scaled(posture.momentum, h, rates.momentum),
    )


def weighted(k1: Posture, k2: Posture, k3: Posture, k4: Posture) -> Posture:
    """Return k1 + 2 (k2 + k3) + k4."""
    return Posture(
        add(add(k1.angles, k4.angles), scale(2.0, add(k2.angles, k3.angles))),
        add(add(k1.position, k4.position), scale(2.0, add(k2.position, k3.position))),
        spatial_add(
            spatial_add(k1.momentum, k4.momentum),
            spatial_scale(2.0, spatial_add(k2.momentum, k3.momentum)),
        ),
    )


def make_rk4_euler(composition: Composition) -> Advance:
    """Return the advance of RK4 on Euler angles: four evaluations of all forces a step."""
    momentum_rate = make_momentum_rate(without_time_forces(composition))
    foresee, land = make_foresee(composition), make_landing(composition)

    def rates_at(parameters: StepParameters, posture: Posture, start: float, foreseen: Foreseen) -> Posture:
        half = halves(posture.angles)
        point = Point(attitude_of(half), posture.position, posture.momentum)
        twist = twist_at(parameters, point)
        return Posture(
            angle_rates(half, twist.angular),
            rotate(point.attitude, twist.linear),
            momentum_rate(parameters, point, twist, start, foreseen.elapsed, foreseen.wrench),
        )

    def rk4_euler(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        half = 0.5 * h
        posture = Posture(angles_of(state.pose.real), pose_position(state.pose), state.momentum)
        for step in range(steps):
            early, middle, late = foresee(parameters, time, step * h, wrench, NODES)
            k1 = rates_at(parameters, posture, time, early)
            k2 = rates_at(parameters, shifted(posture, half, k1), time, middle)
            k3 = rates_at(parameters, shifted(posture, half, k2), time, middle)
            k4 = rates_at(parameters, shifted(posture, h, k3), time, late)
            posture = shifted(posture, h / 6.0, weighted(k1, k2, k3, k4))
        attitude = attitude_of(halves(posture.angles))
        return land(parameters, state, Point(attitude, posture.position, posture.momentum), time, steps, 0)

    return rk4_euler
