"""The helm: an agent that does what a person's hands say, and holds the rest if it is asked to."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.controllers.reading import Reading, goal_pose
from dq_marine.agents.controllers.wrench_mapping import WRENCH_MAPPINGS
from dq_marine.agents.environments import marine
from dq_marine.algebra.quaternion import rotation_matrix
from dq_marine.envs.core.marine_env import Action, MarineEnv
from dq_marine.envs.core.observation import Observation
from dq_marine.errors import InvalidInputError

Array = NDArray[np.float64]

MOVING = ((0, 1, 2), (3, 4, 5))
"""Axes of position and of attitude: while a hand moves one of them, where it is to be held moves along."""


class Helm:
    """Turns the positions of a stick into actions.

    Each axis gives its share of the vehicle's limit. With `hold`, the axes that no hand touches are those of dynamic
    positioning: the vehicle stays at the place and heading at which it was let go, level.

    Attributes:
        stick: positions in [-1, 1] in Fossen's order, shape (6,).
        power: share of the limits at a stick's end.
        hold: whether what is let go is held; only where `can_hold`.
        can_hold: whether dynamic positioning can be had at the environment's control period.
    """

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        """Take the environment that is to be flown.

        Raises:
            InvalidInputError: it is not one of this package.
            MissingDependencyError: thrusters are to be driven, and SciPy is not installed.
        """
        inner = marine(env)
        self.stick: Array = np.zeros(6)
        self.power = 1.0
        self._limits = inner.vehicle.wrench_limits
        self._mapping = WRENCH_MAPPINGS[inner.scene.actuation](inner.vehicle)
        self._env: MarineEnv = inner
        self._controller = _holding(inner)
        self.can_hold = self._controller is not None
        self.hold = self.can_hold
        self._place = (np.zeros(3), np.eye(3))
        self._touched = np.zeros(6, np.bool_)

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Begin to hold where the vehicle is."""
        self._env = marine(env)
        position, rotation = self._pose()
        self._place = (position, _levelled(rotation))
        self._touched = np.zeros(6, np.bool_)
        if self._controller is not None:
            self._controller.reset()

    def act(self, observation: Observation) -> Action:
        """Return the action for the stick's present position."""
        touched = self.stick != 0.0
        wanted = self.power * self.stick * self._limits
        if self.hold and self._controller is not None:
            wanted = self._controller.steered(self._reading(touched), np.where(touched, wanted, np.nan))
        surge_speed = float(self._env.velocity_body[0])
        return self._mapping.give(wanted, surge_speed).action.astype(np.float32)

    def _reading(self, touched: NDArray[np.bool_]) -> Reading:
        """Return where the vehicle is held, which moves along with it while it is moved by hand."""
        position, rotation = self._pose()
        kept_position, kept_rotation = self._place
        moved = touched | self._touched  # where it is let go is where it is one control period later
        self._touched = touched
        self._place = (
            position if moved[list(MOVING[0])].any() else kept_position,
            _levelled(rotation) if moved[list(MOVING[1])].any() else kept_rotation,
        )
        kept_position, kept_rotation = self._place
        to_goal = rotation.T @ (kept_position - position)
        goal_to_body = rotation.T @ kept_rotation
        velocity = self._env.velocity_body
        return goal_pose(to_goal, goal_to_body[:, 0], goal_to_body[:, 1], velocity[:3], velocity[3:])

    def _pose(self) -> tuple[Array, Array]:
        """Return position in NED [m] and rotation matrix, body to NED."""
        return self._env.position_ned, np.reshape(
            rotation_matrix(tuple(self._env.quaternion_body_to_ned)), (3, 3)
        )


def _levelled(rotation: Array) -> Array:
    """Return the rotation matrix of the same heading, level."""
    ahead = np.array([rotation[0, 0], rotation[1, 0], 0.0])
    ahead = ahead / max(float(np.linalg.norm(ahead)), 1e-9)
    return np.column_stack([ahead, [-ahead[1], ahead[0], 0.0], [0.0, 0.0, 1.0]])


def _holding(env: MarineEnv) -> DPController | None:
    """Return what holds a vehicle; None where it cannot be had."""
    try:
        return DPController(env.vehicle, env.control_period, None, env.scene.actuation)
    except InvalidInputError:
        return None
