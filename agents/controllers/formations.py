"""A controller that keeps a vehicle in its place in a formation: a filter, line of sight, and the autopilot."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.autopilot import Attitude, seen
from dq_marine.agents.controllers.formation_filter import (
    COURSE,
    DEPTH,
    SINKING,
    SPEED,
    TURNING,
    FormationFilter,
    Packet,
    turned,
)
from dq_marine.agents.controllers.journeys import MOTION, GuidedJourney
from dq_marine.agents.controllers.line_of_sight import Offset
from dq_marine.agents.settings import AutopilotSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation

Array = NDArray[np.float64]

SENDERS = (1, 2, 3)
"""Numbers of the other vehicles in the names of what is observed."""

TOLD = ("told", "age", "range", "position_level", "deeper", "course_level", "speed")

CATCHING_UP = 3.0
"""In which an error along the course is closed at the formation's speed, were it kept up [lengths]."""

HASTE = 0.4
"""Largest difference from the speed of one's place, over the formation's."""


class FormationController(GuidedJourney):
    """Estimates where the vehicle is in its formation, and goes along the course of its place by line of sight."""

    READS: ClassVar[tuple[str, ...]] = (
        *(f"packet_{k}_{part}" for k in SENDERS for part in TOLD),
        "places_from_own",
        "bow_north_east",
        "deeper_than_start",
        "formation_speed",
        *MOTION,
    )

    def __init__(self, env: gym.Env[Any, Any], autopilot: AutopilotSettings | None = None) -> None:
        """Prepare for an environment's vehicle; None reads the preset `autopilot`."""
        super().__init__(env, autopilot)
        self._filter: FormationFilter | None = None
        self._ages = [math.inf] * len(SENDERS)

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._filter, self._bow = None, 0.0
        self._ages = [math.inf] * len(SENDERS)

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude = seen(parts)
        north, east = parts["bow_north_east"].tolist()
        bow = math.atan2(east, north)
        self._bow = bow
        places = parts["places_from_own"].reshape(3, 2)
        place = (-float(places[0, 0]), -float(places[0, 1]))
        state = self._estimated(
            parts, attitude, bow, place, [tuple(row) for row in (places - places[0]).tolist()]
        )
        # How far off its place the vehicle is, along the formation's course and to starboard of it.
        course, turning, speed = (float(state[k]) for k in (COURSE, TURNING, SPEED))
        here = turned((float(state[0]), float(state[1])), -course)
        own_velocity = (speed - turning * place[1], turning * place[0])
        own_speed, crab = math.hypot(*own_velocity), math.atan2(own_velocity[1], own_velocity[0])
        ahead, starboard = turned((here[0] - place[0], here[1] - place[1]), -crab)
        reach = HASTE * speed
        hurry = max(-reach, min(reach, -ahead * speed / (CATCHING_UP * self._pilot.length)))
        way = turned((1.0, 0.0), course + crab - bow)
        bend = turning / own_speed * self._pilot.length
        off = Offset(starboard, float(parts["deeper_than_start"][0]) - float(state[DEPTH]))
        order = self._guidance.level_order(
            attitude,
            own_speed + hurry,
            (*way, float(state[SINKING]) / own_speed),
            (-bend * way[1], bend * way[0], 0.0),
            off,
        )
        return self._pilot.act(attitude, order)

    @property
    def estimate(self) -> Array:
        """Where the vehicle is in the formation, and how that goes, shape (8,).

        Off the formation's middle ahead and to starboard [m], the formation's course, ahead and to starboard, and the
        rest of what the filter estimates.
        """
        if self._filter is None:
            return np.zeros(8)
        state = self._filter.state
        place = turned((float(state[0]), float(state[1])), -self._bow)
        course = float(state[COURSE]) - self._bow
        others = (float(state[k]) for k in (TURNING, SPEED, DEPTH, SINKING))
        return np.array([*place, math.cos(course), math.sin(course), *others])

    def _estimated(
        self,
        parts: dict[str, Array],
        attitude: Attitude,
        bow: float,
        place: tuple[float, float],
        places: list[tuple[float, float]],
    ) -> Array:
        """Return the filter's state, brought up to now."""
        ahead, starboard, _ = attitude.velocity_level
        velocity = turned((ahead, starboard), bow)
        if self._filter is None:
            spacing = max(abs(part) for part in places[1])
            speed = float(parts["formation_speed"][0])
            self._filter = FormationFilter(place, spacing, speed, bow)
        else:
            self._filter.predict(velocity, self._pilot.period)
        for index, k in enumerate(SENDERS):
            age, told = float(parts[f"packet_{k}_age"][0]), parts[f"packet_{k}_told"] > 0.5
            if told[0] and age < self._ages[index]:
                packet = self._packet(parts, k, bow, places[index])
                self._filter.update(packet, velocity, float(parts["deeper_than_start"][0]))
            self._ages[index] = age
        return self._filter.state

    def _packet(self, parts: dict[str, Array], k: int, bow: float, place: tuple[float, float]) -> Packet:
        """Return the last packet of a sender, in north and east."""
        heard, course, position = (parts[f"packet_{k}_told"] > 0.5).tolist()
        (age,), (measured,), (deeper,), (speed,) = (
            parts[f"packet_{k}_{part}"].tolist() for part in ("age", "range", "deeper", "speed")
        )
        velocity = turned(tuple((speed * parts[f"packet_{k}_course_level"]).tolist()), bow)
        offset = turned(tuple(parts[f"packet_{k}_position_level"].tolist()), bow)
        depth = deeper + float(parts["deeper_than_start"][0])
        return Packet(
            place,
            age,
            np.array([measured, *velocity, depth, *offset]),
            np.array([heard, course, course, course, position, position]),
        )
