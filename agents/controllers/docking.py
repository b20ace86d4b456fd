"""Docking: hold before the mouth and go in along the axis; or, if the vehicle cannot stop, fly in along it."""

from __future__ import annotations

from typing import Any, ClassVar, Protocol

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.autopilot import seen
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.controllers.journeys import GuidedJourney
from dq_marine.agents.controllers.line_of_sight import Offset
from dq_marine.agents.controllers.reading import GOAL_POSE, Reading, goal_pose, parts_reader
from dq_marine.agents.environments import marine
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import AutopilotSettings
from dq_marine.envs.core.marine_env import Action, MarineEnv
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.suitability import steers_only_under_way

Array = NDArray[np.float64]

STANDOFF = 2.5  # where vehicles wait for their turn before the dock [lengths]
WAITING = 0.5  # a vehicle this near to where it should wait goes on [lengths]
CLEAR = (
    0.5,
    0.1,
)  # off the axis by no more than shares of the throat's radius and of the distance that is left
HASTE = 0.6  # speed of the approach, over the contact speed; of vehicles that cannot stop:
HASTE_UNDER_WAY = 0.8
BEYOND = 0.5  # how far beyond the throat a vehicle is led: it has to come through [lengths]
# Of the line of sight, in place of the preset's: an approach is too short to lose again what adaptation finds in the
# offset of its start and in the heave. A current needs none, because it is the course over ground that is led.
ADAPTATION = 0.0


class Way(Protocol):
    """One of the two ways into a dock."""

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""


class DockingController:
    """Brings a vehicle into a dock, by what it can do: `Creeping`, or `FlyingIn`."""

    READS: ClassVar[tuple[str, ...]] = (
        *GOAL_POSE,
        "dock_velocity_body",
        "dock_acceleration_body",
        "down_body",
        "throat_radius",
        "contact_speed_limit",
    )

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        """Choose the way for an environment's vehicle."""
        inner = marine(env)
        self._way: Way = FlyingIn(inner) if steers_only_under_way(inner.vehicle) else Creeping(inner)

    @classmethod
    def for_env(cls, env: gym.Env[Any, Any]) -> DockingController:
        """Return the controller for an environment's vehicle."""
        return cls(env)

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        self._way.reset(env)

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        return self._way.act(observation)


class Creeping:
    """Holds a pose on the dock's axis by dynamic positioning, and moves it in while the vehicle keeps up with it."""

    def __init__(self, env: MarineEnv) -> None:
        """Prepare for an environment's vehicle."""
        self._read = parts_reader(env, DockingController.READS)
        self._length, self._period = env.vehicle.dimensions.length, env.control_period
        self._left = STANDOFF * self._length
        self._positioning = DPController(
            env.vehicle, env.control_period, None, env.scene.actuation, self._wanted
        )

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        self._left = STANDOFF * self._length
        self._positioning.reset()

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        return self._positioning.act(observation)

    def _wanted(self, observation: Observation) -> Reading:
        """Return the pose to hold now, which is `_left` before the dock [m], and how it moves."""
        parts = self._read(observation)
        docked = goal_pose(*(parts[name] for name in GOAL_POSE))
        axis = parts["goal_x_axis_body"]
        before, *off = (docked.goal_to_body.T @ docked.error_body[:3]).tolist()
        clear = CLEAR[0] * float(parts["throat_radius"][0]) + CLEAR[1] * self._left
        goes_in = abs(before - self._left) < WAITING * self._length and np.hypot(*off) < clear
        speed = HASTE * float(parts["contact_speed_limit"][0]) if goes_in else 0.0
        self._left = max(-BEYOND * self._length, self._left - self._period * speed)
        return docked._replace(
            error_body=docked.error_body - np.concatenate([self._left * axis, np.zeros(3)]),
            goal_velocity_body=np.concatenate([parts["dock_velocity_body"] + speed * axis, np.zeros(3)]),
            goal_acceleration_body=np.concatenate([parts["dock_acceleration_body"], np.zeros(3)]),
        )


class FlyingIn(GuidedJourney):
    """Leads a vehicle along the dock's axis by line of sight, at the speed at which it may come in."""

    READS = DockingController.READS

    def __init__(self, env: MarineEnv) -> None:
        """Prepare for an environment's vehicle."""
        settings = read_settings("autopilot", AutopilotSettings)
        super().__init__(env, settings.model_copy(update={"adaptation": ADAPTATION}))

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        docked = goal_pose(*(parts[name] for name in GOAL_POSE))
        _, port, above = (docked.goal_to_body.T @ docked.error_body[:3]).tolist()
        speed = HASTE_UNDER_WAY * float(parts["contact_speed_limit"][0])
        attitude, axis = seen(parts), parts["goal_x_axis_body"]
        order = self._guidance.order(attitude, speed, axis, np.zeros(3), Offset(-port, -above))
        return self._pilot.act(attitude, order)
