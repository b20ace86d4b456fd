"""Tracking of a point that moves, with a model of the vehicle: what LQR and MPC have in common, and LQR.

The wrench is that which keeps the vehicle on the reference, less the estimated disturbance, and one that reduces the
deviation from it,

    tau = M nu_r' - f(nu_r) - g - d + u,                                                              (1)

with the model of `hydrodynamic_model` and the observer of `disturbance`. LQR has u = -K x, by `lqr`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, NamedTuple, Self

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.deviation import deviation_model, reference_wrench, sampled
from dq_marine.agents.controllers.disturbance import DisturbanceObserver
from dq_marine.agents.controllers.hydrodynamic_model import HydrodynamicModel
from dq_marine.agents.controllers.lqr import Regulator, bryson_weights, regulator
from dq_marine.agents.controllers.reading import GOAL_MOTION, GOAL_POSE, Reading, goal_reader, parts_reader
from dq_marine.agents.controllers.reference import Reference, Way, reference_along
from dq_marine.agents.controllers.rotation import both_halves
from dq_marine.agents.controllers.wrench_mapping import WRENCH_MAPPINGS
from dq_marine.agents.environments import marine
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrajectorySettings
from dq_marine.checks import one_of
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.envs.core.suitability import tracks_by_steering
from dq_marine.envs.tasks.trajectory_tracking import AHEAD
from dq_marine.errors import InvalidInputError

Array = NDArray[np.float64]

PLACES_AHEAD = ("goal_position_soon_body", "goal_position_later_body")
"""Parts of an observation that tell where the point is going to be, `AHEAD` of now."""


class Tracked(NamedTuple):
    """What a wrench is chosen by.

    Attributes:
        deviation: of the vehicle, see `deviation`, shape (12,).
        reference: over the control periods to come.
        feedforward: tau - u of (1) in each of them, body frame, shape (n, 6) [N, N m].
    """

    deviation: Array
    reference: Reference
    feedforward: Array


class TrajectoryController(ABC):
    """Keeps a fully actuated vehicle on a point that moves.

    Attributes:
        settings: weights, horizon and the observer's lag.
    """

    READS: ClassVar[tuple[str, ...]] = (*GOAL_POSE, *GOAL_MOTION, *PLACES_AHEAD)

    def __init__(self, env: gym.Env[Any, Any], settings: TrajectorySettings | None = None) -> None:
        """Prepare for an environment's vehicle, actuation and control period; None reads the preset `trajectory`.

        Raises:
            InvalidInputError: the environment does not show a point's way, or the vehicle floats or only steers.
            MissingDependencyError: a library of the extra `mpc` is not installed.
        """
        inner = marine(env)
        self.settings = settings or read_settings("trajectory", TrajectorySettings)
        self._read_places = parts_reader(inner, self.READS)
        self._read_goal = goal_reader(inner)
        self.vehicle, self.control_period = inner.vehicle, inner.control_period
        self._refuse_others()
        actuation = inner.scene.actuation
        self._mapping = WRENCH_MAPPINGS[one_of("actuation", actuation, WRENCH_MAPPINGS)](self.vehicle)
        self.model = HydrodynamicModel(self.vehicle)
        self.weights = bryson_weights(self.settings, self.vehicle)
        self._observer = DisturbanceObserver(self.model, self.control_period, self.settings.disturbance_time)
        self._regulator: Regulator | None = None

    @classmethod
    def for_env(cls, env: gym.Env[Any, Any], settings: TrajectorySettings | None = None) -> Self:
        """Return the controller for an environment; see the constructor."""
        return cls(env, settings)

    @property
    def periods(self) -> int:
        """For how many control periods the reference is needed."""
        return 1

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before; gains are made anew for the speed at which the point begins."""
        self._observer.reset()
        self._regulator = None

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,), and advance the estimate of the disturbance.

        Raises:
            InvalidInputError: a number of the observation is not finite.
        """
        parts = self._read_places(observation)
        for name, values in parts.items():
            if not np.isfinite(values).all():
                raise InvalidInputError(
                    f"observation: {name} = {values.tolist()} is not finite; give what the environment returned"
                )
        reading = self._read_goal(observation)
        self._observer.observe(reading)
        tracked = self._tracked(reading, parts)
        if self._regulator is None:
            self._regulator = self.regulator_at(float(np.linalg.norm(reading.goal_velocity_body[:3])))
        wanted = self._wrench(tracked, self._regulator)
        given = self._mapping.give(wanted, float(reading.velocity_body[0]))
        self._observer.given(reading, given.wrench_body)
        return np.clip(given.action, -1.0, 1.0).astype(np.float32)

    def regulator_at(self, speed: float) -> Regulator:
        """Return the regulator of deviations from a straight level way at a speed [m/s]."""
        straight = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])
        return regulator(sampled(deviation_model(self.model, straight), self.control_period), self.weights)

    @abstractmethod
    def _wrench(self, tracked: Tracked, found: Regulator) -> Array:
        """Return the wrench wanted now, beyond the limits if need be, shape (6,) [N, N m]."""

    def _tracked(self, reading: Reading, parts: dict[str, Array]) -> Tracked:
        here = parts["goal_position_body"]
        way = Way(
            *(
                vector @ reading.goal_to_body
                for vector in (
                    parts["goal_velocity_body"],
                    parts["goal_acceleration_body"],
                    parts[PLACES_AHEAD[0]] - here,
                    parts[PLACES_AHEAD[1]] - here,
                )
            )
        )
        reference = reference_along(way, AHEAD, self.control_period, self.periods)
        feedforward = reference_wrench(self.model, reference.velocity, reference.acceleration)
        # The vehicle heads elsewhere yet: what is given now is of its own axes.
        turned = (both_halves(reading.goal_to_body, one[0]) for one in reference)
        feedforward[0] = reference_wrench(self.model, *turned)
        turns = self.control_period * np.concatenate([[0.0], np.cumsum(reference.velocity[:-1, 5])])
        disturbance = self._observer.ahead(turns)
        disturbance[0] = both_halves(reading.goal_to_body, disturbance[0])
        velocity = reading.velocity_body - reading.goal_velocity_body
        deviation = np.concatenate([-reading.error_body, velocity])
        return Tracked(deviation, reference, feedforward - disturbance)

    def _refuse_others(self) -> None:
        name = self.vehicle.name
        if tracks_by_steering(self.vehicle):
            raise InvalidInputError(
                f"vehicle {name!r} tracks a point by steering, and this controller drives all of surge, sway and yaw; "
                "fly it by the agent 'controller'"
            )
        if self.vehicle.hydrostatics is not None:
            raise InvalidInputError(
                f"vehicle {name!r} floats, and this controller's model is of vehicles under water; fly it by the agent "
                "'controller'"
            )


class LQRController(TrajectoryController):
    """Reduces the deviation by constant gains, of the model about the point's speed."""

    def _wrench(self, tracked: Tracked, found: Regulator) -> Array:
        wrench: Array = tracked.feedforward[0] - found.gain @ tracked.deviation
        return wrench
