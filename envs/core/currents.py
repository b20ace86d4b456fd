"""What an environment does with the current that it is made with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.integrator.step import StepParameters, in_water
from dq_marine.physics.current.build import CurrentProfile, GaussMarkovCurrent, check_speed
from dq_marine.physics.current.formulas.uniform import STILL_WATER
from dq_marine.simulation.scene import Scene


def numbers_of(scene: Scene) -> StepParameters:
    """Return the numbers of the scene's step, with a current that changes by itself in control periods."""
    parameters = scene.parameters_at(scene.step)
    if not isinstance(scene.current, GaussMarkovCurrent):
        return parameters
    process = scene.current.process(scene.settings.control_period)
    return in_water(parameters, parameters.water._replace(process=process))


def check_current(chosen: dict[str, NDArray[np.float64]], scene: Scene) -> dict[str, NDArray[np.float64]]:
    """Return the options of `reset`, unless there is a current among them that the environment cannot have.

    Raises:
        InvalidInputError: the water is faster than any, or the environment has no current, or a profile.
    """
    if "current" not in chosen:
        return chosen
    current = chosen["current"]
    check_speed("options['current']", current)
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
