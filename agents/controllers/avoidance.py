"""The controller of obstacle avoidance: it knows of the world what beams tell, and no more."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.autopilot import Attitude, Order, seen
from dq_marine.agents.controllers.dead_reckoning import gone
from dq_marine.agents.controllers.echoes import Echoes
from dq_marine.agents.controllers.fresh_readings import FreshReadings
from dq_marine.agents.controllers.guidance import levelled, no_turn_leads_to, wrapped
from dq_marine.agents.controllers.journeys import MOTION, Journey, slow_bends
from dq_marine.agents.controllers.ways import Ways
from dq_marine.agents.environments import marine
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import AutopilotSettings, AvoidanceSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.task.world.rangefinders import RANGE_FINDERS


class AvoidanceController(Journey):
    """Leads a vehicle to a goal, each time by the way that costs least, and slowly where room is short."""

    READS: ClassVar[tuple[str, ...]] = ("beam_readings", "goal_direction_body", "goal_distance", *MOTION)

    def __init__(
        self,
        env: gym.Env[Any, Any],
        settings: AvoidanceSettings | None = None,
        autopilot: AutopilotSettings | None = None,
    ) -> None:
        """Prepare for an environment's vehicle; None reads the presets `avoidance` and `autopilot`."""
        inner = marine(env)
        task = inner.task_settings
        fan = RANGE_FINDERS[task.range_finder].fan(task.beams)
        self._fresh = FreshReadings(inner, task.beams)
        super().__init__(env, autopilot, self._fresh.reads)
        size = self._vehicle.dimensions
        own = self._avoidance = settings or read_settings("avoidance", AvoidanceSettings)
        self._speed = cruising_speed(self._vehicle) * own.haste
        self._bend = slow_bends(self._pilot, self._settings, self._speed)[1]
        self._horizon = min(own.look_ahead, task.reach) * size.length
        self._ways = Ways(own, 0.5 * size.width, size.length, self._pilot.turning_radius(self._speed))
        self._echoes = Echoes(
            np.array(fan.bearings),
            task.reach * size.length,
            own.lasting * size.length / self._speed,
        )
        self._kept: float | None = None

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._echoes.reset()
        self._fresh.reset()
        self._kept = None

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude, distance = seen(parts), float(parts["goal_distance"][0])
        way = levelled(tuple(parts["goal_direction_body"].tolist()), attitude.roll, attitude.pitch)
        ahead, starboard, down = (distance * part for part in way)
        level = math.hypot(ahead, starboard)
        wanted = math.atan2(starboard, ahead)
        if no_turn_leads_to(ahead, starboard, self._bend):
            wanted = attitude.drift_angle  # on, until one does
        kept = self._remember(parts, attitude, wanted)
        horizon = max(self._pilot.length, min(self._horizon, level))
        chosen = self._ways.choose(self._echoes.points, attitude.drift_angle, wanted, kept, horizon)
        self._kept = wrapped(attitude.drift_angle + chosen.turn)
        share = min(
            1.0 - abs(chosen.turn) / self._settings.slowing_angle,
            chosen.free / min(horizon, self._avoidance.slowing_room * self._pilot.length),
        )
        speed = max(self._avoidance.slowest, min(1.0, share)) * self._speed
        climb = math.atan2(-down, max(level, self._pilot.length))
        error = speed - attitude.velocity_level[0]
        return self._pilot.act(attitude, Order(speed, error, chosen.turn, 0.0, climb))

    def _remember(self, parts: dict[str, Any], attitude: Attitude, wanted: float) -> float:
        """Bring the echoes up to now, and return the course that was chosen last, from the bow of now [rad]."""
        period = self._pilot.period
        self._echoes.move(attitude, period)
        self._echoes.add(parts["beam_readings"], self._fresh.of(parts), attitude)
        return wanted if self._kept is None else wrapped(self._kept - gone(attitude, period).turn)
