"""Where an episode starts, and what of it `reset`'s options fix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number, unit_quaternion
from dq_marine.errors import InvalidInputError

START_OPTIONS = ("position", "quaternion", "velocity", "current", "goal_position", "goal_quaternion")
"""Keys of `reset`'s options, in NED and SI units; what is not given is drawn."""


class Start(NamedTuple):
    """Position in NED (3,) [m], attitude body to NED (4,), velocity over ground (6,) [m/s, rad/s]."""

    position_ned: NDArray[np.float64]
    quaternion_body_to_ned: NDArray[np.float64]
    velocity_body: NDArray[np.float64]


def checked_options(options: dict[str, Any] | None) -> dict[str, NDArray[np.float64]]:
    """Return `reset`'s options as arrays.

    Raises:
        InvalidInputError: a key is unknown or a value wrong.
    """
    if options is None:
        return {}
    unknown = sorted(set(options) - set(START_OPTIONS))
    if unknown:
        raise InvalidInputError(f"options has unknown keys {unknown}; it takes {list(START_OPTIONS)}")
    return {name: _checked(name, value) for name, value in options.items()}


def _checked(name: str, value: Any) -> NDArray[np.float64]:
    label = f"options[{name!r}]"
    if name.endswith("quaternion"):
        return unit_quaternion(label, value)
    return finite_array(label, value, 6 if name == "velocity" else 3)


def drawn_speed_and_fixed_current(current: float | Sequence[float]) -> tuple[float, NDArray[np.float64]]:
    """Return the largest speed to draw [m/s] and the fixed current in NED (3,); one of them is zero.

    Raises:
        InvalidInputError: neither a speed of 0 or more nor three finite numbers.
    """
    if np.ndim(current) > 0:
        return 0.0, finite_array("current", current, 3)
    speed = finite_number("current", current)
    if speed < 0.0:
        raise InvalidInputError(f"current = {speed:g} m/s; give a speed of 0 or more, or three components")
    return speed, np.zeros(3)
