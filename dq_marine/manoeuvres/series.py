"""The record of a manoeuvre: time series of pose, velocity and commands, with what follows from them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.attitude import attitude_angles

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Series:
    """Samples of a run, equally spaced; the manoeuvre begins at time 0, what comes before is its approach.

    Attributes:
        time: [s], shape (n,).
        position_ned: of the body origin [m], shape (n, 3).
        quaternion_body_to_ned: scalar first, shape (n, 4).
        velocity_body: [u, v, w, p, q, r] [m/s, rad/s], shape (n, 6).
        throttle: commanded from the sample on, -1 to 1, shape (n,).
        helm: likewise, positive to starboard.
    """

    time: Array
    position_ned: Array
    quaternion_body_to_ned: Array
    velocity_body: Array
    throttle: Array
    helm: Array

    @cached_property
    def euler(self) -> Array:
        """Roll, pitch and heading (zyx) [rad], the heading continuous, shape (n, 3)."""
        return euler_angles(self.quaternion_body_to_ned)

    @property
    def heading(self) -> Array:
        """Direction of the bow in the horizontal plane from north over east, continuous [rad], shape (n,)."""
        return self.euler[:, 2]

    @property
    def heading_change(self) -> Array:
        """Heading since time 0 [rad], shape (n,)."""
        heading = self.heading
        return np.asarray(heading - np.interp(0.0, self.time, heading))

    @cached_property
    def velocity_ned(self) -> Array:
        """Velocity of the body origin [m/s], shape (n, 3)."""
        return rotated(self.quaternion_body_to_ned, self.velocity_body[:, :3])

    @property
    def speed(self) -> Array:
        """Speed in the horizontal plane [m/s], shape (n,)."""
        return np.asarray(np.hypot(*self.velocity_ned[:, :2].T))

    @property
    def drift_angle(self) -> Array:
        """Heading less course, in -pi to pi: positive where the bow points to starboard of the course [rad]."""
        north, east = self.velocity_ned[:, :2].T
        return wrapped(self.heading - np.arctan2(east, north))

    @property
    def distance(self) -> Array:
        """Way along the horizontal track since time 0 [m], shape (n,)."""
        steps = np.hypot(*np.diff(self.position_ned[:, :2], axis=0).T)
        way = np.concatenate([[0.0], np.cumsum(steps)])
        return np.asarray(way - np.interp(0.0, self.time, way))

    def along_and_across(self) -> Array:
        """Return the track from its point at time 0, ahead and to starboard of the heading then [m], shape (n, 2)."""
        heading = float(np.interp(0.0, self.time, self.heading))
        origin = [np.interp(0.0, self.time, self.position_ned[:, axis]) for axis in (0, 1)]
        north, east = (self.position_ned[:, :2] - origin).T
        cosine, sine = np.cos(heading), np.sin(heading)
        return np.column_stack([cosine * north + sine * east, cosine * east - sine * north])

    def columns(self) -> dict[str, Array]:
        """Return everything by name, the unit at its end, each of shape (n,)."""
        roll, pitch, heading = np.degrees(self.euler).T
        names = {
            "position_ned": ("north_m", "east_m", "down_m"),
            "quaternion_body_to_ned": ("q_scalar", "q_x", "q_y", "q_z"),
            "velocity_body": ("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s"),
        }
        vectors = {
            name: column
            for field, columns in names.items()
            for name, column in zip(columns, getattr(self, field).T, strict=True)
        }
        angles = {"roll_deg": roll, "pitch_deg": pitch, "heading_deg": heading}
        return {"time_s": self.time} | vectors | angles | {"throttle": self.throttle, "helm": self.helm}


def euler_angles(quaternions: Array) -> Array:
    """Return roll, pitch and heading (zyx) of attitudes body to NED [rad], the heading continuous, shape (n, 3)."""
    angles = np.array([attitude_angles(quaternion) for quaternion in quaternions.tolist()])
    angles[:, 2] = np.unwrap(angles[:, 2])
    return angles


def rotated(quaternions: Array, vectors: Array) -> Array:
    """Return vectors turned by unit quaternions, row by row, shape (n, 3)."""
    scalar, axis = quaternions[:, :1], quaternions[:, 1:]
    twice = 2.0 * np.cross(axis, vectors)
    return np.asarray(vectors + scalar * twice + np.cross(axis, twice))


def wrapped(angle: Array) -> Array:
    """Return angles in -pi to pi [rad]."""
    return np.asarray(np.arctan2(np.sin(angle), np.cos(angle)))
