"""Helmsman and planesman: what holds heading and depth while a manoeuvre is about something else."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.analysis.munk import munk_growth_rate

QUICKNESS = 3.0
"""Angular frequency of heading and pitch control, in units of speed over length."""

DEPTH_SLOPE = 0.3
"""Pitch angle asked for, per length off the depth [rad]: slow beside the control of pitch."""

LARGEST_PITCH = math.radians(15.0)
"""That is asked for."""


@dataclass(frozen=True)
class Helmsman:
    """Critically damped control of heading.

    Attributes:
        frequency: [rad/s].
        inertia: M66 [kg m^2].
        full_moment: of full helm [N m].
    """

    frequency: float
    inertia: float
    full_moment: float

    def helm(self, heading_error: float, yaw_rate: float) -> float:
        """Return the helm against a heading error [rad] and a yaw rate [rad/s]."""
        moment = self.inertia * turning_back(self.frequency, heading_error, yaw_rate)
        return min(max(moment / self.full_moment, -1.0), 1.0)


class Planesman(Protocol):
    """Holds a depth."""

    def heave_and_pitch(
        self, depth_error: float, pitch: float, velocity_body: NDArray[np.float64]
    ) -> tuple[float, float]:
        """Return heave force [N] and pitch moment [N m] against a depth error [m], positive when too deep."""


class Afloat:
    """Holds nothing: a vessel that floats does so by itself."""

    def heave_and_pitch(
        self, depth_error: float, pitch: float, velocity_body: NDArray[np.float64]
    ) -> tuple[float, float]:
        """Return no force and no moment."""
        return 0.0, 0.0


@dataclass(frozen=True)
class LevelPlanesman:
    """Holds the depth by a heave force, and the vehicle level: critically damped.

    Attributes:
        frequency: of pitch control [rad/s].
        pitch_inertia: M55 [kg m^2].
        depth_frequency: of depth control [rad/s].
        mass: M33 [kg].
        net_weight: W - B, payloads included [N].
    """

    frequency: float
    pitch_inertia: float
    depth_frequency: float
    mass: float
    net_weight: float

    def heave_and_pitch(
        self, depth_error: float, pitch: float, velocity_body: NDArray[np.float64]
    ) -> tuple[float, float]:
        """Return heave force [N] and pitch moment [N m]."""
        _, _, heave, _, pitch_rate, _ = velocity_body
        force = self.mass * turning_back(self.depth_frequency, depth_error, float(heave)) - self.net_weight
        return force, self.pitch_inertia * turning_back(self.frequency, pitch, float(pitch_rate))


@dataclass(frozen=True)
class PitchingPlanesman:
    """Holds the depth by pitching: of vehicles that have no heave force.

    Attributes:
        frequency: of pitch control [rad/s].
        pitch_inertia: M55 [kg m^2].
        length: of the vehicle [m].
    """

    frequency: float
    pitch_inertia: float
    length: float

    def heave_and_pitch(
        self, depth_error: float, pitch: float, velocity_body: NDArray[np.float64]
    ) -> tuple[float, float]:
        """Return no force, and the pitch moment [N m]."""
        wanted = min(max(DEPTH_SLOPE * depth_error / self.length, -LARGEST_PITCH), LARGEST_PITCH)
        _, _, _, _, pitch_rate, _ = velocity_body
        return 0.0, self.pitch_inertia * turning_back(self.frequency, pitch - wanted, float(pitch_rate))


def turning_back(frequency: float, error: float, rate: float) -> float:
    """Return the acceleration of a critically damped return, -omega^2 e - 2 omega e'."""
    return -frequency * (frequency * error + 2.0 * rate)


def control_frequency(vehicle: Vehicle, speed: float) -> float:
    """Return the frequency of heading and pitch control [rad/s]: quicker than the vehicle turns away by itself."""
    return max(QUICKNESS * speed / vehicle.dimensions.length, 2.0 * munk_growth_rate(vehicle, speed))


def helmsman_of(vehicle: Vehicle, speed: float, full_moment: float) -> Helmsman:
    """Return the helmsman of a vehicle at a speed [m/s], whose full helm makes a moment [N m]."""
    return Helmsman(control_frequency(vehicle, speed), float(vehicle.mass_matrix[5, 5]), full_moment)


def planesman_of(vehicle: Vehicle, speed: float) -> Planesman:
    """Return the planesman of a vehicle at a speed [m/s]."""
    if vehicle.hydrostatics is not None:
        return Afloat()
    frequency, inertia = control_frequency(vehicle, speed), np.diag(vehicle.mass_matrix)
    length, pitch_inertia = vehicle.dimensions.length, float(inertia[4])
    if vehicle.wrench_limits[2] == 0.0:
        return PitchingPlanesman(frequency, pitch_inertia, length)
    net_weight = vehicle.weight + vehicle.payload_weight - vehicle.buoyant_force
    return LevelPlanesman(frequency, pitch_inertia, speed / length, float(inertia[2]), net_weight)
