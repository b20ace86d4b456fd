"""What an environment does with the current that it is made with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import subtract
from dq_marine.backend.packing import pack
from dq_marine.checks import finite_array
from dq_marine.envs.core.episode import Episode
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import BODY_NUMBERS
from dq_marine.integrator.inertia import momentum_from_twist
from dq_marine.integrator.step import StepParameters, in_water, make_motion
from dq_marine.physics.current.build import CurrentProfile, GaussMarkovCurrent, check_speed
from dq_marine.physics.current.formulas.uniform import (
    MOVING_WATER,
    STILL_WATER,
    current_twist,
    uniform_flow,
)
from dq_marine.simulation.scene import Scene


def numbers_of(scene: Scene) -> StepParameters:
    """Return the numbers of the scene's step, with a current that changes by itself in control periods."""
    parameters = scene.parameters_at(scene.step)
    if not isinstance(scene.current, GaussMarkovCurrent):
        return parameters
    process = scene.current.process(scene.settings.control_period)
    return in_water(parameters, parameters.water._replace(process=process))


def turn_current(
    episode: Episode, scene: Scene, parameters: StepParameters, current_ned: Sequence[float]
) -> None:
    """Let an episode's water move otherwise, and the vehicle keep its velocity over ground.

    Its momentum is that relative to the water, so it changes by M times the change of the water's velocity.

    Args:
        episode: whose water it is.
        scene: of its environment.
        parameters: of its step.
        current_ned: velocity of the water [m/s], shape (3,).

    Raises:
        InvalidInputError: the water is too fast, or cannot be told how to move; nothing is changed.
    """
    current = finite_array("current_ned", current_ned, 3)
    check_speed("current_ned", current)
    if scene.composition.water != MOVING_WATER:
        raise InvalidInputError(
            f"current_ned = {current.tolist()}, but the water of this environment is still, or moves by itself; make "
            "it with current=<largest speed>"
        )
    body = episode.body
    ground = make_motion(scene.composition)(parameters, body).velocity
    turned = in_water(parameters, uniform_flow(parameters.water, tuple(current.tolist())))
    flow = current_twist(turned.water, body.pose)
    relative = Spatial(subtract(ground.angular, flow.angular), subtract(ground.linear, flow.linear))
    momentum = momentum_from_twist(turned.inertia, relative)
    episode.parameters = pack(turned)
    episode.state[: BODY_NUMBERS - 1] = pack(body._replace(momentum=momentum))
    episode.report[-3:] = current


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
