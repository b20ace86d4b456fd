"""States that segments start from: guessed from what was measured, then fitted with the vehicle's numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dq_marine.identification.lanes import Start
from dq_marine.identification.log import Log

Array = NDArray[np.float64]

WINDOW = 5
"""Rows to either side that a velocity is smoothed over."""

AXES = 12
"""Of a start: position in NED, small rotation in the body frame, velocity."""


def product(left: Array, right: Array) -> Array:
    """Return products of quaternions, scalar first, shape (..., 4)."""
    a, u, b, v = left[..., :1], left[..., 1:], right[..., :1], right[..., 1:]
    scalar = a * b - np.sum(u * v, axis=-1, keepdims=True)
    return np.concatenate([scalar, a * v + b * u + np.cross(u, v)], axis=-1)


def rotation_between(start: Array, end: Array) -> Array:
    """Return the rotation vectors from attitudes to others, in the body frame of the first [rad], shape (..., 3)."""
    turn = product(start * np.array([1.0, -1.0, -1.0, -1.0]), end)
    turn = np.where(turn[..., :1] < 0.0, -turn, turn)
    sine = np.linalg.norm(turn[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, turn[..., :1])
    return np.asarray(turn[..., 1:] * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2.0))


def moved(start: Start, change: Array) -> Start:
    """Return starts moved by changes, shape (n, 12) or (12,): position, rotation vector, velocity."""
    change = np.broadcast_to(change, (len(start.position_ned), AXES))
    angle = np.linalg.norm(change[:, 3:6], axis=1, keepdims=True)
    half = 0.5 * np.sinc(angle / (2.0 * np.pi)) * change[:, 3:6]
    turned = product(start.quaternion_body_to_ned, np.hstack([np.cos(0.5 * angle), half]))
    return Start(
        start.position_ned + change[:, :3],
        turned / np.linalg.norm(turned, axis=1, keepdims=True),
        start.velocity_body + change[:, 6:],
    )


def measured_starts(log: Log, rows: NDArray[np.intp], depth: float) -> Start:
    """Return the states at rows of a log.

    Args:
        log: in which they were measured.
        rows: where segments start.
        depth: of the body origin where none was measured [m].
    """
    position = np.stack([_nearest(log.position_ned, row) for row in rows])
    position = np.where(np.isnan(position), [0.0, 0.0, depth], position)
    attitude = np.stack([_nearest(log.quaternion_body_to_ned, row) for row in rows])
    velocity = np.stack([_smoothed(log.velocity_body, row) for row in rows])
    turning = np.stack([_turning(log, row) for row in rows])
    velocity[:, 3:] = np.where(np.isnan(velocity[:, 3:]), turning, velocity[:, 3:])
    return Start(position, attitude, velocity)


def _nearest(values: Array, row: int) -> Array:
    """Return the reading of each column that is nearest to a row; NaN where a column has none."""
    distance = np.abs(np.arange(len(values)) - row).astype(np.float64)
    places = np.where(np.isnan(values), np.inf, distance[:, None]).argmin(axis=0)
    return np.asarray(values[places, np.arange(values.shape[1])])


def _smoothed(values: Array, row: int) -> Array:
    """Return each column at a row, from a straight line through the readings around it; NaN if there are none."""
    first = max(0, row - WINDOW)
    around = values[first : row + WINDOW + 1]
    result = np.full(values.shape[1], np.nan)
    for index, column in enumerate(around.T):
        there = np.flatnonzero(~np.isnan(column))
        if there.size > 2:
            result[index] = np.polynomial.Polynomial.fit(there, column[there], 1)(row - first)
        elif not np.isnan(values[:, index]).all():
            result[index] = _nearest(values[:, index : index + 1], row)[0]
    return result


def _turning(log: Log, row: int) -> Array:
    """Return the angular velocity that the attitudes around a row have [rad/s]."""
    there = np.flatnonzero(~np.isnan(log.quaternion_body_to_ned).any(axis=1))
    place = int(np.abs(there - row).argmin())
    before, after = there[max(0, place - WINDOW)], there[min(len(there) - 1, place + WINDOW)]
    turn = rotation_between(log.quaternion_body_to_ned[before], log.quaternion_body_to_ned[after])
    return np.asarray(turn / (log.time[after] - log.time[before]))
