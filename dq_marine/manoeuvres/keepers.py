"""Helmsman and planesman: what holds heading and depth while a manoeuvre is about something else."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.munk import munk_growth_rate

QUICKNESS = 3.0
"""Angular frequency of heading and pitch control, in units of speed over length."""

DEPTH_SLOPE = 0.3
"""Pitch angle asked for, per length off the depth [rad]: slow beside the control of pitch."""

LARGEST_PITCH = math.radians(15.0)
"""That is asked for."""


@dataclass(frozen=True)
class Keeper:
    """Critically damped control of heading, depth and pitch, with gains from the vehicle's inertia.

    Attributes:
        frequency: of heading and pitch control [rad/s]: quicker than the vehicle turns away by itself.
        depth_frequency: of depth control by a heave force [rad/s].
        length: of the vehicle [m].
        mass: M33 [kg].
        pitch_inertia: M55 [kg m^2].
        yaw_inertia: M66 [kg m^2].
        yaw_limit: moment of full helm [N m].
        net_weight: W - B [N].
        heaves: whether the vehicle has a heave force; it holds its depth by pitching otherwise.
    """

    frequency: float
    depth_frequency: float
    length: float
    mass: float
    pitch_inertia: float
    yaw_inertia: float
    yaw_limit: float
    net_weight: float
    heaves: bool

    def helm(self, heading_error: float, yaw_rate: float) -> float:
        """Return the helm against a heading error [rad] and a yaw rate [rad/s]."""
        moment = self.yaw_inertia * self._against(heading_error, yaw_rate)
        return min(max(moment / self.yaw_limit, -1.0), 1.0)

    def heave_and_pitch(
        self, depth_error: float, pitch: float, velocity_body: NDArray[np.float64]
    ) -> tuple[float, float]:
        """Return heave force [N] and pitch moment [N m] against a depth error [m], positive when too deep."""
        _, _, heave, _, pitch_rate, _ = velocity_body
        wanted, force = 0.0, 0.0
        if self.heaves:
            rate = self.depth_frequency
            force = -self.mass * (rate * rate * depth_error + 2.0 * rate * heave) - self.net_weight
        else:
            wanted = min(max(DEPTH_SLOPE * depth_error / self.length, -LARGEST_PITCH), LARGEST_PITCH)
        return force, self.pitch_inertia * self._against(pitch - wanted, pitch_rate)

    def _against(self, error: float, rate: float) -> float:
        return -self.frequency * (self.frequency * error + 2.0 * rate)


def keeper_of(vehicle: Vehicle, speed: float) -> Keeper:
    """Return the keeper that suits a vehicle at a speed [m/s]."""
    length, inertia, limits = vehicle.dimensions.length, np.diag(vehicle.mass_matrix), vehicle.wrench_limits
    return Keeper(
        frequency=max(QUICKNESS * speed / length, 2.0 * munk_growth_rate(vehicle, speed)),
        depth_frequency=speed / length,
        length=length,
        mass=float(inertia[2]),
        pitch_inertia=float(inertia[4]),
        yaw_inertia=float(inertia[5]),
        yaw_limit=float(limits[5]),
        net_weight=vehicle.weight - vehicle.buoyant_force,
        heaves=bool(limits[2] > 0.0),
    )
