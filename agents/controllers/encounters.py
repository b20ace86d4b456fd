"""A controller for meetings of vessels: a course by velocity obstacles, and the autopilot that steers it."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.autopilot import YAW, Order, seen
from dq_marine.agents.controllers.guidance import wrapped
from dq_marine.agents.controllers.journeys import MOTION, Journey
from dq_marine.agents.controllers.velocity_obstacles import ON_ROUTE, CourseChoice
from dq_marine.agents.controllers.ways_among_vessels import Others, Own, sight
from dq_marine.agents.environments import marine
from dq_marine.agents.settings import AutopilotSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.suitability import cruising_speed

Array = NDArray[np.float64]

SLOTS = (1, 2, 3)
"""Numbers of the other vessels in the names of what is observed."""

BETWEEN_CHOICES = 0.5
"""Way between two choices of a course [own lengths]."""


class EncounterController(Journey):
    """Goes along a route, and gives way to others by the rules of the road."""

    READS: ClassVar[tuple[str, ...]] = (
        "starboard_of_route",
        "route_level",
        *(f"vessel_{k}_{part}" for k in SLOTS for part in ("position_level", "velocity_level", "rules")),
        *MOTION,
    )

    def __init__(self, env: gym.Env[Any, Any], autopilot: AutopilotSettings | None = None) -> None:
        """Prepare for an environment's vehicle; None reads the preset `autopilot`."""
        super().__init__(env, autopilot)
        self._speed, length = cruising_speed(self._vehicle), self._pilot.length
        self._choice = CourseChoice(marine(env).task_settings.safe_distance)
        self._periods = max(1, round(BETWEEN_CHOICES * length / self._speed / self._pilot.period))
        self._fastest = length / self._pilot.turning_radius(self._speed)
        # In lengths and in times of a length; that of three quarters of the speed stands for all of them.
        self._braking = max(0.0, self._pilot.braking(0.75 * self._speed) * length / self._speed**2)
        self._chosen, self._until_choice, self._turn = ON_ROUTE, 0, 0.0

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._choice.reset()
        self._chosen, self._until_choice, self._turn = ON_ROUTE, 0, 0.0

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude, length = seen(parts), self._pilot.length
        route = math.atan2(parts["route_level"][1], parts["route_level"][0])
        course = wrapped(attitude.drift_angle - route)
        starboard = float(parts["starboard_of_route"][0]) / length
        if self._until_choice == 0:
            turning = float(attitude.velocity_body[YAW]) * length / self._speed
            pace = attitude.speed / self._speed
            own = Own(course, pace, turning, self._fastest, self._braking, starboard)
            self._chosen = self._choice.choose(own, self._others(parts, attitude.velocity_level, route))
            self._until_choice = self._periods
        self._until_choice -= 1
        wanted = sight(starboard) if self._chosen.course is None else self._chosen.course
        self._turn = wrapped(wanted - course)
        speed = self._chosen.speed * self._speed
        return self._pilot.act(attitude, Order(speed, speed - attitude.speed, self._turn, 0.0, 0.0))

    @property
    def estimate(self) -> Array:
        """How far it has to turn to the course that it has chosen [rad], and the speed, over that of the route."""
        return np.array([self._turn, self._chosen.speed])

    def _others(self, parts: dict[str, Array], velocity: tuple[float, float, float], route: float) -> Others:
        """Return the vessels that there are, along the route and to starboard of it."""
        rules = np.array([parts[f"vessel_{k}_rules"] for k in SLOTS]) > 0.5
        places = np.array([parts[f"vessel_{k}_position_level"] for k in SLOTS]) / self._pilot.length
        relative = np.array([parts[f"vessel_{k}_velocity_level"] for k in SLOTS])
        to_route = np.array([[math.cos(route), -math.sin(route)], [math.sin(route), math.cos(route)]])
        there = rules[:, 0]
        return Others(
            (places @ to_route)[there],
            ((relative + velocity[:2]) / self._speed @ to_route)[there],
            rules[there, 1],
            rules[there, 2],
        )
