"""What controllers take from an observation: its parts by name, and the goal that they tell of."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.rotation import crossed, rotation_vector
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.observation import Observation
from dq_marine.errors import InvalidInputError

Array = NDArray[np.float64]

GOAL_POSE = (
    "goal_position_body",
    "goal_x_axis_body",
    "goal_y_axis_body",
    "linear_velocity_body",
    "angular_velocity_body",
)
"""Parts of an observation that tell of a goal pose and of the vehicle's own velocity."""

GOAL_MOTION = ("goal_velocity_body", "goal_turn_rate_body", "goal_acceleration_body")
"""Parts that tell how a goal moves: its velocity [m/s], turn rate [rad/s] and acceleration [m/s^2] over ground."""


class Reading(NamedTuple):
    """A goal pose as a controller sees it.

    Attributes:
        error_body: goal position [m] and rotation vector [rad] onto the goal's attitude, body frame, shape (6,).
        velocity_body: over ground, Fossen's order [m/s, rad/s], shape (6,).
        goal_to_body: rotation matrix, its columns the goal's axes, shape (3, 3).
        goal_velocity_body: of the goal over ground, Fossen's order, shape (6,).
        goal_acceleration_body: its rate of change as seen from the goal's turning frame, shape (6,).
    """

    error_body: Array
    velocity_body: Array
    goal_to_body: Array
    goal_velocity_body: Array = np.zeros(6)
    goal_acceleration_body: Array = np.zeros(6)


def shown_names(env: MarineEnv) -> tuple[str, ...]:
    """Return the names of the parts of an environment's observation, in its order."""
    return tuple(one.name for one in env.observations)


def shown_sizes(env: MarineEnv) -> dict[str, int]:
    """Return how many numbers each part of an environment's observation has."""
    return {one.name: one.size for one in env.observations}


def parts_reader(env: MarineEnv, names: Sequence[str]) -> Callable[[Observation], dict[str, Array]]:
    """Return what takes parts out of the observations of an environment: arrays of doubles by name.

    Raises:
        InvalidInputError: the environment does not show one of them.
    """
    shown = shown_names(env)
    lacking = [name for name in names if name not in shown]
    if lacking:
        raise InvalidInputError(
            f"the controller reads {', '.join(names)}, and {env.definition.id} does not show {', '.join(lacking)}; "
            "give it an environment whose observation has these parts"
        )
    shown_parts = (*env.observations, *env.privileged_observations)
    ends = np.cumsum([one.size for one in shown_parts]).tolist()
    places = {one.name: slice(end - one.size, end) for one, end in zip(shown_parts, ends, strict=True)}
    chosen = {name: places[name] for name in names}
    parts, size = env.observation_places, ends[-1]

    def read(observation: Observation) -> dict[str, Array]:
        flat = np.asarray(_flat(observation, parts, size), dtype=np.float64)
        return {name: flat[..., place] for name, place in chosen.items()}

    return read


def goal_reader(env: MarineEnv) -> Callable[[Observation], Reading]:
    """Return what reads goal poses, with the goals' motion where the environment shows it.

    Raises:
        InvalidInputError: it shows no goal pose.
    """
    moving = set(GOAL_MOTION) <= set(shown_names(env))
    read_parts = parts_reader(env, (*GOAL_POSE, *(GOAL_MOTION if moving else ())))

    def read(observation: Observation) -> Reading:
        parts = read_parts(observation)
        pose = goal_pose(*(parts[name] for name in GOAL_POSE))
        if not moving:
            return pose
        velocity, turn_rate, acceleration = (parts[name] for name in GOAL_MOTION)
        turning = crossed(turn_rate, velocity)  # components along turning axes change by themselves
        return pose._replace(
            goal_velocity_body=np.concatenate([velocity, turn_rate]),
            goal_acceleration_body=np.concatenate([acceleration - turning, np.zeros(3)]),
        )

    return read


def read_goal_pose(observation: Observation) -> Reading:
    """Return the goal pose of an observation that begins with the parts of `GOAL_POSE`, shape (18, or more)."""
    numbers = np.asarray(observation, dtype=np.float64)
    return goal_pose(numbers[:3], numbers[3:6], numbers[6:9], numbers[9:12], numbers[12:15])


def goal_pose(position: Array, x_axis: Array, y_axis: Array, linear: Array, angular: Array) -> Reading:
    """Return the goal pose that the parts `GOAL_POSE` tell of, each of shape (3,)."""
    goal_to_body = np.column_stack([x_axis, y_axis, crossed(x_axis, y_axis)])
    error = np.concatenate([position, rotation_vector(goal_to_body)])
    return Reading(error, np.concatenate([linear, angular]), goal_to_body)


def _flat(observation: Observation, parts: Mapping[str, NDArray[np.intp]] | None, size: int) -> Array:
    """Return the flat numbers of an observation, which may be a dictionary of parts."""
    if parts is None or not isinstance(observation, Mapping):
        return np.asarray(observation, dtype=np.float64)
    flat = np.empty(size)
    for name, own in parts.items():
        flat[own] = observation[name]
    return flat
