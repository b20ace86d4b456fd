"""An autopilot: speed, heading and depth rate or pitch, as a wrench on the axes that are driven.

Each axis is a rate loop with integral, and angles have a proportional loop round it:

    r_c = r_d + k_a e,        tau = M_ii (k_r (r_c - r) + z),        dz/dt = k_i k_r (r_c - r)            (1)

with k_r, k_a and k_i as shares of a bandwidth w, by the preset, at which an error of a tenth of a radian asks for the
whole moment: mass matrix and limits are the gains. Speed has the loop with the drag at the wanted speed fed
forward. Where heave is driven, depth is kept by heave, with the bow level; else by pitch.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.guidance import level_angles, levelled, wrapped
from dq_marine.agents.controllers.rotation import crossed
from dq_marine.agents.controllers.wrench_mapping import WRENCH_MAPPINGS
from dq_marine.agents.settings import AutopilotSettings
from dq_marine.checks import one_of
from dq_marine.envs.core.marine_env import Action
from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.analysis.sheet import drag_of, terminal_speed

Array = NDArray[np.float64]

SURGE, HEAVE, ROLL, PITCH, YAW = 0, 2, 3, 4, 5


class Attitude(NamedTuple):
    """What an autopilot sees of a vehicle: roll and pitch [rad], velocity over ground as if it were level [m/s]."""

    roll: float
    pitch: float
    velocity_level: tuple[float, float, float]
    velocity_body: Array
    down_body: Array

    @property
    def speed(self) -> float:
        """Over ground, and less than 0 astern [m/s]."""
        return math.copysign(float(np.linalg.norm(self.velocity_level)), self.velocity_level[0])

    @property
    def drift_angle(self) -> float:
        """From the bow to the course over ground [rad]; 0 for a vehicle that hardly moves ahead."""
        ahead, starboard, _ = self.velocity_level
        return math.atan2(starboard, ahead) if ahead > 0.0 else 0.0

    @property
    def attack_angle(self) -> float:
        """From the way over ground up to the bow [rad], in the vertical plane: pitch less the climb."""
        ahead, _, down = self.velocity_level
        return self.pitch - math.atan2(-down, ahead) if ahead > 0.0 else 0.0


class Order(NamedTuple):
    """What an autopilot is to do: speed error [m/s] and speed, angles [rad] and a rate [rad/s] in the level frame.

    Attributes:
        speed: wanted, along the bow [m/s].
        speed_error: wanted speed less that of now.
        heading_error: to be turned to starboard by.
        turn_rate: of the wanted heading.
        climb: wanted angle of the way over ground, up.
    """

    speed: float
    speed_error: float
    heading_error: float
    turn_rate: float
    climb: float


def seen(parts: dict[str, Array]) -> Attitude:
    """Return the attitude that parts of an observation tell of."""
    down, linear, angular = (
        parts[name] for name in ("down_body", "linear_velocity_body", "angular_velocity_body")
    )
    roll, pitch = level_angles(tuple(down.tolist()))
    level = levelled(tuple(linear.tolist()), roll, pitch)
    return Attitude(roll, pitch, level, np.concatenate([linear, angular]), down)


class RateLoop:
    """The inner loop of (1), for one axis."""

    def __init__(
        self, inertia: float, limit: float, gain: float, integral_rate: float, period: float
    ) -> None:
        """Take M_ii, the wrench's limit, k_r [1/s], k_i [1/s] and the time between calls [s]."""
        self._inertia, self._limit, self._gain = inertia, limit, gain
        self._integral_rate, self._period = integral_rate, period
        self._integral = 0.0

    def reset(self) -> None:
        """Forget z."""
        self._integral = 0.0

    def force(self, error: float, ahead: float = 0.0) -> float:
        """Return tau for an error of the rate, with what is fed forward, and advance z where that is of use."""
        if self._limit == 0.0:
            return 0.0
        wanted = self._inertia * (self._gain * error + self._integral) + ahead
        if abs(wanted) < self._limit or wanted * error < 0.0:
            self._integral += self._period * self._integral_rate * self._gain * error
        return max(-self._limit, min(self._limit, wanted))


class Autopilot:
    """Speed, heading and climb of a vehicle."""

    def __init__(self, vehicle: Vehicle, period: float, actuation: str, settings: AutopilotSettings) -> None:
        """Derive the gains; see the module.

        Raises:
            InvalidInputError: thrusters are to be driven, and the vehicle has none whose force is known.
        """
        self.settings, self.period = settings, period
        self.length = vehicle.dimensions.length
        self.top_speed = terminal_speed(vehicle, SURGE)
        self._mapping = WRENCH_MAPPINGS[one_of("actuation", actuation, WRENCH_MAPPINGS)](vehicle)
        self._limits = vehicle.wrench_limits
        self._drag, self._turning_drag = drag_of(vehicle, SURGE), drag_of(vehicle, YAW)
        floats = vehicle.hydrostatics is not None
        self._net_weight = 0.0 if floats else vehicle.weight - vehicle.buoyant_force
        self._arm = np.zeros(3) if floats else vehicle.restoring_arm
        inertia = np.diag(vehicle.mass_matrix)
        self._mass = float(inertia[SURGE])
        self._bandwidths = [self._bandwidth(float(inertia[i]), float(self._limits[i]), i) for i in range(6)]
        self._loops = [
            RateLoop(
                float(inertia[i]),
                float(self._limits[i]),
                settings.rate_gain * self._bandwidths[i],
                settings.integral_rate * self._bandwidths[i],
                period,
            )
            for i in range(6)
        ]
        self._fastest_rates = [terminal_speed(vehicle, i) for i in range(6)]
        self.dives = bool(not floats and (self._limits[HEAVE] or self._limits[PITCH]))
        self.by_heave = bool(not floats and self._limits[HEAVE])

    def angle_gain(self, axis: int) -> float:
        """Return k_a of an axis [1/s]: only large angles ask for the fastest rate that damping allows."""
        return min(
            self.settings.angle_gain * self._bandwidths[axis],
            self._fastest_rates[axis] / self.settings.angle_of_fastest_rate,
        )

    def look_ahead(self, speed: float, axis: int) -> float:
        """Return the look-ahead distance at a speed [m], for guidance by an axis."""
        least = self.settings.shortest_look_ahead * self.length
        return max(least, self.settings.look_ahead_time * speed / self.angle_gain(axis))

    def turning_radius(self, speed: float) -> float:
        """Return the radius [m] of the tightest turn at a speed that is asked for, or that damping of yaw allows."""
        return speed / min(self._fastest_turn(speed), self._fastest_rates[YAW])

    def stopping_distance(self, speed: float) -> float:
        """Return the way [m] that full thrust astern takes to stop the vehicle at a speed, were there no drag."""
        return self._mass * speed**2 / (2.0 * float(self._limits[SURGE]))

    def braking(self, speed: float) -> float:
        """Return how fast full thrust astern and drag slow the vehicle down at a speed [m/s^2]; 0 or less: not at all.

        There is such a vehicle: a model about a service speed, with the propeller in it, which goes on at a lower one.
        """
        return (float(self._limits[SURGE]) + self._drag(speed)) / self._mass

    def reset(self) -> None:
        """Forget all integrals."""
        for loop in self._loops:
            loop.reset()

    def act(self, attitude: Attitude, order: Order) -> Action:
        """Return the action in [-1, 1], shape (n,), and advance the integrals."""
        wrench = self.wrench(attitude, order)
        return self._mapping.give(wrench, float(attitude.velocity_body[0])).action.astype(np.float32)

    def wrench(self, attitude: Attitude, order: Order) -> Array:
        """Return the wrench wanted now, shape (6,) [N, N m]."""
        velocity, down = attitude.velocity_body, attitude.down_body
        held = -np.concatenate([self._net_weight * down, crossed(self._arm, down)])
        fastest = self._fastest_turn(order.speed)
        turn = order.turn_rate + self.angle_gain(YAW) * wrapped(order.heading_error)
        turn = max(-fastest, min(fastest, turn))
        steepest = self.settings.steepest_pitch
        if self.by_heave:
            pitch, sink = 0.0, -order.speed * math.sin(order.climb) - attitude.velocity_level[2]
        else:
            pitch, sink = max(-steepest, min(steepest, order.climb + attitude.attack_angle)), 0.0
        # Rates of roll, pitch and heading to those about the body's axes (Fossen 2021, eq. 2.28).
        tilt = self.angle_gain(PITCH) * (pitch - attitude.pitch)
        q = math.cos(attitude.roll) * tilt + math.sin(attitude.roll) * math.cos(attitude.pitch) * turn
        r = math.cos(attitude.roll) * math.cos(attitude.pitch) * turn - math.sin(attitude.roll) * tilt
        p = -self.angle_gain(ROLL) * attitude.roll - math.sin(attitude.pitch) * turn
        errors = [order.speed_error, 0.0, sink, p - velocity[3], q - velocity[4], r - velocity[5]]
        ahead = [self._drag(max(0.0, order.speed)), 0.0, *held[2:5].tolist(), self._against_turning(turn)]
        return np.array([self._loops[i].force(float(errors[i]), ahead[i]) for i in range(6)])

    def _fastest_turn(self, speed: float) -> float:
        """Return the largest turn rate that is asked for at a speed [rad/s]."""
        rate = max(speed, 0.3 * self.top_speed) / (self.settings.tightest_turn * self.length)
        share = self.settings.share_of_fastest_turn
        return rate if share is None else min(rate, share * self._fastest_rates[YAW])

    def _against_turning(self, turn: float) -> float:
        """Return the moment that damping takes at a turn rate, half of the limit at most [N m]."""
        return math.copysign(min(self._turning_drag(abs(turn)), 0.5 * float(self._limits[YAW])), turn)

    def _bandwidth(self, inertia: float, limit: float, axis: int) -> float:
        """Return w [1/s]: 0 for an axis that nothing drives."""
        settings = self.settings
        cap = settings.fastest_loop / (self.period * settings.rate_gain)
        if axis < ROLL:
            reach = settings.saturating_share * self.top_speed
            return min(cap, limit / inertia / reach / settings.rate_gain)
        return min(cap, math.sqrt(limit / inertia / settings.saturating_angle))
