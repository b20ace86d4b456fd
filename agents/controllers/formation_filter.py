"""Where a vehicle is in its formation, by an extended Kalman filter on what its acoustic modem hears.

The state is the place q of the vehicle, seen from the leader, in north and east, the formation's course chi and how
fast it turns, the leader's speed U, depth z and sinking w:

    dq/dt = v - U e(chi),    dchi/dt = turning,    dz/dt = w,                                            (1)

with one's own velocity v over ground. Speed, turning and sinking change at random; depth stays as it was at the start
as long as nobody tells of it, because ranges hardly do. A packet tells of the time at which it was sent: what is
expected of it follows from the state of now, moved back by its age.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NORTH, EAST, COURSE, TURNING, SPEED, DEPTH, SINKING = range(7)

TELLS_DEPTH = 3
"""Place of the depth among what a packet gives."""

RANGE_ERROR, DEPTH_ERROR, SPEED_ERROR = 0.3, 0.05, 0.02
"""Standard deviations of what packets give: range [m], depth [m], and each component of the velocity [m/s]."""

POSITION_ERROR = 10.0
"""Of a place that two navigations tell [m]. Their errors last from packet to packet, so each counts for little."""

OWN_VELOCITY_ERROR = 0.03
"""Of one's own velocity, as a random walk [m/sqrt(s)]."""

START = (0.2, 0.2, 0.2, 0.02, 0.02, 0.1, 0.01)
"""Standard deviations of the first state: q [spacings], chi [rad], turning [U/spacing], U [U], z [m], w [U]."""

CHANGE = (0.0, 0.0, 0.0, 0.06, 0.003, 0.0, 0.05)
"""Of what changes at random, in the time in which the leader goes a spacing, in the same units."""

DIFFERENCE = 1e-5
"""Step of the differences that stand for derivatives."""


class Packet(NamedTuple):
    """A packet as it is understood.

    Attributes:
        place: of the sender in the formation, ahead and to starboard of the leader [m].
        age: time since it was sent [s].
        measured: range [m]; sender's velocity in north and east [m/s] and depth [m]; place, seen from the receiver [m].
        told: which of these six numbers it gives.
    """

    place: tuple[float, float]
    age: float
    measured: Array
    told: Array


class FormationFilter:
    """The filter, with what is known of it now."""

    def __init__(self, place: tuple[float, float], spacing: float, speed: float, course: float) -> None:
        """Begin about one's own place, on a course that is about that of the formation.

        Args:
            place: one's own, ahead and to starboard of the leader [m].
            spacing: of the formation [m].
            speed: of the leader, as planned [m/s].
            course: one's own [rad].
        """
        rate = speed / spacing
        units = np.array([spacing, spacing, 1.0, rate, speed, 1.0, speed])
        self.state = np.array([*turned(place, course), course, 0.0, speed, 0.0, 0.0])
        # Another course would turn the vehicle's place about the leader.
        along = np.eye(7)
        along[NORTH, COURSE], along[EAST, COURSE] = -self.state[EAST], self.state[NORTH]
        self._start, self._change = (np.array(START) * units) ** 2, (np.array(CHANGE) * units) ** 2 * rate
        self._change[:2] += OWN_VELOCITY_ERROR**2
        self._dives = np.where(np.arange(7) < DEPTH, 1.0, 0.0)
        self.covariance = along @ np.diag(self._dives * self._start) @ along.T

    def predict(self, velocity: tuple[float, float], period: float) -> None:
        """Go on for a while [s], with one's own velocity in north and east [m/s]."""
        course, speed = self.state[COURSE], self.state[SPEED]
        cosine, sine = math.cos(course), math.sin(course)
        move = np.eye(7)
        move[NORTH, COURSE], move[EAST, COURSE] = period * speed * sine, -period * speed * cosine
        move[NORTH, SPEED], move[EAST, SPEED] = -period * cosine, -period * sine
        move[COURSE, TURNING] = move[DEPTH, SINKING] = period
        self.state = self.state + period * np.array(
            [
                velocity[0] - speed * cosine,
                velocity[1] - speed * sine,
                self.state[TURNING],
                0.0,
                0.0,
                self.state[SINKING],
                0.0,
            ]
        )
        self.covariance = move @ self.covariance @ move.T + period * np.diag(self._dives * self._change)

    def update(self, packet: Packet, velocity: tuple[float, float], depth: float) -> None:
        """Take a packet into account.

        Args:
            packet: that has just been understood.
            velocity: one's own in north and east [m/s].
            depth: one's own [m].
        """
        told, state = packet.told, self.state
        if told[TELLS_DEPTH] and not self._dives[DEPTH]:
            self.covariance += np.diag((1.0 - self._dives) * self._start)
            self._dives = np.ones(7)
        expected = expected_packet(state, packet, velocity, depth)
        columns = [
            (expected_packet(state + step, packet, velocity, depth) - expected) / DIFFERENCE
            for step in DIFFERENCE * np.eye(7)
        ]
        slope = np.stack(columns, axis=1)[told]
        noise = np.diag(
            np.array([RANGE_ERROR, *[SPEED_ERROR] * 2, DEPTH_ERROR, *[POSITION_ERROR] * 2])[told] ** 2
        )
        gain = np.linalg.solve(slope @ self.covariance @ slope.T + noise, slope @ self.covariance).T
        self.state = state + gain @ (packet.measured - expected)[told]
        kept = np.eye(7) - gain @ slope
        # Joseph's form stays positive definite under rounding.
        self.covariance = kept @ self.covariance @ kept.T + gain @ noise @ gain.T


def expected_packet(state: Array, packet: Packet, velocity: tuple[float, float], depth: float) -> Array:
    """Return what a packet of a sender and an age would give: the six numbers of `Packet.measured`."""
    north, east, course, turning, speed, leader_depth, sinking = state.tolist()
    age, (ahead, starboard) = packet.age, packet.place
    then, midway = course - age * turning, course - 0.5 * age * turning
    off_north, off_east = turned(packet.place, then)
    sender_north = off_north - age * speed * math.cos(midway) - north
    sender_east = off_east - age * speed * math.sin(midway) - east
    below = leader_depth - age * sinking
    level = math.hypot(sender_north + age * velocity[0], sender_east + age * velocity[1])
    swung = turned((speed - turning * starboard, turning * ahead), then)
    return np.array([math.hypot(level, below - depth), *swung, below, sender_north, sender_east])


def turned(vector: tuple[float, float], angle: float) -> tuple[float, float]:
    """Return a level vector along a course, as north and east; or with minus the angle, the other way."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return (cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1])
