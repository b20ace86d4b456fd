"""What an environment does with the current that it is made with."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number
from dq_marine.currents import (
    CurrentLike,
    CurrentProfile,
    GaussMarkovCurrent,
    UniformCurrent,
    varying_current,
)
from dq_marine.engines.packing import unpack
from dq_marine.envs.episode import Episode
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.current import STILL_WATER, CurrentDraw
from dq_marine.kernel.step import StepParameters, in_water
from dq_marine.scene import Scene
from dq_marine.terms import vector3

EnvironmentCurrent: TypeAlias = float | CurrentLike
"""What an environment takes for its current."""


def drawn_current(current: EnvironmentCurrent) -> tuple[CurrentLike, CurrentDraw]:
    """Return what a scene takes for the largest current that an environment draws, and what it draws from.

    Raises:
        InvalidInputError: neither a speed of 0 or more, nor three finite numbers, nor a current that varies.
    """
    varying = varying_current(current)
    if isinstance(varying, GaussMarkovCurrent):
        return varying, CurrentDraw(varying.mean, varying.standard_deviation)
    if varying is not None:
        return varying, CurrentDraw((0.0, 0.0, 0.0), 0.0)
    if np.ndim(current) > 0:  # type: ignore[arg-type]
        fixed = finite_array("current", current, 3)  # type: ignore[arg-type]
        return fixed, CurrentDraw(vector3(fixed), 0.0)
    speed = finite_number("current", current)
    if speed < 0.0:
        raise InvalidInputError(f"current = {speed:g} m/s; give a speed of 0 or more, or three components")
    return (speed, 0.0, 0.0), CurrentDraw((0.0, 0.0, 0.0), speed)


def numbers_of(scene: Scene, period: float) -> StepParameters:
    """Return the numbers of the scene's step, with a current that changes by itself in control periods [s]."""
    parameters = scene.parameters_at(scene.step)
    if not isinstance(scene.current, GaussMarkovCurrent):
        return parameters
    return in_water(parameters, parameters.water._replace(process=scene.current.process(period)))


def current_met(scene: Scene, like: StepParameters, episode: Episode) -> NDArray[np.float64]:
    """Return the velocity of the water where the vehicle is now, in NED [m/s], shape (3,).

    Args:
        scene: of the episode.
        like: parameters of its step, with any numbers.
        episode: in progress.
    """
    if isinstance(scene.current, UniformCurrent):
        return episode.current_ned
    water: Any = unpack(like, episode.parameters).water
    return np.array(scene.composition.water.velocity(water, episode.body.pose))


def check_current(chosen: dict[str, NDArray[np.float64]], scene: Scene) -> dict[str, NDArray[np.float64]]:
    """Return the options of `reset`, unless there is a current among them that the environment cannot have.

    Raises:
        InvalidInputError: it has none, or a profile.
    """
    if "current" not in chosen:
        return chosen
    current = chosen["current"]
    if isinstance(scene.current, CurrentProfile):
        raise InvalidInputError(
            f"options['current'] = {current.tolist()}, but the environment has a current profile, the same in every "
            "episode; leave it out"
        )
    if current.any() and scene.composition.water == STILL_WATER:
        raise InvalidInputError(
            f"options['current'] = {current.tolist()}, but the environment was made without a current; make "
            "it with current=<largest speed>"
        )
    return chosen
