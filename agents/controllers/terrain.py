"""The controller of terrain following: up and down as the ground ahead does, along a track."""

from __future__ import annotations

from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.autopilot import seen
from dq_marine.agents.controllers.guidance import levelled
from dq_marine.agents.controllers.journeys import MOTION
from dq_marine.agents.controllers.over_ground import GroundJourney
from dq_marine.agents.controllers.reading import shown_sizes
from dq_marine.agents.environments import marine
from dq_marine.agents.settings import AutopilotSettings, GroundSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.task.world.beams import fan_ahead


class TerrainController(GroundJourney):
    """Leads a vehicle along a track at an altitude."""

    READS: ClassVar[tuple[str, ...]] = (
        "ground_ahead_readings",
        "altimeter_reading",
        "starboard_of_track",
        "track_ahead_body",
        "ordered_speed",
        "speed_error",
        *MOTION,
    )

    def __init__(
        self,
        env: gym.Env[Any, Any],
        settings: GroundSettings | None = None,
        autopilot: AutopilotSettings | None = None,
    ) -> None:
        """Prepare for an environment's vehicle; None reads the presets `over_ground` and `autopilot`."""
        sizes = shown_sizes(marine(env))
        beams = sizes["ground_ahead_readings"] + sizes["altimeter_reading"]
        super().__init__(env, fan_ahead(beams), settings, autopilot)

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude, speed = seen(parts), float(parts["ordered_speed"][0])
        readings = np.append(parts["ground_ahead_readings"], parts["altimeter_reading"])
        self._ground.move(*self._gone(attitude))
        self._ground.add(self._echoes(readings, parts, attitude))
        track = tuple(parts["track_ahead_body"].tolist())
        ahead, starboard, _ = levelled(track, attitude.roll, attitude.pitch)
        order = self._order(attitude, speed, (ahead, starboard), 0.0, float(parts["starboard_of_track"][0]))
        return self._pilot.act(attitude, order._replace(speed_error=float(parts["speed_error"][0])))
