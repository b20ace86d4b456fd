"""The acceleration of gravity that a scene may have."""

from __future__ import annotations

from typing import Any

from dq_marine.checks import finite_number
from dq_marine.errors import InvalidInputError

LEAST_GRAVITY, MOST_GRAVITY = 0.1, 30.0
"""Of any water that one may sail [m/s^2]: the lakes of Titan have 1.35, Earth 9.76 to 9.84, Jupiter 24.8."""


def checked_gravity(value: Any) -> float:
    """Return an acceleration of gravity [m/s^2] as a float.

    Raises:
        InvalidInputError: it is no number from `LEAST_GRAVITY` to `MOST_GRAVITY`.
    """
    gravity = finite_number("gravity", value)
    if not LEAST_GRAVITY <= gravity <= MOST_GRAVITY:
        raise InvalidInputError(
            f"gravity = {gravity:g} m/s^2; give {LEAST_GRAVITY:g} to {MOST_GRAVITY:g}, such as 9.80665"
        )
    return gravity
