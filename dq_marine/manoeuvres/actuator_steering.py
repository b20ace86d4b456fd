"""Steering by a vehicle's own thrusters, azimuths and fins."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.steering import HEAVE, PITCH, RUDDER, SURGE, YAW, Order
from dq_marine.physics.actuators.tables import ActuatorSet, Azimuth
from dq_marine.simulation.one_body import OneBody
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

AXES = {SURGE: "surge", HEAVE: "heave", PITCH: "pitch", YAW: "yaw"}

SLOWEST = 0.1
"""Smallest surge speed with which the moment of the planes is computed, over the reference speed."""

USEFUL = 1e-6
"""Share of what is asked for that thrusters must be able to make in an axis, to count as able to."""


class Pattern(NamedTuple):
    """Thrusts that make a force or moment in one axis, and as little as can be in the others.

    Attributes:
        thrusts: for 1 N or 1 N m, x and y of each azimuth apart, shape (n,).
        low: most that they make in the negative sense, within the limits, 0 or less.
        high: most that they make in the positive sense.
    """

    thrusts: Array
    low: float
    high: float

    def share(self, part: float) -> Array:
        """Return the thrusts for a share of the most, -1 to 1."""
        return self.thrusts * (part * self.high if part >= 0.0 else -part * self.low)

    def force(self, wanted: float) -> Array:
        """Return the thrusts for a force or moment, within the most."""
        return self.thrusts * min(max(wanted, self.low), self.high)


class ActuatorSteering:
    """Throttle is a share of the most thrust ahead or astern.

    Helm is a share of the largest deflection of the fins that turn the vehicle; of one without, of the largest yaw
    moment that its thrusters make. Depth is held by planes and thrusters likewise. Where all this asks for more than a
    thruster has, it gives what it has.
    """

    def __init__(self, vehicle: Vehicle, speed: float) -> None:
        """Take the vehicle's actuators.

        Args:
            vehicle: its actuators, length and actuated axes are used.
            speed: that scales are made for [m/s].

        Raises:
            InvalidInputError: they cannot drive the vehicle ahead, or turn it.
        """
        self._actuators = vehicle.actuators
        self._low, self._high = thrust_bounds(self._actuators)
        self._slowest = SLOWEST * speed
        self._fins = self._actuators.fin_matrix
        self._fin_limits = np.array([fin.limit for fin in self._actuators.fins])
        self._patterns = {axis: self._pattern(vehicle, axis) for axis in AXES}
        self._rudders = np.sign(self._fins[YAW]) * self._fin_limits
        self._planes = np.where(self._rudders == 0.0, np.sign(self._fins[PITCH]) * self._fin_limits, 0.0)
        drives, turns = self._patterns[SURGE].high > 0.0, self.full_moment(speed) > 0.0
        for able, purpose in ((drives, "drive it ahead"), (turns, "turn it")):
            if not able:
                raise InvalidInputError(
                    f"the actuators of {vehicle.name!r} cannot {purpose}; give it thrusters or fins that can, or "
                    'steer it with actuation="wrench"'
                )

    @property
    def full_angle(self) -> float:
        """Largest deflection of the rudders [rad]; `RUDDER` of a vehicle without."""
        return float(np.abs(self._rudders).max()) if self._rudders.any() else RUDDER

    def full_moment(self, speed: float) -> float:
        """Return the yaw moment of full helm [N m]: of the rudders at a speed ahead [m/s], else of the thrusters."""
        if self._rudders.any():
            return float(self._fins[YAW] @ self._rudders) * speed * abs(speed)
        yaw = self._patterns[YAW]
        return min(yaw.high, -yaw.low)

    def advance(self, body: OneBody, order: Order, surge_speed: float, steps: int) -> None:
        """Advance the body under an order."""
        thrusts = self._patterns[SURGE].share(order.throttle) + self._patterns[HEAVE].force(order.heave_force)
        deflections = order.helm * self._rudders
        if not self._rudders.any():
            thrusts = thrusts + self._patterns[YAW].share(order.helm)
        if self._planes.any():
            # Planes that move astern work the other way round.
            pressure = surge_speed * max(abs(surge_speed), self._slowest)
            most = float(self._fins[PITCH] @ self._planes) * pressure
            part = order.pitch_moment / most if most else 0.0
            deflections = deflections + min(max(part, -1.0), 1.0) * self._planes
        else:
            thrusts = thrusts + self._patterns[PITCH].force(order.pitch_moment)
        body.actuate(self._command(np.clip(thrusts, self._low, self._high), deflections), steps)

    def _pattern(self, vehicle: Vehicle, axis: int) -> Pattern:
        """Return the least thrusts that make a force or moment in one axis alone, as nearly as they can.

        Least squares over the axes that are actuated, a moment counting like the force that makes it at one length.
        """
        matrix = self._actuators.thrust_matrix
        weights = np.where(vehicle.wrench_limits > 0.0, 1.0, 0.0)
        weights[3:] /= vehicle.dimensions.length
        thrusts = np.linalg.pinv(weights[:, None] * matrix, rcond=1e-9)[:, axis] * weights[axis]
        made = float(matrix[axis] @ thrusts)
        if made < USEFUL:
            return Pattern(np.zeros(matrix.shape[1]), 0.0, 0.0)
        thrusts = np.where(np.abs(thrusts) > 1e-12 * np.abs(thrusts).max(), thrusts / made, 0.0)
        return Pattern(thrusts, -self._most(-thrusts), self._most(thrusts))

    def _most(self, thrusts: Array) -> float:
        """Return how often thrusts can be made within the limits."""
        used = thrusts != 0.0
        bounds = np.where(thrusts > 0.0, self._high, self._low)[used]
        return float((bounds / thrusts[used]).min())

    def _command(self, thrusts: Array, deflections: Array) -> Array:
        """Return the commands of all channels."""
        thrusters, azimuths = self._actuators.thrusters, self._actuators.azimuths
        commands = [thruster.command_for(thrusts[i]) for i, thruster in enumerate(thrusters)]
        for i, azimuth in enumerate(azimuths):
            first = len(thrusters) + 2 * i
            thrust, angle = thrust_and_angle(azimuth, *thrusts[first : first + 2])
            commands += [azimuth.command_for(thrust), angle]
        return np.array([*commands, *deflections])


def thrust_bounds(actuators: ActuatorSet) -> tuple[Array, Array]:
    """Return the smallest and largest thrusts, x and y of each azimuth apart, each of shape (n,)."""
    bounds = [thruster.thrust_range for thruster in actuators.thrusters]
    for azimuth in actuators.azimuths:
        most, side = azimuth.thrust_range[1], math.sin(min(azimuth.angle_limit, 0.5 * math.pi))
        astern = -most if turns_round(azimuth) else azimuth.thrust_range[0]
        bounds += [(astern, most), (-most * side, most * side)]
    low, high = np.array(bounds).reshape(-1, 2).T
    return low, high


def turns_round(azimuth: Azimuth) -> bool:
    """Return whether an azimuth pushes astern by turning."""
    return azimuth.angle_limit_deg is None


def thrust_and_angle(azimuth: Azimuth, ahead: float, starboard: float) -> tuple[float, float]:
    """Return thrust [N] and angle [rad] of a force; no angle of no force."""
    thrust = math.hypot(ahead, starboard)
    if thrust <= USEFUL * azimuth.thrust_range[1]:
        return 0.0, 0.0
    if ahead < 0.0 and not turns_round(azimuth):
        return -thrust, math.atan2(-starboard, -ahead)
    return thrust, math.atan2(starboard, ahead)
