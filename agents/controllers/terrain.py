"""The controller of terrain following: it knows of the ground what beams tell, and no more."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.autopilot import PITCH, YAW, Array, Attitude, seen
from dq_marine.agents.controllers.guidance import levelled
from dq_marine.agents.controllers.journeys import MOTION, Journey
from dq_marine.agents.controllers.line_of_sight import LineOfSight, Offset
from dq_marine.agents.controllers.profiles import Profile
from dq_marine.agents.environments import marine
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import AutopilotSettings, TerrainSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.task.world.beams import ground_bearings


class TerrainController(Journey):
    """Leads a vehicle along a track at an altitude, up and down as the ground ahead does."""

    READS: ClassVar[tuple[str, ...]] = (
        "ground_ahead_readings",
        "altimeter_reading",
        "ordered_altitude",
        "starboard_of_track",
        "track_ahead_body",
        "ordered_speed",
        "speed_error",
        *MOTION,
    )

    def __init__(
        self,
        env: gym.Env[Any, Any],
        settings: TerrainSettings | None = None,
        autopilot: AutopilotSettings | None = None,
    ) -> None:
        """Prepare for an environment's vehicle; None reads the presets `terrain` and `autopilot`."""
        super().__init__(env, autopilot)
        inner = marine(env)
        own = self._terrain = settings or read_settings("terrain", TerrainSettings)
        self._guidance = LineOfSight(self._pilot, self._settings)
        altitude = inner.task_settings.altitude * self._vehicle.dimensions.length
        self._reach = inner.task_settings.reach * self._vehicle.dimensions.length
        self._profile = Profile(own.width * altitude, own.behind * altitude, altitude)
        beams = len(self._read(inner.observation_bound)["ground_ahead_readings"]) + 1
        self._beams_body = [(math.cos(below), 0.0, math.sin(below)) for below in ground_bearings(beams)]
        self._altitude = altitude

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._guidance.reset()
        self._profile.reset()

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude, speed = seen(parts), float(parts["ordered_speed"][0])
        ahead, starboard, _ = levelled(
            tuple(parts["track_ahead_body"].tolist()), attitude.roll, attitude.pitch
        )
        self._look(np.append(parts["ground_ahead_readings"], parts["altimeter_reading"]), attitude)
        axis = YAW if self._pilot.by_heave else PITCH
        lead = self._terrain.lead * speed / self._pilot.angle_gain(axis)
        here, soon = self._profile.at(0.0, 0.0), self._profile.at(lead * ahead, lead * starboard)
        off = Offset(float(parts["starboard_of_track"][0]), self._altitude - here.below)
        way = (ahead, starboard, soon.ahead * ahead + soon.starboard * starboard)
        order = self._guidance.order_along(attitude, speed, way, 0.0, off)
        return self._pilot.act(attitude, order._replace(speed_error=float(parts["speed_error"][0])))

    def _look(self, readings: Array, attitude: Attitude) -> None:
        """Bring the profile of the ground up to now."""
        period = self._pilot.period
        ahead, starboard, down = attitude.velocity_level
        turn = period * float(attitude.velocity_body[5])
        self._profile.move((period * ahead, period * starboard, period * down), turn)
        met = readings < 1.0
        beams = np.array([levelled(beam, attitude.roll, attitude.pitch) for beam in self._beams_body])
        self._profile.add(self._reach * readings[met, None] * beams[met])
