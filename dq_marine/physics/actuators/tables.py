"""The actuators in a vehicle file: thrusters, thrusters that turn (azimuths), and fins.

Every actuator has one or two channels, numbers that are commanded: a shaft's speed, an angle, a deflection. A shaft's
speed is in rad/s where the file gives gains and largest speeds; where it gives the largest thrusts instead, the speed
is over its largest, from -1 to 1.
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from dq_marine.physics.abkowitz.tables import WholeShip
from dq_marine.physics.fields import NonNegative, Positive, Table, Vector3, Vector6
from dq_marine.physics.manoeuvring.tables import Manoeuvring

Degrees = Annotated[float, Field(gt=0.0, le=90.0)]


class ChannelSheet(NamedTuple):
    """A number of an actuator that can be commanded.

    Attributes:
        name: the actuator's, with "angle" after it for the angle of an azimuth.
        unit: "rad/s", "rad", or "1" for a share of the largest speed.
        low: smallest value.
        high: largest value; an azimuth that turns all round has -pi and pi, and takes any angle.
    """

    name: str
    unit: str
    low: float
    high: float


class Propulsion(Table):
    """A propeller: thrust k n |n| at the shaft speed n, with one k ahead and one astern.

    Say either `thrust_forward` and `thrust_reverse`, or `gain_forward`, `gain_reverse`, `speed_forward` and
    `speed_reverse`.

    Attributes:
        name: as people call it.
        thrust_forward: thrust at the largest speed ahead [N].
        thrust_reverse: thrust at the largest speed astern [N], positive.
        gain_forward: k ahead [N s^2].
        gain_reverse: k astern [N s^2].
        speed_forward: largest shaft speed ahead [rad/s].
        speed_reverse: largest shaft speed astern [rad/s], positive; 0 for a propeller that only pushes ahead.
        dead_band: commands below it count as 0, in the unit of the command.
        time_constant: of the first-order lag of the shaft speed [s]; 0 for none.
        rate_limit: largest rate of the shaft speed, in the unit of the command per second.
    """

    name: str = ""
    thrust_forward: Positive | None = None
    thrust_reverse: NonNegative | None = None
    gain_forward: Positive | None = None
    gain_reverse: Positive | None = None
    speed_forward: Positive | None = None
    speed_reverse: NonNegative | None = None
    dead_band: NonNegative = 0.0
    time_constant: NonNegative = 0.0
    rate_limit: Positive | None = None

    @model_validator(mode="after")
    def _one_way_to_say_it(self) -> Self:
        thrusts = (self.thrust_forward, self.thrust_reverse)
        gains = (self.gain_forward, self.gain_reverse, self.speed_forward, self.speed_reverse)
        given = [value is not None for value in (*thrusts, *gains)]
        if given not in ([False] * 6, [True] * 2 + [False] * 4, [False] * 2 + [True] * 4):
            raise ValueError(
                "its thrust is not told in one way; give thrust_forward and thrust_reverse, or gain_forward, "
                "gain_reverse, speed_forward and speed_reverse, or none of them for drawing only"
            )
        if self.driven and self.dead_band >= self.high:
            raise ValueError(
                f"dead_band = {self.dead_band:g} leaves nothing of a command of at most {self.high:g}; give a "
                "smaller one"
            )
        return self

    @property
    def driven(self) -> bool:
        """Whether its thrust is known; if not, it is for drawing only."""
        return self.thrust_forward is not None or self.gain_forward is not None

    @property
    def unit(self) -> str:
        """Unit of the command: "rad/s", or "1" for a share of the largest speed."""
        return "1" if self.gain_forward is None else "rad/s"

    @property
    def high(self) -> float:
        """Largest command."""
        return 1.0 if self.speed_forward is None else self.speed_forward

    @property
    def low(self) -> float:
        """Smallest command, 0 or less."""
        if self.speed_reverse is None:
            return -1.0 if self.thrust_reverse else 0.0
        return -self.speed_reverse

    @property
    def gains(self) -> tuple[float, float]:
        """Thrust over the command squared, ahead and astern [N per unit of the command squared]."""
        forward = self.gain_forward or self.thrust_forward or 0.0
        reverse = self.gain_reverse or self.thrust_reverse or 0.0
        return forward, reverse

    @property
    def thrust_range(self) -> tuple[float, float]:
        """Smallest and largest thrust in water at rest [N]."""
        forward, reverse = self.gains
        return -reverse * self.low**2, forward * self.high**2

    def command_for(self, thrust: float) -> float:
        """Return the command n whose thrust k n |n| in water at rest is the one given [N], within the limits."""
        forward, reverse = self.gains
        if thrust >= 0.0:
            return min(math.sqrt(thrust / forward), self.high)
        return max(-math.sqrt(-thrust / reverse), self.low) if reverse else 0.0


class Thruster(Propulsion):
    """A propeller on a fixed axis.

    Attributes:
        position: [m].
        direction: of the force on the body at positive thrust; need not be of unit length.
        inflow: thrust lost over shaft speed and speed of advance, in N per unit of the command and m/s; 0 where the
            thrust is taken as that in water at rest.
        torque_over_thrust: moment on the body along the direction over thrust [m]; negative where the propeller turns
            clockwise, seen from behind.
    """

    position: Vector3
    direction: Vector3
    inflow: NonNegative = 0.0
    torque_over_thrust: float = 0.0

    @property
    def unit_direction(self) -> Vector3:
        """The direction, of unit length."""
        x, y, z = self.direction
        length = math.hypot(x, y, z)
        return (x / length, y / length, z / length)


class Azimuth(Propulsion):
    """A propeller whose axis turns in the body's xy-plane; at the angle 0 it pushes forward, at pi/2 to starboard.

    Attributes:
        position: [m].
        angle_limit_deg: largest angle to either side; none for a thruster that turns all round.
        angle_rate_limit_deg_s: largest turning rate.
        angle_time_constant: of the first-order lag of the angle [s]; 0 for none.
    """

    position: Vector3
    angle_limit_deg: Annotated[float, Field(gt=0.0, le=180.0)] | None = None
    angle_rate_limit_deg_s: Positive | None = None
    angle_time_constant: NonNegative = 0.0

    @model_validator(mode="after")
    def _driven(self) -> Self:
        if not self.driven:
            raise ValueError(
                "its thrust is missing; give thrust_forward and thrust_reverse, or gains and speeds"
            )
        return self

    @property
    def angle_limit(self) -> float:
        """Largest angle [rad]; pi for a thruster that turns all round."""
        return math.pi if self.angle_limit_deg is None else math.radians(self.angle_limit_deg)


class Fin(Table):
    """A rudder or fin: a wrench of `coefficients` times u |u| times the deflection, for the surge velocity u.

    Attributes:
        name: as people call it.
        coefficients: X, Y, Z, K, M, N per rad and (m/s)^2, such as Y_uudr and N_uudr of a rudder.
        limit_deg: largest deflection, below stall.
        rate_limit_deg_s: largest rate of deflection.
        time_constant: of the first-order lag of the deflection [s]; 0 for none.
    """

    name: str = ""
    coefficients: Vector6
    limit_deg: Degrees
    rate_limit_deg_s: Positive | None = None
    time_constant: NonNegative = 0.0

    @property
    def limit(self) -> float:
        """Largest deflection [rad]."""
        return math.radians(self.limit_deg)

    @model_validator(mode="after")
    def _does_something(self) -> Self:
        if not any(self.coefficients):
            raise ValueError("its coefficients are all zero; give the force and moment per rad and (m/s)^2")
        return self


class ActuatorSet(NamedTuple):
    """A vehicle's actuators whose forces are known, in the order of their channels.

    The last are the propeller and rudder of an MMG model, which make one actuator, as the rudder lies in the race; or
    the rudder that is in the polynomials of a whole ship.
    """

    thrusters: tuple[Thruster, ...]
    azimuths: tuple[Azimuth, ...]
    fins: tuple[Fin, ...]
    manoeuvring: Manoeuvring | None = None
    whole_ship: WholeShip | None = None

    @property
    def thrust_matrix(self) -> NDArray[np.float64]:
        """Wrench in Fossen's order of thrusts, shape (6, n): one of each thruster, then x and y of each azimuth."""
        columns = []
        for thruster in self.thrusters:
            direction = np.array(thruster.unit_direction)
            moment = np.cross(thruster.position, direction) + thruster.torque_over_thrust * direction
            columns.append(np.concatenate([direction, moment]))
        for azimuth in self.azimuths:
            columns += [np.concatenate([axis, np.cross(azimuth.position, axis)]) for axis in np.eye(3)[:2]]
        return np.array(columns).reshape(-1, 6).T

    @property
    def fin_matrix(self) -> NDArray[np.float64]:
        """Wrench in Fossen's order of deflections at 1 m/s ahead [N/rad, N m/rad], shape (6, n)."""
        return np.array([fin.coefficients for fin in self.fins]).reshape(-1, 6).T

    @property
    def channels(self) -> tuple[ChannelSheet, ...]:
        """Channels of all actuators; an azimuth has its shaft's speed and its angle, an MMG stern likewise."""
        sheets = [
            ChannelSheet(thruster.name or f"thruster {i}", thruster.unit, thruster.low, thruster.high)
            for i, thruster in enumerate(self.thrusters)
        ]
        for i, azimuth in enumerate(self.azimuths):
            name = azimuth.name or f"azimuth {i}"
            sheets.append(ChannelSheet(name, azimuth.unit, azimuth.low, azimuth.high))
            sheets.append(ChannelSheet(f"{name} angle", "rad", -azimuth.angle_limit, azimuth.angle_limit))
        for i, fin in enumerate(self.fins):
            sheets.append(ChannelSheet(fin.name or f"fin {i}", "rad", -fin.limit, fin.limit))
        if self.manoeuvring is not None:
            rudder = self.manoeuvring.rudder
            sheets.append(ChannelSheet("propeller", "rad/s", 0.0, self.manoeuvring.propeller.speed_limit))
            sheets.append(ChannelSheet("rudder", "rad", -rudder.limit, rudder.limit))
        if self.whole_ship is not None:
            limit = self.whole_ship.rudder.limit
            sheets.append(ChannelSheet("rudder", "rad", -limit, limit))
        return tuple(sheets)
