"""Berthing: along the quay to the berth by line of sight and, where a vessel can be moved sideways, from there in.

A vessel slows down ahead of where it is to stop, at a distance d, to the speed

    v = sqrt(2 a d),                                                                                   (1)

from which a share of its thrust astern stops it in time with the acceleration a.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.autopilot import SURGE, YAW, Attitude, Order, seen
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.controllers.guidance import levelled, wrapped
from dq_marine.agents.controllers.journeys import Journey
from dq_marine.agents.controllers.reading import GOAL_POSE, Array, Reading, goal_pose
from dq_marine.agents.environments import marine
from dq_marine.agents.settings import AutopilotSettings
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.suitability import cruising_speed, steers_only_under_way

SWAY = 1
STANDOFF = 0.75  # where vessels that can be moved sideways come to, beside piers and fenders [lengths]
TAKEN = 0.5  # from where they are positioned: distance along the quay to the berth [lengths]
WAITING = 0.2  # a vessel this near to where it should be is moved in [lengths]
BRAKING, EASING = 0.2, 0.1  # shares of the thrust that (1) counts on, ahead and sideways
NEAR = 0.1  # within this the speed falls in proportion to the distance [lengths]
SIDEWAYS = 0.08  # fastest towards the quay [cruising speed]
TOUCH = 0.4  # of the contact speed, at last
HASTE = 0.7  # fastest along the quay [cruising speed]
# Between these the course is led less and less, and then the heading alone: the bow is parallel [cruising speed].
SLOW, SLOWEST = 0.3, 0.1
STRAIGHT = math.radians(3.0)  # how far off the quay's it may be at last [rad]
STEEPEST = math.radians(45.0)  # course towards the quay [rad]


class BerthingController(Journey):
    """Brings a vessel alongside."""

    READS: ClassVar[tuple[str, ...]] = (
        *GOAL_POSE,
        "down_body",
        "to_quay_body",
        "pier_length",
        "contact_speed_limit",
    )

    def __init__(self, env: gym.Env[Any, Any], autopilot: AutopilotSettings | None = None) -> None:
        """Prepare for an environment's vehicle; None reads the preset `autopilot`."""
        super().__init__(env, autopilot)
        vehicle, inner = self._vehicle, marine(env)
        self._length, self._cruising = vehicle.dimensions.length, cruising_speed(vehicle)
        self._speed = HASTE * self._cruising
        self._strength = vehicle.wrench_limits / np.diag(vehicle.mass_matrix)
        self._positioning: DPController | None = None
        if not steers_only_under_way(vehicle):
            self._positioning = DPController(
                vehicle, inner.control_period, None, inner.scene.actuation, self._wanted
            )
        self._left: float | None = None
        self._sideways = 0.0

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._left, self._sideways = None, 0.0
        if self._positioning is not None:
            self._positioning.reset()

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        if self._left is not None and self._positioning is not None:
            return self._positioning.act(observation)
        parts = self._read(observation)
        docked = goal_pose(*(parts[name] for name in GOAL_POSE))
        standoff = self._standoff(parts) if self._positioning is not None else 0.0
        way = docked.goal_to_body.T @ (docked.error_body[:3] - standoff * parts["to_quay_body"])
        if self._positioning is not None and abs(way[0]) < TAKEN * self._length:
            self._left = standoff
            return self._positioning.act(observation)
        attitude = seen(parts)
        axis = levelled(tuple(parts["goal_x_axis_body"].tolist()), attitude.roll, attitude.pitch)
        return self._pilot.act(attitude, self._order(attitude, math.atan2(axis[1], axis[0]), way))

    def _standoff(self, parts: dict[str, Array]) -> float:
        """Return how far off its berth a vessel that can be moved sideways stops [m]."""
        return STANDOFF * self._length + float(parts["pier_length"][0])

    def _order(self, attitude: Attitude, course: float, way: Array) -> Order:
        """Return the order along a line.

        Args:
            attitude: of the vessel.
            course: of the line, from the bow [rad].
            way: to where the vessel is to stop: along the line, to starboard of it, down [m], shape (3,).
        """
        speed = self._slowed(float(way[0]), BRAKING * float(self._strength[SURGE]))
        pace = abs(attitude.speed) / self._cruising
        share = max(0.0, min(1.0, (pace - SLOWEST) / (SLOW - SLOWEST)))
        widest = STRAIGHT + (STEEPEST - STRAIGHT) * share
        turned = (
            math.atan2(float(way[1]), self._pilot.look_ahead(self._speed, YAW)) - share * attitude.drift_angle
        )
        heading = course + max(-widest, min(widest, turned))
        return Order(speed, speed - attitude.velocity_level[0], wrapped(heading), 0.0, 0.0)

    def _slowed(self, distance: float, acceleration: float) -> float:
        """Return the speed (1) [m/s], less than 0 where the berth is astern."""
        near = min(1.0, abs(distance) / (NEAR * self._length))  # (1) is too steep at the place itself
        speed = math.sqrt(2.0 * acceleration * abs(distance) * near)
        return math.copysign(min(speed, self._speed), distance)

    def _wanted(self, observation: Observation) -> Reading:
        """Return the pose to hold now, which is `_left` off the berth [m], and how it moves."""
        parts, left = self._read(observation), self._left or 0.0
        docked, to_quay = goal_pose(*(parts[name] for name in GOAL_POSE)), parts["to_quay_body"]
        off = docked.error_body[:3] - left * to_quay
        kept_up = bool(np.hypot(*off[:2]) < WAITING * self._length)
        before, self._sideways = self._sideways, self._inwards(left, kept_up, parts)
        self._left = max(0.0, left - self._pilot.period * self._sideways)
        hastening = (self._sideways - before) / self._pilot.period
        return docked._replace(
            error_body=np.concatenate([off, docked.error_body[3:]]),
            goal_velocity_body=np.concatenate([self._sideways * to_quay, np.zeros(3)]),
            goal_acceleration_body=np.concatenate([hastening * to_quay, np.zeros(3)]),
        )

    def _inwards(self, left: float, kept_up: bool, parts: dict[str, Array]) -> float:
        """Return how fast the pose is moved towards the quay [m/s], which is `left` away [m]: (1), in and out."""
        if not kept_up or left == 0.0:
            return 0.0
        easing = EASING * float(self._strength[SWAY])
        touch = TOUCH * float(parts["contact_speed_limit"][0])
        return min(
            SIDEWAYS * self._cruising,
            self._sideways + easing * self._pilot.period,
            math.sqrt(2.0 * easing * left) + touch,
        )
