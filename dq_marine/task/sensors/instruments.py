"""The kinds of sensors: what each measures, when it can, and what it stands for in the motion that an agent is told."""

from __future__ import annotations

from typing import Any

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.quaternion import Quaternion, quaternion_multiply, rotate, rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, add, clamp, multiply_elementwise, scale, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.sensors.errors import Instrument, SensorNumbers

MOST_FORCE = 200.0
"""Specific forces are told up to this along each axis [m/s^2]."""

BLANK3 = (0.0, 0.0, 0.0)


def read_rates(
    numbers: SensorNumbers, gain: Vector3, offset: Vector3, carried: Any, motion: Motion
) -> Vector3:
    """Return the angular velocity in the body frame [rad/s]."""
    return add(multiply_elementwise(gain, motion.velocity.angular), offset)


def believe_rates(values: Vector3, motion: Motion) -> Motion:
    """Return the motion with the measured angular velocity."""
    return Motion(motion.position_ned, motion.attitude, Spatial(values, motion.velocity.linear))


def read_velocity(
    numbers: SensorNumbers, gain: Vector3, offset: Vector3, carried: Any, motion: Motion
) -> Vector3:
    """Return the velocity over ground in the body frame [m/s]."""
    return add(multiply_elementwise(gain, motion.velocity.linear), offset)


def bottom_in_reach(numbers: SensorNumbers, motion: Motion) -> bool:
    """Whether the sea bed, at the depth limits[0], is below the vehicle by at most limits[1] [m]."""
    altitude = numbers.limits[0] - motion.position_ned[2]
    return (altitude > 0.0) & (altitude <= numbers.limits[1])


def believe_velocity(values: Vector3, motion: Motion) -> Motion:
    """Return the motion with the measured linear velocity."""
    return Motion(motion.position_ned, motion.attitude, Spatial(motion.velocity.angular, values))


def read_depth(
    numbers: SensorNumbers, gain: Vector3, offset: Vector3, carried: Any, motion: Motion
) -> tuple[float]:
    """Return the depth [m]."""
    return (gain[0] * motion.position_ned[2] + offset[0],)


def believe_depth(values: tuple[float], motion: Motion) -> Motion:
    """Return the motion with the measured depth."""
    x, y, _ = motion.position_ned
    return Motion((x, y, values[0]), motion.attitude, motion.velocity)


def read_fix(
    numbers: SensorNumbers, gain: Vector3, offset: Vector3, carried: Any, motion: Motion
) -> tuple[float, float]:
    """Return the horizontal position in NED [m]."""
    return (motion.position_ned[0] + offset[0], motion.position_ned[1] + offset[1])


def antenna_in_air(numbers: SensorNumbers, motion: Motion) -> bool:
    """Whether the vehicle is not deeper than limits[0] [m]."""
    return motion.position_ned[2] <= numbers.limits[0]


def believe_fix(values: tuple[float, float], motion: Motion) -> Motion:
    """Return the motion with the measured horizontal position."""
    return Motion((values[0], values[1], motion.position_ned[2]), motion.attitude, motion.velocity)


def read_attitude(
    numbers: SensorNumbers, gain: Vector3, offset: Vector3, carried: Any, motion: Motion
) -> Quaternion:
    """Return the attitude, turned in NED by the offset [rad]: tilts about north and east, then the heading."""
    turn = quaternion_from_euler(offset[0], offset[1], offset[2])
    return quaternion_multiply(turn, motion.attitude)


def believe_attitude(values: Quaternion, motion: Motion) -> Motion:
    """Return the motion with the measured attitude."""
    return Motion(motion.position_ned, values, motion.velocity)


def carry_velocity(motion: Motion) -> Vector3:
    """Return the velocity in NED [m/s]."""
    return rotate(motion.attitude, motion.velocity.linear)


def read_specific_force(
    numbers: SensorNumbers, gain: Vector3, offset: Vector3, carried: Vector3, motion: Motion
) -> Vector3:
    """Return the specific force in the body frame [m/s^2], the mean over the control period that ends here.

    limits[0] is the acceleration of gravity.
    """
    acceleration = scale(1.0 / numbers.period, subtract(carry_velocity(motion), carried))
    force = rotate_inverse(motion.attitude, subtract(acceleration, (0.0, 0.0, numbers.limits[0])))
    return add(multiply_elementwise(gain, force), offset)


def show_values(values: Vector3) -> Vector3:
    """Return the values, held within `MOST_FORCE`."""
    return clamp(MOST_FORCE, values)


GYROSCOPE = Instrument(3, (BLANK3, ()), read_rates, believe=believe_rates)
ACCELEROMETER = Instrument(3, (BLANK3, BLANK3), read_specific_force, carry=carry_velocity, show=show_values)
DVL_INSTRUMENT = Instrument(3, (BLANK3, ()), read_velocity, bottom_in_reach, believe=believe_velocity)
DEPTH_METER = Instrument(1, ((0.0,), ()), read_depth, believe=believe_depth)
GNSS_RECEIVER = Instrument(2, ((0.0, 0.0), ()), read_fix, antenna_in_air, believe=believe_fix)
AHRS_INSTRUMENT = Instrument(3, ((1.0, 0.0, 0.0, 0.0), ()), read_attitude, believe=believe_attitude)
