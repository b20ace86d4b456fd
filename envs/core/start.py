"""Where an episode starts, and what of it `reset`'s options fix."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.spatial import ZERO, from_fossen, to_fossen
from dq_marine.checks import finite_array, shown, unit_quaternion
from dq_marine.envs.core.places import goal_place, near_place
from dq_marine.errors import InvalidInputError
from dq_marine.task.protocol import Start
from dq_marine.task.start import Drawn

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

START_OPTIONS = {"position": 3, "quaternion": 4, "velocity": 6, "current": 3}
"""Options of `reset` that every task has, with their sizes, in NED and SI units; what is not given is drawn."""

GOAL_POSITION = "goal_position"
"""Option of tasks whose goal can be chosen: in NED [m], and checked to be in the water."""


def at_origin(task_draws: int, sensing_draws: int) -> Drawn:
    """Return a start at the world's origin, at rest in still water, with so many uniforms for task and sensors."""
    start = Start((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), ZERO)
    return Drawn(start, (0.0, 0.0, 0.0), (0.0,) * task_draws, (0.0,) * sensing_draws)


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
    return drawn._replace(start=start, current_ned=values["current"])


NO_UNIFORMS = np.zeros(0)
"""Of a control period in which nothing is drawn."""


def drawn_uniforms(
    random: np.random.Generator, count: int, action: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return uniform random numbers for a control period; none are drawn for an action that will be refused."""
    return random.random(count) if np.isfinite(action).all() else np.zeros(count)


def check_is_options(options: Any) -> None:
    """Refuse what is no dictionary, nor None.

    Raises:
        InvalidInputError: it is neither.
    """
    if options is not None and not isinstance(options, dict):
        raise InvalidInputError(f"options = {shown(options)}; give a dictionary, or None")


def checked_options(
    options: dict[str, Any] | None, own: Mapping[str, int], vehicle: Vehicle
) -> dict[str, NDArray[np.float64]]:
    """Return `reset`'s options as arrays.

    Args:
        options: as they came.
        own: the task's options, with their sizes.
        vehicle: which is to be there.

    Raises:
        InvalidInputError: a key is unknown or a value wrong.
    """
    check_is_options(options)
    if options is None:
        return {}
    sizes = {**START_OPTIONS, **own}
    unknown = sorted(shown(name) for name in options if name not in sizes)
    if unknown:
        raise InvalidInputError(f"options has unknown keys {unknown}; it takes {list(sizes)}")
    return {name: _checked(name, value, sizes[name], vehicle) for name, value in options.items()}


def _checked(name: str, value: Any, size: int, vehicle: Vehicle) -> NDArray[np.float64]:
    label = f"options[{name!r}]"
    if name.endswith("quaternion"):
        return unit_quaternion(label, value)
    if name == GOAL_POSITION:
        return goal_place(label, value, vehicle)
    if name == "position":
        return near_place(label, value)
    return finite_array(label, value, size)
