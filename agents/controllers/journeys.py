"""Controllers of journeys: guidance by what a task shows, and the autopilot that carries it out."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Self

import gymnasium as gym

from dq_marine.agents.controllers.autopilot import PITCH, YAW, Autopilot, Order, seen
from dq_marine.agents.controllers.guidance import levelled, no_turn_leads_to, wrapped
from dq_marine.agents.controllers.line_of_sight import LineOfSight, Offset
from dq_marine.agents.controllers.reading import parts_reader
from dq_marine.agents.environments import marine
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import AutopilotSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.suitability import cruising_speed

MOTION = ("down_body", "linear_velocity_body", "angular_velocity_body")
"""Parts of an observation that tell of attitude and velocity, wherever the vehicle is."""


def slow_bends(pilot: Autopilot, settings: AutopilotSettings, speed: float) -> tuple[float, float]:
    """Return how slow a vehicle gets in bends, over a speed [m/s], and the radius of bends that it then keeps [m]."""
    if pilot.stopping_distance(speed) < pilot.length:
        return settings.slowest, settings.bend_margin * pilot.turning_radius(settings.slowest * speed)
    return settings.slowest_of_heavy, settings.tightest_turn * pilot.length


class Journey:
    """What all controllers of journeys have: a reader of what is shown, their settings, and an autopilot."""

    READS: ClassVar[tuple[str, ...]]
    PRESET: ClassVar[str] = "autopilot"

    def __init__(
        self,
        env: gym.Env[Any, Any],
        autopilot: AutopilotSettings | None = None,
        also_reads: tuple[str, ...] = (),
    ) -> None:
        """Prepare for an environment's vehicle; None reads the preset `PRESET`."""
        inner = marine(env)
        self._vehicle = inner.vehicle
        self._read = parts_reader(inner, (*self.READS, *also_reads))
        self._settings = autopilot or read_settings(self.PRESET, AutopilotSettings)
        self._pilot = Autopilot(inner.vehicle, inner.control_period, inner.scene.actuation, self._settings)

    @classmethod
    def for_env(cls, env: gym.Env[Any, Any], settings: AutopilotSettings | None = None) -> Self:
        """Return the controller for an environment's vehicle; None reads the preset `PRESET`."""
        return cls(env, autopilot=settings)

    @property
    def settings(self) -> AutopilotSettings:
        """What guidance and autopilot were made with."""
        return self._settings

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        self._pilot.reset()


class GuidedJourney(Journey):
    """A journey along a line that is led by adaptive line of sight, level and vertical."""

    def __init__(
        self,
        env: gym.Env[Any, Any],
        autopilot: AutopilotSettings | None = None,
        also_reads: tuple[str, ...] = (),
    ) -> None:
        """Prepare for an environment's vehicle; None reads the preset `autopilot`."""
        super().__init__(env, autopilot, also_reads)
        self._guidance = LineOfSight(self._pilot, self._settings)

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._guidance.reset()


class PathController(GuidedJourney):
    """Leads a vehicle along a path by adaptive line of sight, level and vertical."""

    READS: ClassVar[tuple[str, ...]] = (
        "starboard_of_path",
        "below_path",
        "path_ahead_body",
        "path_bend_body",
        "path_bend_soon_body",
        "commanded_speed",
        *MOTION,
    )

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude = seen(parts)
        off = Offset(float(parts["starboard_of_path"][0]), float(parts["below_path"][0]))
        bend = 0.5 * (parts["path_bend_body"] + parts["path_bend_soon_body"])
        speed = float(parts["commanded_speed"][0])
        return self._pilot.act(
            attitude, self._guidance.order(attitude, speed, parts["path_ahead_body"], bend, off)
        )


class WaypointController(Journey):
    """Leads a vehicle from waypoint to waypoint: its course goes straight to the next, and slowly round bends."""

    READS: ClassVar[tuple[str, ...]] = ("waypoint_body", *MOTION)

    def __init__(self, env: gym.Env[Any, Any], autopilot: AutopilotSettings | None = None) -> None:
        """Prepare for an environment's vehicle; None reads the preset `autopilot`."""
        super().__init__(env, autopilot)
        self._speed = cruising_speed(self._vehicle) * self._settings.haste
        self._slowest, self._bend = slow_bends(self._pilot, self._settings, self._speed)

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude = seen(parts)
        ahead, starboard, down = levelled(
            tuple(parts["waypoint_body"].tolist()), attitude.roll, attitude.pitch
        )
        distance = math.hypot(ahead, starboard)
        turn = wrapped(math.atan2(starboard, ahead) - attitude.drift_angle)
        share = max(self._slowest, 1.0 - abs(turn) / self._settings.slowing_angle)
        if no_turn_leads_to(ahead, starboard, self._bend):
            turn, share = 0.0, 1.0  # on, until one does
        speed = share * self._speed
        climb = math.atan2(-down, max(distance, self._pilot.length))
        error = speed - attitude.velocity_level[0]
        return self._pilot.act(attitude, Order(speed, error, turn, 0.0, climb))


class DepthHeadingController(Journey):
    """Brings a vehicle to the depth, the heading and the speed that are ordered."""

    READS: ClassVar[tuple[str, ...]] = ("deeper", "turn_cosine_sine", "speed_error", "ordered_speed", *MOTION)
    PRESET: ClassVar[str] = "autopilot_by_orders"

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude, speed = seen(parts), float(parts["ordered_speed"][0])
        turn = math.atan2(parts["turn_cosine_sine"][1], parts["turn_cosine_sine"][0])
        axis = YAW if self._pilot.by_heave else PITCH
        climb = -math.atan2(float(parts["deeper"][0]), self._pilot.look_ahead(speed, axis))
        error = float(parts["speed_error"][0])
        return self._pilot.act(attitude, Order(speed, error, turn, 0.0, climb))
