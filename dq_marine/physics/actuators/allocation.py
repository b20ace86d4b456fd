"""Thrust allocation: commands of a vehicle's actuators for a wanted wrench.

Thrusts f solve a least squares problem within the actuators' limits,

    minimise |W (B f - tau)|^2 + e^2 |f / f_max|^2,    f_min <= f <= f_max,                            (A1)

with B the allocation matrix and tau the wanted wrench. W makes forces and moments comparable: a moment counts like the
force that makes it at the arm of one vehicle length. Axes that the vehicle's file says are not actuated do not count.
The small e chooses the least effort among solutions that are equally good. (Constrained allocation: Johansen and Fossen
2013, Control allocation, a survey, Automatica 49, 1087.)

An azimuth counts as two thrusts, along x and y, each within the largest thrust. Where this rectangle promises more than
the azimuth can do, its direction is kept and its thrust limited, and the rest is solved again.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.checks import finite_array, finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.physics.actuators.tables import Azimuth, Propulsion
from dq_marine.util.extras import extra_needed

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

with extra_needed("thrust allocation", "allocation"):
    from scipy.optimize import lsq_linear

Array = NDArray[np.float64]

EFFORT = 1e-5
"""The e of (A1): small enough to move a reachable wrench by a part in 1e10 of the largest."""

BEYOND = 1e-9
"""Round-off by which an azimuth may exceed its limits, over its largest thrust."""


class Allocation(NamedTuple):
    """The commands that an allocation found.

    Attributes:
        command: of all channels, in the order and the units of `Vehicle.channels`, shape (n,).
        action: the same over the channels' limits, as environments take it, shape (n,).
        wrench_body: what they then do in water at rest, in Fossen's order, shape (6,) [N, N m].
        unreachable: the wanted wrench less this, shape (6,).
    """

    command: Array
    action: Array
    wrench_body: Array
    unreachable: Array


class Columns(NamedTuple):
    """Thrusts and deflections to be found: their wrenches, shape (6, n), and bounds, shape (n,)."""

    matrix: Array
    low: Array
    high: Array


class ThrustAllocator:
    """Finds commands of a vehicle's thrusters, azimuths and fins for a wanted wrench."""

    def __init__(self, vehicle: Vehicle, *, arm: float | None = None, effort: float = EFFORT) -> None:
        """Take the vehicle's actuators.

        Args:
            vehicle: its actuators, limits and length are used.
            arm: at which a moment counts like a force [m]; None for the vehicle's length.
            effort: e of (A1).

        Raises:
            InvalidInputError: the vehicle has no actuators whose force is known, or a value is wrong.
        """
        actuators = vehicle.actuators
        if not actuators.channels:
            raise InvalidInputError(
                f"vehicle {vehicle.name!r} has no actuators whose force is known; add thrust_forward and "
                "thrust_reverse to its [[thrusters]], or [[azimuths]] or [[fins]]"
            )
        if actuators.manoeuvring is not None or actuators.whole_ship is not None:
            raise InvalidInputError(
                f"vehicle {vehicle.name!r} has the propeller and rudder of a ship's model, whose forces depend on its "
                "motion and cannot be allocated; command its channels"
            )
        length = vehicle.dimensions.length if arm is None else finite_number("arm", arm, above=0.0)
        self._effort = finite_number("effort", effort, above=0.0)
        self._weights = np.array([1.0] * 3 + [1.0 / length] * 3) * (vehicle.wrench_limits > 0.0)
        self._actuators = actuators
        self._channels = actuators.channels
        self._of_thrusts, self._of_deflections = actuators.thrust_matrix, actuators.fin_matrix
        thrusters = [thruster.thrust_range for thruster in actuators.thrusters]
        azimuths = [bounds for azimuth in actuators.azimuths for bounds in _rectangle(azimuth)]
        fins = [(-fin.limit, fin.limit) for fin in actuators.fins]
        self._low, self._high = np.array([*thrusters, *azimuths, *fins]).T

    def allocate(self, wrench_body: ArrayLike, *, surge_speed: float = 0.0) -> Allocation:
        """Return commands that come nearest to a wrench.

        Args:
            wrench_body: [X, Y, Z, K, M, N] in the body frame about its origin, shape (6,) [N, N m].
            surge_speed: u through the water [m/s], which fins live on; they are left alone at 0.

        Raises:
            InvalidInputError: a shape or value is wrong.
        """
        wanted = finite_array("wrench_body", wrench_body, 6)
        u = finite_number("surge_speed", surge_speed)
        matrix = np.hstack([self._of_thrusts, u * abs(u) * self._of_deflections])
        forces = self._within_circles(Columns(matrix, self._low, self._high), wanted)
        command, given = self._commands(forces)
        reached: Array = matrix @ given
        return Allocation(command, self._action(command), reached, wanted - reached)

    def _within_circles(self, columns: Columns, wanted: Array) -> Array:
        """Solve (A1), again and again with those azimuths held in direction that ask for what they cannot do."""
        first = len(self._actuators.thrusters)
        held: dict[int, float] = {}
        while True:
            forces = self._solve(columns, held, wanted)
            beyond = {
                first + 2 * i: _nearest_angle(azimuth, *forces[first + 2 * i : first + 2 * i + 2])
                for i, azimuth in enumerate(self._actuators.azimuths)
                if first + 2 * i not in held
                and _asks_too_much(azimuth, *forces[first + 2 * i : first + 2 * i + 2])
            }
            if not beyond:
                return forces
            held |= beyond

    def _solve(self, columns: Columns, held: dict[int, float], wanted: Array) -> Array:
        """Return the solution of (A1), with the azimuths at some columns held at an angle."""
        spread = np.eye(len(columns.low))
        low, high = columns.low.copy(), columns.high.copy()
        for column, angle in held.items():
            azimuth = self._actuators.azimuths[(column - len(self._actuators.thrusters)) // 2]
            spread[column : column + 2, column] = math.cos(angle), math.sin(angle)
            spread[column : column + 2, column + 1] = 0.0
            low[column], high[column] = _range_at_an_angle(azimuth)
        largest = np.maximum(np.abs(low), np.abs(high))
        scaled = self._weights[:, None] * (columns.matrix @ spread) * largest
        scale = float(np.abs(scaled).max()) or 1.0
        system = np.vstack([scaled / scale, self._effort * np.eye(len(largest))])
        right = np.concatenate([self._weights * wanted / scale, np.zeros(len(largest))])
        shares = lsq_linear(system, right, (low / largest, high / largest), method="bvls", tol=1e-14).x
        solution: Array = spread @ (largest * np.clip(shares, low / largest, high / largest))
        return solution

    def _commands(self, forces: Array) -> tuple[Array, Array]:
        """Return the commands of all channels, and the forces that they give: none within a dead band."""
        given, command = forces.copy(), []
        for i, thruster in enumerate(self._actuators.thrusters):
            command.append(thruster.command_for(forces[i]))
            given[i] = _held_thrust(thruster, command[-1])
        first = len(self._actuators.thrusters)
        for azimuth in self._actuators.azimuths:
            thrust, angle = _thrust_and_angle(azimuth, *forces[first : first + 2])
            command += [azimuth.command_for(thrust), angle]
            held = _held_thrust(azimuth, command[-2])
            given[first : first + 2] = held * math.cos(angle), held * math.sin(angle)
            first += 2
        return np.array([*command, *forces[first:]]), given

    def _action(self, command: Array) -> Array:
        """Return the commands over the limits on their sides."""
        low, high = np.array([[channel.low, channel.high] for channel in self._channels]).T
        limits = np.where(command < 0.0, -low, high)
        return np.asarray(np.clip(command / np.where(limits > 0.0, limits, 1.0), -1.0, 1.0))


def _held_thrust(propulsion: Propulsion, speed: float) -> float:
    """Return the thrust at a commanded speed."""
    forward, reverse = propulsion.gains
    if abs(speed) < propulsion.dead_band:
        return 0.0
    return (forward if speed >= 0.0 else reverse) * speed * abs(speed)


def _turns_about(azimuth: Azimuth) -> bool:
    """Whether the azimuth can turn to push sideways and astern, and so needs no reverse."""
    return azimuth.angle_limit >= 0.5 * math.pi


def _rectangle(azimuth: Azimuth) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return bounds of the forces along x and y that contain all that an azimuth can do."""
    largest, limit = azimuth.thrust_range[1], azimuth.angle_limit
    if _turns_about(azimuth):
        return (largest * math.cos(limit), largest), (-largest, largest)
    side = max(map(abs, azimuth.thrust_range)) * math.sin(limit)
    return azimuth.thrust_range, (-side, side)


def _thrust_and_angle(azimuth: Azimuth, x: float, y: float) -> tuple[float, float]:
    """Return the thrust and the angle of a force, limits aside."""
    sign = -1.0 if x < 0.0 and not _turns_about(azimuth) else 1.0
    return sign * math.hypot(x, y), math.atan2(sign * y, sign * x)


def _range_at_an_angle(azimuth: Azimuth) -> tuple[float, float]:
    """Return the smallest and largest thrust of an azimuth whose direction is held."""
    low, high = azimuth.thrust_range
    return (0.0, high) if _turns_about(azimuth) else (low, high)


def _asks_too_much(azimuth: Azimuth, x: float, y: float) -> bool:
    """Whether a force is beyond the largest thrust, or beyond the angles that the azimuth turns to."""
    thrust, angle = _thrust_and_angle(azimuth, x, y)
    (low, high), slack = _range_at_an_angle(azimuth), BEYOND * azimuth.thrust_range[1]
    turned_too_far = abs(angle) > azimuth.angle_limit * (1.0 + BEYOND) and abs(thrust) > slack
    return turned_too_far or not low - slack <= thrust <= high + slack


def _nearest_angle(azimuth: Azimuth, x: float, y: float) -> float:
    """Return the angle of a force, within what the azimuth turns to."""
    angle = _thrust_and_angle(azimuth, x, y)[1]
    return max(-azimuth.angle_limit, min(azimuth.angle_limit, angle))
