"""What controllers that keep an altitude over the ground have in common: they know of it what beams tell."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.autopilot import PITCH, YAW, Array, Attitude, Order
from dq_marine.agents.controllers.dead_reckoning import Gone, carried, gone
from dq_marine.agents.controllers.fresh_readings import FreshReadings
from dq_marine.agents.controllers.guidance import levelled
from dq_marine.agents.controllers.journeys import GuidedJourney
from dq_marine.agents.controllers.line_of_sight import Offset
from dq_marine.agents.controllers.profiles import Ground
from dq_marine.agents.environments import marine
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import AutopilotSettings, GroundSettings
from dq_marine.task.world.beams import Fan, directions_of


class GroundJourney(GuidedJourney):
    """A journey over ground whose echoes are remembered."""

    def __init__(
        self,
        env: gym.Env[Any, Any],
        fan: Fan,
        settings: GroundSettings | None = None,
        autopilot: AutopilotSettings | None = None,
    ) -> None:
        """Prepare for an environment's vehicle, with its fan of beams; None reads `over_ground` and `autopilot`."""
        self._beams_body = directions_of(fan)
        self._fresh = FreshReadings(marine(env), len(self._beams_body))
        super().__init__(env, autopilot, self._fresh.reads)
        task, length = marine(env).task_settings, self._vehicle.dimensions.length
        self._over_ground = settings or read_settings("over_ground", GroundSettings)
        self._altitude, self._reach = task.altitude * length, task.reach * length
        self._ground = Ground(
            self._over_ground.width * self._altitude, self._over_ground.behind * self._altitude
        )

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._ground.reset()
        self._fresh.reset()

    def _gone(self, attitude: Attitude) -> Gone:
        """Return how far the vehicle has gone in a period."""
        return gone(attitude, self._pilot.period)

    def _echoes(self, readings: Array, parts: dict[str, Any], attitude: Attitude) -> Array:
        """Return what the beams have just met: ahead, to starboard and below, shape (n, 3) [m]."""
        fresh = self._fresh.of(parts)
        met = (readings < 1.0) & fresh.beams
        beams = np.array([levelled(beam, attitude.roll, attitude.pitch) for beam in self._beams_body])
        return carried(self._reach * readings[met, None] * beams[met], *gone(attitude, fresh.age))

    def _lead(self, speed: float) -> float:
        """Return how far ahead the ground's slope is followed [m]."""
        axis = YAW if self._pilot.by_heave else PITCH
        return self._over_ground.lead * speed / self._pilot.angle_gain(axis)

    def _order(
        self,
        attitude: Attitude,
        speed: float,
        way: tuple[float, float],
        turning: float,
        starboard: float,
        higher: float = 0.0,
    ) -> Order:
        """Return the order for a path over the ground.

        Args:
            attitude: of the vehicle.
            speed: wanted over ground [m/s].
            way: where the path goes, ahead and to starboard, a unit vector.
            turning: how fast its course turns to starboard at that speed [rad/s].
            starboard: how far the vehicle is to starboard of it [m].
            higher: by how much the path is more than the altitude over the ground [m].
        """
        fall, below = 0.0, 0.0
        if not self._ground.empty:
            lead = self._lead(speed)
            soon = self._ground.at(lead * way[0], lead * way[1])
            fall = soon.ahead * way[0] + soon.starboard * way[1]
            below = self._altitude + higher - self._ground.at(0.0, 0.0).below
        return self._guidance.order_along(attitude, speed, (*way, fall), turning, Offset(starboard, below))
