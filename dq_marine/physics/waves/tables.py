"""Checks of tables by frequency, as transfer functions, radiation and drift coefficients are."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError


def check_rising(name: str, values: NDArray[Any]) -> None:
    """Check a list of finite numbers that rise.

    Raises:
        InvalidInputError: it is something else.
    """
    if np.ndim(values) != 1 or not np.size(values):
        raise InvalidInputError(
            f"{name} must be a list of at least one number, not of shape {np.shape(values)}"
        )
    _check_finite(name, values)
    if np.any(np.diff(values) <= 0.0):
        raise InvalidInputError(f"{name} must be a list of numbers that rise")


def check_table(name: str, values: NDArray[Any], shape: tuple[int, ...]) -> None:
    """Check an array of finite numbers of a shape.

    Raises:
        InvalidInputError: it is something else.
    """
    if np.shape(values) != shape:
        raise InvalidInputError(f"{name} has shape {np.shape(values)}; give shape {shape}")
    _check_finite(name, values)


def _check_finite(name: str, values: NDArray[Any]) -> None:
    if not np.isfinite(values).all():
        raise InvalidInputError(f"{name} has a NaN or an infinity; give finite numbers")
