"""Where a body is at the end of a motion, and how far that is from where it should be."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class EndState(NamedTuple):
    """A body at one time.

    Attributes:
        position: in NED [m], shape (3,).
        quaternion: body to NED, scalar first, of unit length, shape (4,).
        velocity: over ground, body frame, Fossen's order [m/s, rad/s], shape (6,).
    """

    position: Array
    quaternion: Array
    velocity: Array


class Errors(NamedTuple):
    """How far a body is from where it should be: [m], [rad], and the norm of all six velocities' [m/s, rad/s]."""

    position: float
    attitude: float
    velocity: float


def end_of(body: Any) -> EndState:
    """Return where a `OneBody` is."""
    return EndState(body.position_ned, body.quaternion_body_to_ned, body.velocity_body)


def errors(end: EndState, reference: EndState) -> Errors:
    """Return the errors of an end state; the angle is precise down to round-off. NaN for what is not finite."""
    p, q = end.quaternion, reference.quaternion
    p = p if p @ q >= 0.0 else -p
    return Errors(
        float(np.linalg.norm(end.position - reference.position)),
        float(4.0 * np.arctan2(np.linalg.norm(p - q), np.linalg.norm(p + q))),
        float(np.linalg.norm(end.velocity - reference.velocity)),
    )
