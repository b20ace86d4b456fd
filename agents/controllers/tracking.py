"""Tracking of a point that moves: by its pose, or where a vehicle only steers, by line of sight and speed.

A vehicle that only steers is led by line of sight along the point's way, with the point's turn rate fed forward, and
goes faster than the point, or slower, by

    u_d = |v_goal| + k e,                                                                              (1)

where e is how far the point is ahead along its way, and 1 / k a few times what the vehicle needs for its length.
"""

from __future__ import annotations

from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.autopilot import seen
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.controllers.journeys import GuidedJourney
from dq_marine.agents.controllers.line_of_sight import Offset
from dq_marine.agents.controllers.reading import GOAL_MOTION, GOAL_POSE
from dq_marine.agents.controllers.rotation import crossed
from dq_marine.agents.environments import marine
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.suitability import tracks_by_steering

CATCHING_UP = 0.5  # k of (1), over the point's speed and the vehicle's length
FASTEST, SLOWEST = 0.95, 0.2  # speeds that are asked for: over the largest, and over the point's


class TrackingController:
    """Stays with a point that moves, by what a vehicle can do: dynamic positioning, or `Following`."""

    READS: ClassVar[tuple[str, ...]] = (*GOAL_POSE, *GOAL_MOTION)

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        """Choose the way for an environment's vehicle."""
        steers = tracks_by_steering(marine(env).vehicle)
        self._way: DPController | Following = Following(env) if steers else DPController.for_env(env)

    @classmethod
    def for_env(cls, env: gym.Env[Any, Any]) -> TrackingController:
        """Return the controller for an environment's vehicle."""
        return cls(env)

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        self._way.reset(env)

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        return self._way.act(observation)


class Following(GuidedJourney):
    """Leads a vehicle along the way of a point, and on to it."""

    READS = TrackingController.READS

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        velocity, starboard = parts["goal_velocity_body"], parts["goal_y_axis_body"]
        down = crossed(parts["goal_x_axis_body"], starboard)  # the goal is level
        goal_speed = max(float(np.linalg.norm(velocity)), 1e-6)
        ahead = velocity / goal_speed
        error, below = parts["goal_position_body"], crossed(ahead, starboard)
        pace = 1.0 + CATCHING_UP * float(error @ ahead) / self._pilot.length
        speed = min(FASTEST * self._pilot.top_speed, max(SLOWEST, pace) * goal_speed)
        bend = crossed(parts["goal_turn_rate_body"], ahead) * self._pilot.length / goal_speed
        off = Offset(-float(error @ starboard), -float(error @ below))
        attitude = seen(parts | {"down_body": down})
        return self._pilot.act(attitude, self._guidance.order(attitude, speed, ahead, bend, off))
