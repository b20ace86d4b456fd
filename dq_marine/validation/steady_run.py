"""A vehicle driven from rest by what does not change, until it does not change either."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.attitude import attitude_angles
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.quantities import Quantity
from dq_marine.manoeuvres.run import Watch
from dq_marine.manoeuvres.setup import ACCURATE_STEP, rounded_down, running_depth
from dq_marine.physics.fields import Vector3, Vector6
from dq_marine.physics.radiation.build import CONSTANT
from dq_marine.simulation.one_body import OneBody
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, vehicle_sheet

SPANS = 100
"""Looks at the vehicle during a run, for the largest angles."""

LARGEST_STEP = 0.1
"""Of the integrator [s]."""

AVERAGED = 10
"""Of the last looks, whose mean is read off."""


class Drive(NamedTuple):
    """What acts on a vehicle, and for how long.

    Attributes:
        wrench: on the body, in Fossen's order [N, N m].
        commands: of actuators by the names of their channels.
        current: of the water in NED [m/s].
        duration: of the run [s].
        radiation: "constant", or "memory".
    """

    wrench: Vector6
    commands: dict[str, float]
    current: Vector3
    duration: float
    radiation: str = CONSTANT


def steady_run(vehicle: Vehicle, drive: Drive, watch: Watch) -> tuple[Quantity, ...]:
    """Return speeds through the water, attitude and rates at the end of a run, the largest angles, and the way.

    Args:
        vehicle: what is driven, from rest over ground, heading north.
        drive: by what.
        watch: told of the progress.

    Raises:
        InvalidInputError: a command is of no channel of the vehicle, or it has no such radiation.
        StepNotSolvableError: the integrator refused a step.
    """
    command = _commands(vehicle, drive.commands)
    step = rounded_down(min(ACCURATE_STEP * vehicle_sheet(vehicle).largest_step, LARGEST_STEP))
    steps = max(1, math.ceil(drive.duration / SPANS / step - 1e-9))
    actuation = "thrusters" if drive.commands else "wrench"
    scene = Scene(vehicle, step=step, actuation=actuation, current=drive.current, radiation=drive.radiation)
    body = scene.stepper()
    body.reset((0.0, 0.0, running_depth(vehicle)))
    rows = []
    for _ in range(math.ceil(drive.duration / (steps * step) - 1e-9)):
        if command is None:
            body.step(drive.wrench, steps)
        else:
            body.actuate(command, steps, drive.wrench)
        rows.append(_row(body, drive.current))
        watch("steady run", body.time)
    return _quantities(np.array(rows))


def _commands(vehicle: Vehicle, named: dict[str, float]) -> NDArray[np.float64] | None:
    if not named:
        return None
    channels = [channel.name for channel in vehicle.channels]
    unknown = sorted(set(named) - set(channels))
    if unknown:
        known = ", ".join(channels) or "none"
        raise InvalidInputError(
            f"commands of {', '.join(map(repr, unknown))}: {vehicle.name} has no such channel; it has {known}"
        )
    return np.array([named.get(channel, 0.0) for channel in channels])


def _row(body: OneBody, current: Vector3) -> NDArray[np.float64]:
    """Velocity through the water, angular velocity, roll and pitch, position."""
    q = body.quaternion_body_to_ned
    attitude = (float(q[0]), float(q[1]), float(q[2]), float(q[3]))
    roll, pitch, _ = attitude_angles(q)
    through_water = body.velocity_body[:3] - rotate_inverse(attitude, current)
    return np.concatenate([through_water, body.velocity_body[3:], [roll, pitch], body.position_ned])


def _quantities(rows: NDArray[np.float64]) -> tuple[Quantity, ...]:
    u, v, w, _, _, r, roll, pitch = rows[-AVERAGED:, :8].mean(axis=0).tolist()
    most_roll, most_pitch = np.degrees(np.abs(rows[:, 6:8]).max(axis=0)).tolist()
    north, east, down = rows[-1, 8:].tolist()
    speed = math.sqrt(u * u + v * v + w * w)
    return (
        Quantity("surge_m_s", "surge", u, "m/s"),
        Quantity("sway_m_s", "sway", v, "m/s"),
        Quantity("heave_m_s", "heave", w, "m/s"),
        Quantity("speed_m_s", "speed through the water", speed, "m/s"),
        Quantity("drift_angle_deg", "drift angle", math.degrees(math.atan2(-v, u)), "deg"),
        Quantity("yaw_rate_deg_s", "rate of turn", math.degrees(r), "deg/s"),
        Quantity("roll_deg", "roll", math.degrees(roll), "deg"),
        Quantity("pitch_deg", "pitch", math.degrees(pitch), "deg"),
        Quantity("largest_roll_deg", "largest roll", most_roll, "deg"),
        Quantity("largest_pitch_deg", "largest pitch", most_pitch, "deg"),
        Quantity("north_m", "way north", north, "m"),
        Quantity("east_m", "way east", east, "m"),
        Quantity("depth_m", "depth", down, "m"),
    )
