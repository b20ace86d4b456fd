"""What a state that comes in from outside must be: a pose, and numbers that can still be computed with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import length_of
from dq_marine.errors import InvalidInputError

LARGEST_NUMBER = 1e100
"""Of a state: the products that a step is made of stay far from the largest double."""

TOLERANCE = 1e-6
"""By which a pose may miss its two constraints; single precision needs 1e-7."""


def check_states(name: str, states: NDArray[np.float64]) -> None:
    """Check packed states of bodies, shape (14,) or a row each, whose numbers passed `check_size`.

    A state is a pose, its real part before its dual part, and a momentum.

    Raises:
        InvalidInputError: the real part is no unit quaternion, or the dual part is not orthogonal to it.
    """
    columns = np.atleast_2d(states).T
    real, dual = columns[:4], columns[4:8]
    lengths = length_of(real)
    bad = np.flatnonzero(np.abs(lengths - 1.0) > TOLERANCE)
    if bad.size:
        raise InvalidInputError(
            f"the attitude in {name} is not a unit quaternion, its length is {lengths[bad[0]]:.9g}; pass what "
            "get_state() returned"
        )
    across = np.abs((real * dual).sum(axis=0))
    bad = np.flatnonzero(across > TOLERANCE * (1.0 + length_of(dual)))
    if bad.size:
        raise InvalidInputError(
            f"the pose in {name} is not a unit dual quaternion: its parts' product is {across[bad[0]]:.3g}, not 0; "
            "pass what get_state() returned"
        )


def check_size(name: str, numbers: NDArray[np.float64]) -> None:
    """Check that no number is beyond `LARGEST_NUMBER`.

    Raises:
        InvalidInputError: one is.
    """
    largest = np.abs(numbers).max(initial=0.0)
    if largest > LARGEST_NUMBER:
        raise InvalidInputError(f"{name} has a number of size {largest:.3g}; give at most {LARGEST_NUMBER:g}")
