"""Wind on what stands out of the water (Fossen 2021, sec. 10.1).

With the velocity (u_r, v_r) through the air in the body frame, its size V, and gamma = -atan2(v_r, u_r),

    X = -1/2 rho V^2 c_x cos(gamma) A_F,   Y = 1/2 rho V^2 c_y sin(gamma) A_L,   N = 1/2 rho V^2 c_n sin(2 gamma) A_L L

which needs no angle: V cos(gamma) = u_r and V sin(gamma) = -v_r. The force acts at a height, and so heels and trims.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.table import Table
from dq_marine.algebra.vector3 import Vector3, add_scaled, subtract
from dq_marine.integrator.forces import VelocityForce


class WindForce(NamedTuple):
    """Parameters of the force.

    Attributes:
        air: mean velocity of the air in NED, less the water's own where that is known [m/s].
        along: the direction in which the air goes, a unit vector in NED: gusts are along it.
        surge: rho c_x A_F/2 [kg/m].
        sway: rho c_y A_L/2 [kg/m].
        yaw: rho c_n A_L L [kg].
        height: of the force above the body origin [m].
        gusts: what `Gusts` asks.
    """

    air: Vector3
    along: Vector3
    surge: float
    sway: float
    yaw: float
    height: float
    gusts: Any


class Harmonics(NamedTuple):
    """Gusts as a sum of cosines: amplitudes [m/s], angular frequencies [rad/s] and phases [rad]."""

    amplitude: Table
    frequency: Table
    phase: Table


Gusts: TypeAlias = Callable[[Any, float, float], float]
"""(parameters, time, like) -> speed over the mean [m/s], in as many lanes as `like` has."""


def no_gusts(parameters: Any, time: float, like: float) -> float:
    """Return 0."""
    return spread(0.0, like)


def harmonic_gusts(harmonics: Harmonics, time: float, like: float) -> float:
    """Return the sum of the harmonics."""
    speed = spread(0.0, like)
    for j in range(len(harmonics.amplitude)):
        angle = harmonics.frequency[j] * time + harmonics.phase[j]
        speed = speed + harmonics.amplitude[j] * sine_and_cosine(angle)[1]
    return speed


def make_wind(gusts: Gusts) -> VelocityForce:
    """Return the force of wind with gusts of a kind."""

    def wind(parameters: WindForce, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        gust = gusts(parameters.gusts, time, pose.real[0])
        air = rotate_inverse(pose.real, add_scaled(parameters.air, gust, parameters.along))
        through = subtract(twist.linear, air)
        u, v = through[0], through[1]
        speed = math.sqrt(u * u + v * v)
        ahead, aside = -parameters.surge * speed * u, -parameters.sway * speed * v
        moment = (parameters.height * aside, -parameters.height * ahead, -parameters.yaw * u * v)
        return Spatial(moment, (ahead, aside, spread(0.0, u)))

    return wind


steady_wind = make_wind(no_gusts)
gusty_wind = make_wind(harmonic_gusts)
