"""The controller of pipeline inspection: line of sight along the pipe that a detector has seen, over the ground."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.autopilot import Attitude, seen
from dq_marine.agents.controllers.journeys import MOTION
from dq_marine.agents.controllers.over_ground import GroundJourney
from dq_marine.agents.controllers.profiles import Line, Route
from dq_marine.agents.controllers.reading import shown_sizes
from dq_marine.agents.environments import marine
from dq_marine.agents.settings import AutopilotSettings, GroundSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.task.world.beams import fan_across

PIPE_WIDTH = 2.0
"""Echoes that are nearer to a pipe's axis, seen from above, than so many radii, may be of the pipe."""


class PipelineController(GroundJourney):
    """Leads a vehicle along a pipe at an altitude."""

    READS: ClassVar[tuple[str, ...]] = (
        "sonar_readings",
        "pipe_seen",
        "pipe_ahead",
        "pipe_starboard",
        "pipe_radius",
        "ordered_speed",
        *MOTION,
    )

    def __init__(
        self,
        env: gym.Env[Any, Any],
        settings: GroundSettings | None = None,
        autopilot: AutopilotSettings | None = None,
    ) -> None:
        """Prepare for an environment's vehicle; None reads the presets `over_ground` and `autopilot`."""
        beams = shown_sizes(marine(env))["sonar_readings"]
        super().__init__(env, fan_across(beams), settings, autopilot)
        self._route = Route(0.5 * self._altitude, self._altitude)

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._route.reset()

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude, speed = seen(parts), float(parts["ordered_speed"][0])
        radius = float(parts["pipe_radius"][0])
        line = self._pipe(parts, attitude)
        echoes = self._echoes(parts["sonar_readings"], parts, attitude)
        on_pipe = np.abs(echoes[:, 1] - line.starboard) < PIPE_WIDTH * radius
        self._ground.move(*self._gone(attitude))
        self._ground.add(echoes[~on_pipe])
        along = math.hypot(1.0, line.slope)
        way = (1.0 / along, line.slope / along)
        turning = speed * line.bend / along**3
        order = self._order(attitude, speed, way, turning, -line.starboard / along, radius)
        return self._pilot.act(attitude, order)

    def _pipe(self, parts: dict[str, Any], attitude: Attitude) -> Line:
        """Return the pipe beside the vehicle, by all that has been seen of it; straight ahead before it has been."""
        self._route.move(*self._gone(attitude))
        if parts["pipe_seen"][0] > 0.0:
            self._route.add(np.array([[parts["pipe_ahead"][0], parts["pipe_starboard"][0], self._altitude]]))
        return Line(0.0, 0.0, 0.0) if self._route.empty else self._route.at(0.0)
