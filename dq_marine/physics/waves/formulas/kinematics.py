"""Linear (Airy) waves: a sea as a sum of components, and its first-order force on a submerged hull.

A component of amplitude a, angular frequency omega, wave number k and direction e (where it goes to, horizontal) raises
the surface by a cos(theta), theta = omega t - k e . x + phase. In deep water the water at depth z moves with

    velocity      a omega e^{-kz} (cos theta e + sin theta down)
    acceleration  a omega^2 e^{-kz} (-sin theta e + cos theta down)

(Faltinsen 1990, Sea Loads on Ships and Offshore Structures, ch. 2). Over a bottom at depth d the two parts decay as
cosh k(d - z)/sinh kd and sinh k(d - z)/sinh kd instead. Second order in the amplitude is left out, so above the still
water's surface everything is as at the surface. The body's own position enters theta: the frequency of encounter comes
of itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.elementary import exponential, sine_and_cosine
from dq_marine.algebra.matrix3 import Matrix3, transform
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import ZERO, Spatial, spatial_add_scaled
from dq_marine.algebra.table import Table
from dq_marine.algebra.vector3 import Vector3, add, cross
from dq_marine.integrator.forces import PoseForce


class WaveField(NamedTuple):
    """The components of a sea, one entry each.

    Attributes:
        amplitude: a [m].
        frequency: omega [rad/s].
        wave_number: k [rad/m].
        north: north component of k e [rad/m].
        east: east component of k e [rad/m].
        phase: [rad].
        echo: e^{-2 k d} with the water's depth d; not asked in deep water.
    """

    amplitude: Table
    frequency: Table
    wave_number: Table
    north: Table
    east: Table
    phase: Table
    echo: Table


class WaterMotion(NamedTuple):
    """How the waves move the water somewhere, in NED: velocity [m/s] and acceleration [m/s^2]."""

    velocity: Vector3
    acceleration: Vector3


Profile: TypeAlias = Callable[[float, float, float], tuple[float, float]]
"""(wave number, echo, depth) -> how large horizontal and vertical motion are there, next to a omega."""

Orbit: TypeAlias = Callable[[WaveField, Vector3, float], WaterMotion]


def deep_profile(wave_number: float, echo: float, depth: float) -> tuple[float, float]:
    """Return e^{-kz} twice."""
    left = exponential(-(wave_number * depth))
    return left, left


def bottom_profile(wave_number: float, echo: float, depth: float) -> tuple[float, float]:
    """Return cosh k(d - z)/sinh kd and sinh k(d - z)/sinh kd; below the bottom they are its own."""
    direct = exponential(-(wave_number * depth))
    reflected = min(echo / direct, direct)
    within = 1.0 / (1.0 - echo)
    return (direct + reflected) * within, (direct - reflected) * within


def wave_phase(field: WaveField, j: int, north: float, east: float, time: float) -> float:
    """Return theta of component j at a place [m] and time [s]."""
    travelled = field.north[j] * north + field.east[j] * east
    return field.frequency[j] * time + field.phase[j] - travelled


def make_orbit(profile: Profile) -> Orbit:
    """Return (sea, position in NED, time) -> the water's motion there."""

    def orbit(field: WaveField, position: Vector3, time: float) -> WaterMotion:
        north, east = position[0], position[1]
        depth = max(position[2], 0.0)
        zero = spread(0.0, depth)
        u, v, w = zero, zero, zero
        du, dv, dw = zero, zero, zero
        for j in range(len(field.amplitude)):
            sine, cosine = sine_and_cosine(wave_phase(field, j, north, east, time))
            horizontal, vertical = profile(field.wave_number[j], field.echo[j], depth)
            frequency = field.frequency[j]
            speed = field.amplitude[j] * frequency
            along = horizontal * (speed / field.wave_number[j])
            down = vertical * speed
            ahead, forced = along * cosine, along * (-frequency) * sine
            u = u + field.north[j] * ahead
            v = v + field.east[j] * ahead
            w = w + down * sine
            du = du + field.north[j] * forced
            dv = dv + field.east[j] * forced
            dw = dw + down * frequency * cosine
        return WaterMotion((u, v, w), (du, dv, dw))

    return orbit


deep_orbit = make_orbit(deep_profile)
bottom_orbit = make_orbit(bottom_profile)


class SubmergedHull(NamedTuple):
    """How a hull below the surface answers to the water around it.

    The hull is cut into stations along its x axis; each takes its share of the wrench in the water's motion there.

    Attributes:
        centre: of buoyancy, about which the stations lie, body frame [m].
        force_by_acceleration: rho V E + the linear block of M_A [kg].
        moment_by_acceleration: rho V S(centre) + the block of M_A from linear motion to moment [kg m].
        force_by_velocity: linear block of the linear damping [N s/m].
        moment_by_velocity: block of the linear damping from linear motion to moment [N s].
        places: of the stations, along x from the centre [m].
        shares: of the stations; their sum is 1.
    """

    centre: Vector3
    force_by_acceleration: Matrix3
    moment_by_acceleration: Matrix3
    force_by_velocity: Matrix3
    moment_by_velocity: Matrix3
    places: Table
    shares: Table


class SubmergedWaves(NamedTuple):
    """Parameters of the force of waves on a submerged hull."""

    sea: WaveField
    hull: SubmergedHull


def make_submerged_waves(orbit: Orbit) -> PoseForce:
    """Return the first-order wave force on a submerged hull much narrower than the waves are long.

    A body that is neither heavy nor damped and much smaller than the waves has M (dv/dt - a) = 0 by it, a the water's
    acceleration: Froude-Krylov force rho V a and diffraction M_A a (Faltinsen 1990, ch. 3, in all directions).
    Linear damping acts on the velocity through the water that the waves move.
    """

    def submerged_waves(parameters: SubmergedWaves, pose: DualQuaternion, time: float) -> Spatial:
        hull, attitude, origin = parameters.hull, pose.real, pose_position(pose)
        total = spread(ZERO, attitude[0])
        for i in range(len(hull.places)):
            lever = (hull.places[i], 0.0, 0.0)
            place = add(origin, rotate(attitude, add(hull.centre, lever)))
            motion = orbit(parameters.sea, place, time)
            velocity = rotate_inverse(attitude, motion.velocity)
            acceleration = rotate_inverse(attitude, motion.acceleration)
            force = add(
                transform(hull.force_by_acceleration, acceleration),
                transform(hull.force_by_velocity, velocity),
            )
            moment = add(
                transform(hull.moment_by_acceleration, acceleration),
                transform(hull.moment_by_velocity, velocity),
            )
            wrench = Spatial(add(moment, cross(lever, force)), force)
            total = spatial_add_scaled(total, hull.shares[i], wrench)
        return total

    return submerged_waves


submerged_waves_in_deep_water = make_submerged_waves(deep_orbit)
submerged_waves_over_bottom = make_submerged_waves(bottom_orbit)
