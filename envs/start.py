"""Where an episode starts, and what of it `reset`'s options fix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number, unit_quaternion
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.beginning import Drawn
from dq_marine.kernel.spatial import Spatial, from_fossen, to_fossen
from dq_marine.kernel.task import Start

START_OPTIONS = ("position", "quaternion", "velocity", "current", "goal_position", "goal_quaternion")
"""Keys of `reset`'s options, in NED and SI units; what is not given is drawn."""


AT_ORIGIN = Drawn(
    Start((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))), (0.0, 0.0, 0.0)
)
"""At the world's origin, at rest in still water."""


def as_chosen(drawn: Drawn, chosen: dict[str, NDArray[np.float64]]) -> Drawn:
    """Return what was drawn, but for what was chosen."""
    drawn_start = {
        "position": drawn.start.position_ned,
        "quaternion": drawn.start.attitude,
        "velocity": to_fossen(drawn.start.velocity),
        "current": drawn.current_ned,
    }
    values: dict[str, Any] = {
        name: tuple(chosen[name].tolist()) if name in chosen else value for name, value in drawn_start.items()
    }
    start = Start(values["position"], values["quaternion"], from_fossen(values["velocity"]))
    return Drawn(start, values["current"])


def checked_options(options: dict[str, Any] | None, *, water_moves: bool) -> dict[str, NDArray[np.float64]]:
    """Return `reset`'s options as arrays.

    Args:
        options: as they came.
        water_moves: whether the environment was made for a current.

    Raises:
        InvalidInputError: a key is unknown or a value wrong, or there can be no current.
    """
    if options is None:
        return {}
    unknown = sorted(set(options) - set(START_OPTIONS))
    if unknown:
        raise InvalidInputError(f"options has unknown keys {unknown}; it takes {list(START_OPTIONS)}")
    chosen = {name: _checked(name, value) for name, value in options.items()}
    current = chosen.get("current")
    if current is not None and current.any() and not water_moves:
        raise InvalidInputError(
            f"options['current'] = {current.tolist()}, but the environment was made without a current; make it with "
            "current=<largest speed>"
        )
    return chosen


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
